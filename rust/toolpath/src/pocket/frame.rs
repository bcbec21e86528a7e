//! The plane in which a pocket is planned: about its middle, as large as the arithmetic needs it, mirrored for conventional milling.
//!
//! Chords, the grid and what is kept from walls are fixed lengths there. They have to be small beside the tool's radius and beside
//! the stepover, so small tools and small angles are planned larger than they are: of a tool of 0.3 mm the angle was up to 10 deg above the bound
//! without that. Pockets over 4 m are planned smaller than they are, with tools that are large there as well.

use super::error::PocketError;
use super::ground::{number, FARTHEST};
use super::request::{Cleared, EntryRule, Pocket, PocketPath, Shape};

/// The tool's radius in the plane, at least, mm.
const RADIUS: f64 = 2.5;
/// The stepover in the plane, at least, mm.
const STEPOVER: f64 = 0.3;
/// What else there is, stock and what earlier tools cleared, is no farther from the pocket's middle than this, mm, in the
/// plane of a large one.
const SURROUNDINGS: f64 = 2.0 * FARTHEST;
/// Chips thinner than this do not count, mm (docs/concepts/engagement.md): what earlier tools swept counts as that much wider.
pub const CHIP: f64 = 1e-3;

/// From the pocket to the plane and back.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Middle of the pocket, mm.
    middle: [f64; 2],
    /// Lengths there over lengths here: a power of two, so that nothing is rounded.
    scale: f64,
    /// 1, or -1 where X is mirrored.
    side: f64,
}

/// The middle of a pocket, and half its length or width, mm, the larger one.
fn extent(pocket: &Pocket<'_>) -> ([f64; 2], f64) {
    let outlines = pocket.shape.outlines();
    let points = || outlines.iter().flat_map(|(_, outline)| outline.iter());
    let range = |i: usize| {
        let low = points().fold(f64::INFINITY, |low, point| low.min(point[i]));
        let high = points().fold(f64::NEG_INFINITY, |high, point| high.max(point[i]));
        [low, high]
    };
    let ranges = [range(0), range(1)];
    let half = ranges.iter().fold(pocket.radius, |half: f64, [low, high]| half.max(0.5 * (high - low)));
    (ranges.map(|[low, high]| libm::round(0.5 * (low + high))), half)
}

impl Frame {
    /// The plane for a pocket.
    ///
    /// # Errors
    /// A tool that would be too small in the plane of a large pocket, and stock or cleared paths too far from it for the arithmetic.
    pub fn new(pocket: &Pocket<'_>) -> Result<Self, PocketError> {
        let (middle, half) = extent(pocket);
        let stepover = pocket.radius * (1.0 - libm::cos(pocket.angle));
        let wanted = (RADIUS / pocket.radius).max(STEPOVER / stepover).max(1.0);
        let most = FARTHEST / half;
        let power = if most < 1.0 { libm::floor(libm::log2(most)) } else { libm::ceil(libm::log2(wanted.min(most))) };
        let frame = Self { middle, scale: libm::exp2(power), side: if pocket.climb { 1.0 } else { -1.0 } };
        // a power of two smaller than needed halves it at most
        let is_large_enough = most >= 1.0 || pocket.radius * most >= 2.0 * RADIUS;
        number(
            "tool_radius",
            pocket.radius,
            is_large_enough,
            "1.25 mm or more for each metre of a pocket longer than 4 m",
        )?;
        frame.check_surroundings(pocket).map(|()| frame)
    }

    /// Refuses stock and cleared paths that are too far from the pocket.
    fn check_surroundings(&self, pocket: &Pocket<'_>) -> Result<(), PocketError> {
        let most = SURROUNDINGS / self.scale.min(1.0);
        let stock = pocket.shape.stock().unwrap_or(&[]).iter().enumerate();
        let stock = stock.map(|(i, outline)| (format!("stock[{i}]"), outline));
        let cleared = pocket.cleared.iter().enumerate().map(|(i, path)| (format!("cleared[{i}]"), &path.points));
        for (key, points) in stock.chain(cleared) {
            for (value, middle) in points.iter().flat_map(|[x, y, _]| [x, y].into_iter().zip(self.middle)) {
                number(&key, *value, (value - middle).abs() <= most, "4 m from the pocket's middle or less")?;
            }
        }
        Ok(())
    }

