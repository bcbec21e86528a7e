//! Which loops of neighbouring levels follow each other.

use super::stitch;
use crate::{Pass, PathPoint};

/// For each pass the loop of the next level that it leads to; none for open passes, where a loop parts into several or ends, and
/// where several come together.
pub fn followers(passes: &[Pass]) -> Vec<Option<usize>> {
    let groups: Vec<Vec<usize>> = {
        let last = passes.iter().map(|pass| pass.group).max().map_or(0, |last| last + 1);
        let mut groups = vec![Vec::new(); last];
        for (number, pass) in passes.iter().enumerate().filter(|(_, pass)| pass.closed) {
            groups[pass.group].push(number);
        }
        groups
    };
    let mut followers = vec![None; passes.len()];
    for pair in groups.windows(2) {
        let nearest = |of: usize, among: &[usize]| {
            let distance = |other: &usize| apart(&passes[of].points, &passes[*other].points);
            among.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        let above: Vec<Option<usize>> = pair[1].iter().map(|lower| nearest(*lower, &pair[0])).collect();
        for (lower, upper) in pair[1].iter().zip(&above) {
            let is_alone = above.iter().filter(|other| *other == upper).count() == 1;
            if let Some(upper) = upper.filter(|upper| is_alone && nearest(*upper, &pair[1]) == Some(*lower)) {
                followers[upper] = Some(*lower);
            }
        }
    }
    followers
}

/// Least distance in plan from a point of one polyline to the other, squared, mm^2.
fn apart(points: &[PathPoint], line: &[PathPoint]) -> f64 {
    let from = points.iter().map(|point| point.tip.xy());
    let distance = |point| {
        let sides = line.windows(2).map(|side| stitch::nearest(point, [side[0].tip.xy(), side[1].tip.xy()]).1);
        sides.fold(f64::INFINITY, f64::min)
    };
    from.map(distance).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use styluscam_geometry::Vector;

    fn square(centre: f64, half: f64, group: usize) -> Pass {
        let corners = [(-half, -half), (half, -half), (half, half), (-half, half), (-half, -half)];
        let point = |(x, y): (f64, f64)| {
            let tip = Vector::new(centre + x, y, -(group as f64));
            PathPoint { tip, normal: Vector::z(), selected: true, triangle: 0 }
        };
        Pass { points: corners.map(point).to_vec(), closed: true, group }
    }

    #[test]
    fn loops_inside_each_other_follow_and_a_split_ends() {
        let passes = [square(0.0, 20.0, 0), square(0.0, 18.0, 1), square(-9.0, 6.0, 2), square(9.0, 6.0, 2)];
        assert_eq!(followers(&passes), [Some(1), None, None, None]);
    }

    #[test]
    fn two_pockets_go_down_side_by_side() {
        let passes = [square(-9.0, 6.0, 0), square(9.0, 6.0, 0), square(9.0, 5.0, 1), square(-9.0, 5.0, 1)];
        assert_eq!(followers(&passes), [Some(3), Some(2), None, None]);
    }

    #[test]
    fn open_passes_and_levels_without_loops_are_followed_by_nothing() {
        let open = Pass { closed: false, ..square(0.0, 18.0, 1) };
        assert_eq!(followers(&[square(0.0, 20.0, 0), open, square(0.0, 16.0, 2)]), [None, None, None]);
        assert!(followers(&[]).is_empty());
    }
}
