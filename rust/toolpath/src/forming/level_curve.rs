//! Exact points of a level set of the envelope, by Newton's method kept between two sides.

use styluscam_geometry::Vector;

use crate::{PathPoint, Surface};

/// A point counts as on the level within this distance along the normal, mm: a thousandth of what is posted.
const ON_LEVEL: f64 = 1e-6;
/// Steps at most; Newton takes two or three, bisection across a jump thirty.
const STEPS: usize = 60;
/// An envelope that passes the level by more than this within the last bracket has jumped, mm along the normal: far
/// less than any tolerance, because the point is then posted beside the surface that it should touch.
const JUMP: f64 = 1e-4;
/// Steps after which a crossing that met no selected contact is left where it is: it only parts those that count.
const UNSELECTED_STEPS: usize = 4;
/// Steps from a chord's middle before a bracket is sought; one does, on a smooth surface.
const FREE_STEPS: usize = 3;

/// A place in plan.
pub type Place = [f64; 2];
type Plan = nalgebra::Vector2<f64>;

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
    /// `guess` is where to look first, as a share of the way.
    pub fn crossing(&mut self, above: Place, free: Place, guess: f64) -> Option<PathPoint> {
        self.search(above, free, guess).map(|p| self.levelled(p))
    }

    /// What the tool meets at the crossing: on the level, or below it where the envelope jumps past.
    fn search(&mut self, above: Place, free: Place, guess: f64) -> Option<PathPoint> {
        let along = [free[0] - above[0], free[1] - above[1]];
        let length = libm::hypot(along[0], along[1]);
        let (mut low, mut high) = (0.0, 1.0);
        let mut share = guess;
        let (mut last_above, mut met_selected) = (None, false);
        for step in 0..STEPS {
            let place = [above[0] + share * along[0], above[1] + share * along[1]];
            let point = self.at(place);
            met_selected |= point.is_some_and(|p| p.selected);
            let newton = point.and_then(|p| self.newton_step(&p, along));
            match point {
                Some(p) if (p.tip.z - self.z).abs() * p.normal.z < ON_LEVEL => return Some(p),
                Some(p) if p.tip.z > self.z => {
                    low = share;
                    last_above = Some(p);
                }
                _ => high = share,
            }
            if (high - low) * length < ON_LEVEL || (step >= UNSELECTED_STEPS && !met_selected) {
                break;
            }
            share = newton
                .map(|step| share + step)
                .filter(|next| *next > low && *next < high)
                .unwrap_or(0.5 * (low + high));
        }
        // a jump: the free side
        let at = [above[0] + high * along[0], above[1] + high * along[1]];
        let on_free_side = self.at(at);
        let found = on_free_side.or(last_above)?;
        Some(PathPoint { tip: Vector::new(at[0], at[1], found.tip.z), ..found })
    }

    /// Newton's step as a share of the line: the envelope's gradient is -tan(slope) along the normal's plan.
    fn newton_step(&self, point: &PathPoint, along: [f64; 2]) -> Option<f64> {
        let fall = point.normal.x * along[0] + point.normal.y * along[1];
        let step = (point.tip.z - self.z) * point.normal.z / fall;
        step.is_finite().then_some(step)
    }

    /// The point at the level's height. Where the envelope jumps past it, what is touched there is a vertical wall
    /// below the contact that the envelope knows: not that contact, and so not selected.
    fn levelled(&self, point: PathPoint) -> PathPoint {
        let tip = Vector::new(point.tip.x, point.tip.y, self.z);
        PathPoint { tip, selected: point.selected && self.touches(&point), ..point }
    }

    fn touches(&self, point: &PathPoint) -> bool {
        (point.tip.z - self.z).abs() * point.normal.z < JUMP
    }

    /// The point of the level nearest to the middle of a chord: along the slope there, as far as the chord is long.
    /// None where the envelope jumps past the level.
    pub fn between(&mut self, a: &PathPoint, b: &PathPoint) -> Option<PathPoint> {
        let middle = ((a.tip + b.tip) * 0.5).xy();
        let reach = (b.tip - a.tip).norm();
        self.stepped(middle, reach).or_else(|| self.bracketed(a, b, middle, reach))
    }

    /// By Newton's steps alone; none when they leave the reach or take too long.
    fn stepped(&mut self, middle: Plan, reach: f64) -> Option<PathPoint> {
        let mut place = middle;
        for _ in 0..=FREE_STEPS {
            let point = self.at([place.x, place.y])?;
            if (point.tip.z - self.z).abs() * point.normal.z < ON_LEVEL {
                return Some(self.levelled(point));
            }
            let outward = point.normal.xy().try_normalize(1e-9)?;
            place += outward * self.newton_step(&point, [outward.x, outward.y])?;
            if (place - middle).norm() > reach {
                return None;
            }
        }
        None
    }

    /// By walking to the other side of the level first.
    fn bracketed(&mut self, a: &PathPoint, b: &PathPoint, middle: Plan, reach: f64) -> Option<PathPoint> {
        let here = [middle.x, middle.y];
        let start = self.at(here);
        let outward = start.map_or(a.normal, |p| p.normal).xy();
        let outward = if outward.norm() > 1e-9 { outward } else { (a.normal + b.normal).xy() };
        let outward = outward.try_normalize(1e-12)?;
        let is_above = start.is_some_and(|p| p.tip.z > self.z);
        let mut distance = (1e-3 * reach).max(1e-9);
        loop {
            let side = if is_above { distance } else { -distance };
            let other = [middle.x + side * outward.x, middle.y + side * outward.y];
            if self.is_above(other) != is_above {
                let (above, free) = if is_above { (here, other) } else { (other, here) };
                let found = self.search(above, free, 0.5).filter(|p| self.touches(p))?;
                return Some(self.levelled(found));
            }
            if distance >= reach {
                return None;
            }
            distance = (4.0 * distance).min(reach);
        }
    }
}