    /// A path of the plane, here.
    pub fn back(&self, mut path: PocketPath) -> PocketPath {
        for run in &mut path.runs {
            for point in &mut run.points {
                let [x, y] = self.at([point[0], point[1]]);
                *point = [x, y, self.side * point[2]];
            }
            run.room /= self.scale;
            for stepover in &mut run.stepovers {
                stepover.travelled /= self.scale;
                stepover.width /= self.scale;
            }
        }
        let square = self.scale * self.scale;
        PocketPath { goal: path.goal / square, left: path.left / square, ..path }
    }

    /// An error of the plane, in positions and lengths of here.
    pub fn error(&self, error: PocketError) -> PocketError {
        match error {
            PocketError::TooSmall { radius, smoothing } => {
                PocketError::TooSmall { radius: radius / self.scale, smoothing: smoothing / self.scale }
            }
            PocketError::NoEntry { at, left, form } => {
                PocketError::NoEntry { at: self.at(at), left: left / (self.scale * self.scale), form }
            }
            error @ (PocketError::Number { .. }
            | PocketError::Outline { .. }
            | PocketError::Edge { .. }
            | PocketError::Profile { .. }
            | PocketError::Line { .. }
            | PocketError::Empty
            | PocketError::Cancelled) => error,
        }
    }

    /// A position of the plane, here.
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.side * x / self.scale + self.middle[0], y / self.scale + self.middle[1]]
    }

    fn points(&self, points: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let there = |[x, y, bulge]: &[f64; 3]| {
            [self.side * (x - self.middle[0]) * self.scale, (y - self.middle[1]) * self.scale, self.side * bulge]
        };
        points.iter().map(there).collect()
    }

    fn all(&self, outlines: &[Vec<[f64; 3]>]) -> Vec<Vec<[f64; 3]>> {
        outlines.iter().map(|outline| self.points(outline)).collect()
    }
}

/// A pocket's outlines in the plane.
pub struct Framed<'a> {
    pocket: Pocket<'a>,
    frame: Frame,
    walls: Vec<Vec<[f64; 3]>>,
    stock: Option<Vec<Vec<[f64; 3]>>>,
    cleared: Vec<Cleared>,
}

impl<'a> Framed<'a> {
    pub fn new(pocket: &Pocket<'a>, frame: Frame) -> Self {
        let outlines = pocket.shape.outlines();
        let walls = outlines.iter().map(|(_, outline)| frame.points(outline)).collect();
        let stock = pocket.shape.stock().map(|stock| frame.all(stock));
        let cleared =
            |path: &Cleared| Cleared { points: frame.points(&path.points), radius: (path.radius + CHIP) * frame.scale };
        let cleared = pocket.cleared.iter().map(cleared).collect();
        Self { pocket: *pocket, frame, walls, stock, cleared }
    }

    /// The pocket in the plane, to be cut by climb milling.
    pub fn pocket(&self) -> Pocket<'_> {
        let scale = self.frame.scale;
        let stock = self.stock.as_deref();
        let shape = match (self.pocket.shape, self.walls.split_first()) {
            (Shape::Walls { open_edges, .. }, Some((boundary, islands))) => {
                Shape::Walls { boundary, islands, open_edges, stock }
            }
            (shape @ (Shape::Walls { .. } | Shape::Centres { .. }), _) => Shape::Centres {
                outlines: &self.walls,
                stock: stock.unwrap_or(&[]),
                in_air: matches!(shape, Shape::Centres { in_air: true, .. }),
            },
        };
        Pocket {
            shape,
            radius: self.pocket.radius * scale,
            smoothing: self.pocket.smoothing * scale,
            leave: self.pocket.leave * scale,
            finish: self.pocket.finish * scale,
            entry: EntryRule { size: self.pocket.entry.size.map(|size| size * scale), ..self.pocket.entry },
            cleared: &self.cleared,
            climb: true,
            ..self.pocket
        }
    }
}
