//! Paths that are the same on several levels: between upright walls they are planned once.

use styluscam_toolpath::pocket::PocketPath;

/// Corners of two outlines that lie nearer than this are the same, mm: a thousandth of the finest digit that a machine takes.
const SAME: f64 = 1e-7;

type Outlines = Vec<Vec<[f64; 3]>>;

/// What decides on the path of an area, but for the operation's own keys.
#[derive(Clone, Copy, Debug)]
pub struct Situation<'a> {
    /// Where the tool's centre may be, points (x, y, bulge), mm.
    pub outlines: &'a [Vec<[f64; 3]>],
    /// The stock's outlines, mm.
    pub stock: &'a [Vec<[f64; 3]>],
    /// The tool's at the layer's top, mm.
    pub radius: f64,
}

/// The paths of one level.
#[derive(Debug, Default)]
pub struct Repeated {
    planned: Vec<(Outlines, Outlines, f64, PocketPath)>,
}

impl Repeated {
    /// The path of an area that was planned in the same situation.
    pub fn path(&self, now: Situation<'_>) -> Option<PocketPath> {
        let is_same = |(outlines, stock, radius, _): &&(Outlines, Outlines, f64, PocketPath)| {
            (radius - now.radius).abs() <= SAME && alike(outlines, now.outlines) && alike(stock, now.stock)
        };
        self.planned.iter().find(is_same).map(|(.., path)| path.clone())
    }

    pub fn keep(&mut self, now: Situation<'_>, path: &PocketPath) {
        self.planned.push((now.outlines.to_vec(), now.stock.to_vec(), now.radius, path.clone()));
    }
}

fn alike(a: &[Vec<[f64; 3]>], b: &[Vec<[f64; 3]>]) -> bool {
    let is_near = |(p, q): (&[f64; 3], &[f64; 3])| p.iter().zip(q).all(|(x, y)| (x - y).abs() <= SAME);
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.len() == b.len() && a.iter().zip(b).all(is_near))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_found_again_where_nothing_has_moved() {
        let square = |size: f64| vec![vec![[0.0, 0.0, 0.0], [size, 0.0, 0.0], [size, size, 0.0], [0.0, size, 0.0]]];
        let (inner, outer, moved) = (square(10.0), square(20.0), square(10.000_001));
        let path = PocketPath { runs: Vec::new(), goal: 100.0, left: 0.0 };
        let at = Situation { outlines: &inner, stock: &outer, radius: 3.0 };
        let mut repeated = Repeated::default();
        assert_eq!(repeated.path(at).map(|path| path.goal), None);
        repeated.keep(at, &path);
        assert_eq!(repeated.path(at).map(|path| path.goal), Some(100.0));
        for other in [
            Situation { outlines: &moved, ..at },
            Situation { stock: &moved, ..at },
            Situation { outlines: &[], ..at },
            Situation { radius: 3.1, ..at },
        ] {
            assert!(repeated.path(other).is_none(), "{other:?}");
        }
    }
}
