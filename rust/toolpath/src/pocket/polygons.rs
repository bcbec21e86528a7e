//! Areas of the plane as polygons, and what is done with them: booleans, offsets, what a disc sweeps.
//!
//! Corners lie on a grid of a power of two (some 1e-7 mm for a pocket of a few hundred mm), on which the booleans are exact
//! (i_overlay). Round joins are chords of their arcs, at most `tolerance` off them, inside.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::Overlay;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;

pub use super::contours::{sides, signed_area, Point};

use super::contours::{bounds, circle};
use super::offset::{coarsened, folded, unfolded, vanishes};
use super::window::{clipped, Window};

/// An area: outlines counterclockwise, holes clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygons {
    pub contours: Vec<Vec<Point>>,
}

/// The grid on which areas are computed.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    scale: f64,
}

/// Coordinates on the grid stay below this: a factor 2 is left to the library's limit of 2^30.
const HIGHEST: f64 = 536_870_912.0;

impl Kernel {
    /// A grid for coordinates up to `farthest`, mm.
    pub fn new(farthest: f64) -> Self {
        let mut scale = 1.0;
        while scale * farthest < HIGHEST {
            scale *= 2.0;
        }
        while scale * farthest > HIGHEST {
            scale *= 0.5;
        }
        Self { scale }
    }

    /// What the grid moves crossings of edges by, mm.
    pub fn noise(&self) -> f64 {
        2.0 / self.scale
    }

    /// What lies in either.
    pub fn union(&self, a: &Polygons, b: &Polygons) -> Polygons {
        self.boolean(a, b, OverlayRule::Union)
    }

    /// What lies in the first and not in the second.
    pub fn difference(&self, a: &Polygons, b: &Polygons) -> Polygons {
        self.boolean(a, b, OverlayRule::Difference)
    }

    /// What lies in both.
    pub fn intersection(&self, a: &Polygons, b: &Polygons) -> Polygons {
        self.boolean(a, b, OverlayRule::Intersect)
    }

    /// The area within outlines of any direction, by the even-odd rule.
    pub fn even_odd(&self, contours: &[Vec<Point>]) -> Polygons {
        let contours = self.to_grid(contours);
        self.back(Overlay::from_subj(&contours).overlay(OverlayRule::Subject, FillRule::EvenOdd))
    }

    /// The union of many areas that may overlap.
    pub fn union_all(&self, contours: &[Vec<Point>]) -> Polygons {
        let contours = self.to_grid(contours);
        self.back(Overlay::from_subj(&contours).overlay(OverlayRule::Subject, FillRule::Positive))
    }

    /// What of an area lies in a box.
    pub fn clipped(&self, area: &Polygons, window: Window) -> Polygons {
        // contours of the clipped run to and fro along the box
        self.union_all(&area.clipped(window).contours)
    }

    /// All points within `distance` of the area; below 0, the points of it farther than that from its outside. mm.
    ///
    /// Where the area's edge is curved more than `distance` its offset folds over: what of it lies nearer to the area is left out first (offset.rs).
    pub fn offset(&self, area: &Polygons, distance: f64, tolerance: f64) -> Polygons {
        if distance.abs() * self.scale < 1.0 {
            return area.clone();
        }
        let kept: Vec<&[Point]> =
            area.contours.iter().filter(|contour| !vanishes(contour, distance)).map(Vec::as_slice).collect();
        self.offset_of(&kept, distance, tolerance)
    }

    fn offset_of(&self, contours: &[&[Point]], distance: f64, tolerance: f64) -> Polygons {
        let offset = self.offset_unfolded(contours, distance, tolerance);
        offset.unwrap_or_else(|| self.offset_folded(contours, distance, tolerance)).thinned(0.3 * tolerance)
    }

    /// With all folds cut short; None where that does not tell what the area is.
    pub(super) fn offset_unfolded(&self, contours: &[&[Point]], distance: f64, tolerance: f64) -> Option<Polygons> {
        let curves = unfolded(contours, distance, tolerance)?;
        let mut offset = Polygons::default();
        for contour in self.union_all(&curves.curves).contours {
            if curves.bounds(&contour)? {
                offset.contours.push(contour);
            }
        }
        Some(offset)
    }

    /// With coarse curves that fill what lies behind folds.
    pub(super) fn offset_folded(&self, contours: &[&[Point]], distance: f64, tolerance: f64) -> Polygons {
        let (fine, coarse) = folded(contours, distance, tolerance);
        // each by itself: where the one turns around to the right, the other must not make up for it
        let (fine, coarse) = (self.union_all(&fine), self.union_all(&coarse));
        if distance > 0.0 {
            self.union(&fine, &coarse)
        } else {
            self.intersection(&fine, &coarse)
        }
    }

