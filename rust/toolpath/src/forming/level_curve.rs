//! Exact points of a level set of the envelope, by Newton's method kept between two sides.

use styluscam_geometry::Vector;

use crate::{PathPoint, Surface};

/// A point counts as on the level within this distance along the normal, mm.
const ON_LEVEL: f64 = 1e-9;
/// Steps at most; Newton takes three to five, bisection across a jump thirty-five.
const STEPS: usize = 60;

/// A place in plan.
pub type Place = [f64; 2];

/// The level set of one height, asked along straight lines in plan.
pub struct LevelCurve<'a> {
    surface: &'a Surface<'a>,
    z: f64,
    hint: Option<u32>,
}

impl<'a> LevelCurve<'a> {
    pub fn new(surface: &'a Surface<'a>, z: f64) -> Self {
        Self { surface, z, hint: None }
    }

    /// Whether the tip must stay above the level at a place.
    pub fn is_above(&mut self, place: Place) -> bool {
        self.at(place).is_some_and(|p| p.tip.z > self.z)
    }

    fn at(&mut self, [x, y]: Place) -> Option<PathPoint> {
        self.surface.at(x, y, &mut self.hint)
    }

    /// The point of the level between `above`, where the tip must stay higher, and `free`, where it need not.
    ///
    /// The contact gives the slope, hence Newton's step along the line; a step out of the bracket is replaced by
    /// bisection, which also settles on the jump at the part's border. The point lies on the free side of it.
    pub fn crossing(&mut self, above: Place, free: Place) -> Option<PathPoint> {
        let along = [free[0] - above[0], free[1] - above[1]];
        let length = along[0].hypot(along[1]);
        let (mut low, mut high) = (0.0, 1.0);
        let mut share = 0.5;
        let mut last_above = None;
        for _ in 0..STEPS {
            let place = [above[0] + share * along[0], above[1] + share * along[1]];
            let point = self.at(place);
            let newton = point.and_then(|p| self.newton_step(&p, along));
            match point {
                Some(p) if (p.tip.z - self.z).abs() * p.normal.z < ON_LEVEL => return Some(self.levelled(p)),
                Some(p) if p.tip.z > self.z => {
                    low = share;
                    last_above = Some(p);
                }
                _ => high = share,
            }
            if (high - low) * length < ON_LEVEL {
                break;
            }
            share = newton
                .map(|step| share + step)
                .filter(|next| *next > low && *next < high)
                .unwrap_or(0.5 * (low + high));
        }
        // a jump: the free side, with the normal of what is touched on the other
        let at = [above[0] + high * along[0], above[1] + high * along[1]];
        let on_free_side = self.at(at);
        on_free_side.or(last_above).map(|p| self.levelled(PathPoint { tip: Vector::new(at[0], at[1], 0.0), ..p }))
    }

    /// Newton's step as a share of the line: the envelope's gradient is -tan(slope) along the normal's plan.
    fn newton_step(&self, point: &PathPoint, along: [f64; 2]) -> Option<f64> {
        let fall = point.normal.x * along[0] + point.normal.y * along[1];
        let step = (point.tip.z - self.z) * point.normal.z / fall;
        step.is_finite().then_some(step)
    }

    fn levelled(&self, point: PathPoint) -> PathPoint {
        PathPoint { tip: Vector::new(point.tip.x, point.tip.y, self.z), ..point }
    }

    /// The point of the level nearest to the middle of a chord: along the slope there, as far as the chord is long.
    pub fn between(&mut self, a: &PathPoint, b: &PathPoint) -> Option<PathPoint> {
        let middle = (a.tip + b.tip) * 0.5;
        let start = self.at([middle.x, middle.y]);
        if let Some(p) = start.filter(|p| (p.tip.z - self.z).abs() * p.normal.z < ON_LEVEL) {
            return Some(self.levelled(p));
        }
        let outward = start.map_or(a.normal, |p| p.normal).xy();
        let outward = if outward.norm() > 1e-9 { outward } else { (a.normal + b.normal).xy() };
        let outward = outward.try_normalize(1e-12)?;
        let is_above = start.is_some_and(|p| p.tip.z > self.z);
        let reach = (b.tip - a.tip).norm();
        let towards = |d: f64| [middle.x + d * outward.x, middle.y + d * outward.y];
        let newton = start.and_then(|p| self.newton_step(&p, [outward.x, outward.y])).unwrap_or(reach);
        // just past Newton's point, then twice as far each time, until the other side is reached
        let mut distance = (1.5 * newton.abs()).clamp(1e-9, reach);
        loop {
            let other = towards(if is_above { distance } else { -distance });
            if self.is_above(other) != is_above {
                let here = [middle.x, middle.y];
                return if is_above { self.crossing(here, other) } else { self.crossing(other, here) };
            }
            if distance >= reach {
                return None;
            }
            distance = (4.0 * distance).min(reach);
        }
    }
}
