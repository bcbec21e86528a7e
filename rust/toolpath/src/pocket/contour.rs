//! Milling along one profile: the strip beside it as a pocket of which only the profile is a wall.

use styluscam_geometry::PlanePiece;

use super::error::PocketError;
use super::ground::{chords, number, path_chords, FARTHEST};
use super::growth::WALL;
use super::material::Material;
use super::polygons::{signed_area, Kernel, Point, Polygons};

/// How far beyond the strip the tool may go, in tool radii: its centre may be free of it there.
const BEYOND: f64 = 3.0;
/// Width of the slit along an open profile that parts its two sides, mm: less than what is kept from walls.
const SLIT: f64 = 2e-4;
/// Strips are no narrower, mm.
const NARROWEST: f64 = 0.01;
/// How far from the profile the point lies by which its side is found, as a share of the strip's width.
const BESIDE: f64 = 1e-3;

/// A profile and the strip beside it.
#[derive(Clone, Copy, Debug)]
pub struct Contour<'a> {
    /// Points (x, y, bulge of the edge that begins there), mm.
    pub profile: &'a [[f64; 3]],
    /// Whether the last point is joined to the first.
    pub is_closed: bool,
    /// Whether the strip is left of the profile, in the direction of its points.
    pub is_left: bool,
    /// The strip's width, mm.
    pub width: f64,
    /// The tool's radius, mm.
    pub radius: f64,
    /// Outlines of the material, where it is less than the strip.
    pub stock: Option<&'a [Vec<[f64; 3]>]>,
}

/// Outlines of points with bulges, mm.
type Outlines = Vec<Vec<[f64; 3]>>;

/// The pocket that a strip is.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// Outline of where the tool may be.
    pub boundary: Vec<[f64; 3]>,
    /// Outlines within it where it may not be.
    pub islands: Outlines,
    /// Outlines of what is cleared.
    pub stock: Outlines,
}

impl Contour<'_> {
    /// The strip beside the profile.
    ///
    /// # Errors
    /// What is no profile; a profile with another part of itself, of a strip beside an open one, nearer than the strip is wide.
    pub fn strip(&self) -> Result<Strip, PocketError> {
        self.check()?;
        let farthest = self.profile.iter().fold(0.0, |most: f64, [x, y, _]| most.max(x.abs()).max(y.abs()));
        let kernel = Kernel::new(2.0 * farthest + 20.0 * self.radius + 4.0 * self.width);
        let beyond = BEYOND * self.radius;
        let [strip, around] = if self.is_closed {
            [self.beside_closed(&kernel, self.width)?, self.beside_closed(&kernel, self.width + beyond)?]
        } else {
            [self.beside_open(&kernel, 0.0)?, self.beside_open(&kernel, beyond)?]
        };
        let stock = match self.stock {
            Some(stock) => {
                let stock: Vec<Vec<Point>> = stock.iter().map(|outline| chords(outline)).collect();
                kernel.intersection(&strip, &kernel.even_odd(&stock))
            }
            None => strip,
        };
        let (mut outer, inner): (Outlines, Outlines) =
            flat(&around).into_iter().partition(|outline| signed_area(&chords(outline)) > 0.0);
        match (outer.pop(), outer.is_empty()) {
            (Some(boundary), true) => Ok(Strip { boundary, islands: inner, stock: flat(&stock) }),
            _ => Err(PocketError::Profile { width: self.width }),
        }
    }

    /// All points no farther than `width` from a closed profile, on its side.
    fn beside_closed(&self, kernel: &Kernel, width: f64) -> Result<Polygons, PocketError> {
        let outline = chords(self.profile);
        let is_inside = (signed_area(&outline) > 0.0) == self.is_left;
        let area = kernel.even_odd(&[outline]);
        if area.contours.len() != 1 {
            return Err(PocketError::Profile { width });
        }
        Ok(match is_inside {
            true => kernel.difference(&area, &kernel.offset(&area, -width, WALL)),
            false => kernel.difference(&kernel.offset(&area, width, WALL), &area),
        })
    }

    /// The points beside an open profile, led on straight at its ends by `beyond`.
    fn beside_open(&self, kernel: &Kernel, beyond: f64) -> Result<Polygons, PocketError> {
        let width = self.width + beyond;
        let path = path_chords(self.profile);
        if kernel.sweep(&path, 0.5 * SLIT, 0.1 * SLIT).contours.len() != 1 {
            return Err(PocketError::Profile { width: self.width }); // it encloses something
        }
        let profile = led_on(&path, beyond);
        // the slit parts the caps at the ends too
        let slit = kernel.sweep(&led_on(&path, beyond + 2.0 * width), 0.5 * SLIT, 0.1 * SLIT);
        let both = kernel.difference(&kernel.sweep(&profile, width, WALL), &slit);
        let whole = PlanePiece::path(self.profile);
        let Some(piece) = whole.iter().max_by(|a, b| a.length().total_cmp(&b.length())) else {
            return Err(PocketError::Line { count: self.profile.len() });
        };
        let aside = (BESIDE * width).max(SLIT);
        let side = if self.is_left { aside } else { -aside };
        let [a, b] = [piece.at(0.5), piece.at(0.5 + 1e-6)];
        let along = [b[0] - a[0], b[1] - a[1]];
        let length = libm::hypot(along[0], along[1]);
        let beside = |side: f64| [a[0] - side * along[1] / length, a[1] + side * along[0] / length];
        let parts = both.parted();
        let at = |point: Point| parts.iter().position(|part| Material::new(part.clone()).holds(point));
        match (at(beside(side)), at(beside(-side))) {
            (Some(wanted), Some(other)) if wanted != other => Ok(parts.into_iter().nth(wanted).unwrap_or_default()),
            _ => Err(PocketError::Profile { width: self.width }),
        }
    }

    fn check(&self) -> Result<(), PocketError> {
        number("width", self.width, (NARROWEST..=FARTHEST).contains(&self.width), "0.01 to 2000 mm")?;
        number("tool_radius", self.radius, (0.01..=500.0).contains(&self.radius), "0.01 to 500 mm")?;
        for (i, value) in
            self.profile.iter().enumerate().flat_map(|(i, point)| point.iter().map(move |value| (i, *value)))
        {
            number(&format!("profile[{i}]"), value, value.abs() <= FARTHEST, "finite numbers within +/-2000")?;
        }
        let length: f64 = PlanePiece::path(self.profile).iter().map(PlanePiece::length).sum();
        if length > 0.0 {
            return Ok(());
        }
        Err(PocketError::Line { count: self.profile.len() })
    }
}

/// A path led on straight at both ends.
fn led_on(path: &[Point], by: f64) -> Vec<Point> {
    let mut points: Vec<Point> = path.to_vec();
    points.dedup();
    let beyond = |end: Option<&Point>, before: Option<&Point>| {
        let (end, before) = (end?, before?);
        let along = [end[0] - before[0], end[1] - before[1]];
        let share = by / libm::hypot(along[0], along[1]);
        Some([end[0] + share * along[0], end[1] + share * along[1]])
    };
    let first = beyond(points.first(), points.get(1));
    let last = beyond(points.last(), points.len().checked_sub(2).and_then(|i| points.get(i)));
    first.into_iter().chain(points).chain(last).collect()
}

fn flat(area: &Polygons) -> Outlines {
    area.contours.iter().map(|contour| contour.iter().map(|[x, y]| [*x, *y, 0.0]).collect()).collect()
}