    /// What a disc of `radius` sweeps along a path, mm.
    pub fn sweep(&self, path: &[Point], radius: f64, tolerance: f64) -> Polygons {
        let back = path.iter().rev().skip(1).take(path.len().saturating_sub(2));
        let there_and_back = path.iter().chain(back).copied().collect::<Vec<Point>>();
        self.offset_of(&[&there_and_back], radius, tolerance)
    }

    fn boolean(&self, a: &Polygons, b: &Polygons, rule: OverlayRule) -> Polygons {
        let (a, b) = (self.to_grid(&a.contours), self.to_grid(&b.contours));
        self.back(Overlay::from_subj_and_clip(&a, &b).overlay(rule, FillRule::NonZero))
    }

    fn to_grid(self, contours: &[Vec<Point>]) -> Vec<Vec<IntPoint<i32>>> {
        let on_grid = |point: &Point| {
            let [x, y] = point.map(|x| libm::round(x * self.scale).clamp(-HIGHEST * 2.0, HIGHEST * 2.0 - 1.0) as i32);
            IntPoint::new(x, y)
        };
        contours.iter().map(|contour| contour.iter().map(on_grid).collect()).collect()
    }

    fn back(&self, shapes: Vec<Vec<Vec<IntPoint<i32>>>>) -> Polygons {
        let point = |p: IntPoint<i32>| [f64::from(p.x) / self.scale, f64::from(p.y) / self.scale];
        let contours = shapes.into_iter().flatten().map(|contour| contour.into_iter().map(point).collect());
        Polygons { contours: contours.collect() }
    }
}

impl Polygons {
    pub fn is_empty(&self) -> bool {
        self.contours.is_empty()
    }

    /// mm^2.
    pub fn area(&self) -> f64 {
        self.contours.iter().map(|contour| signed_area(contour)).sum()
    }

    /// A circle as a polygon whose sides touch it from inside.
    pub fn disc(centre: Point, radius: f64, tolerance: f64) -> Self {
        Self { contours: vec![circle(centre, radius, tolerance)] }
    }

    /// With longer chords along its hollow arcs, so that it is larger by up to `sag` there, mm.
    pub fn filled(&self, sag: f64) -> Self {
        Self { contours: self.contours.iter().map(|contour| coarsened(contour, sag, true)).collect() }
    }

    /// What of it lies in a box: contours may run to and fro along the box's sides.
    pub fn clipped(&self, window: Window) -> Self {
        Self { contours: self.contours.iter().filter_map(|contour| clipped(contour, window)).collect() }
    }

    /// Without the corners that are less than `tolerance` off the line between those that stay.
    pub fn thinned(self, tolerance: f64) -> Self {
        Self { contours: self.contours.into_iter().map(|contour| thinned(&contour, tolerance)).collect() }
    }

    /// Without contours that are smaller than `size` across: what the grid leaves of coinciding edges. Each would become a disc when
    /// it is offset, all of them nearly the same one.
    pub fn without_specks(mut self, size: f64) -> Self {
        self.contours.retain(|contour| {
            let [low, high] = bounds(contour.iter()).unwrap_or_default();
            (0..2).any(|i| high[i] - low[i] > size)
        });
        self
    }

    /// The areas of which it consists, each with its holes.
    pub fn parted(self) -> Vec<Self> {
        let mut parts: Vec<Self> = Vec::new();
        // an outline comes before its holes
        for contour in self.contours {
            match parts.last_mut().filter(|_| signed_area(&contour) < 0.0) {
                Some(part) => part.contours.push(contour),
                None => parts.push(Self { contours: vec![contour] }),
            }
        }
        parts
    }

    /// Corners of the smallest upright box around it; None where it is empty.
    pub fn bounds(&self) -> Option<[Point; 2]> {
        bounds(self.contours.iter().flatten())
    }
}

/// Corners looked ahead of the last that stays.
const AHEAD: usize = 24;

fn thinned(contour: &[Point], tolerance: f64) -> Vec<Point> {
    let count = contour.len();
    let mut kept = Vec::with_capacity(count);
    let mut from = 0;
    while from < count {
        kept.extend(contour.get(from));
        let mut to = from + 1;
        while to < count && to - from < AHEAD && is_straight(contour, from, to + 1, tolerance) {
            to += 1;
        }
        from = to;
    }
    if kept.len() < 3 {
        return contour.to_vec();
    }
    kept
}

/// Whether the corners between two are less than `tolerance` off the line between them.
fn is_straight(contour: &[Point], from: usize, to: usize, tolerance: f64) -> bool {
    let (Some(a), Some(b)) = (contour.get(from), contour.get(to % contour.len())) else { return false };
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = libm::hypot(along[0], along[1]);
    let off = |p: &Point| {
        let arm = [p[0] - a[0], p[1] - a[1]];
        let on = arm[0] * along[0] + arm[1] * along[1];
        (arm[0] * along[1] - arm[1] * along[0]).abs() < tolerance * length && on > 0.0 && on < length * length
    };
    length > 0.0 && contour.get(from + 1..to).is_some_and(|between| between.iter().all(off))
}
