//! How much a tip must fall when the contact is not where a plane would have it.

use styluscam_geometry::Cutter;

/// Radii at which the convexity is known.
const CELLS: usize = 256;
/// The disc around a contact in which the profile's bending is looked at, as a share of the contact's radius.
const DISC: f64 = 0.25;
/// What is taken of the least bending found: between the radii looked at it may be a little less.
const SAFE: f64 = 0.8;

/// The profile's least bending around a contact.
///
/// A tool touches a plane at q. With the contact a way v off, its tip is lower by
/// D(v) = Z(q + v) - Z(q) - grad Z(q) v. In the disc |v| <= w the Hessian of Z is at least m, so D >= m |v|^2 / 2; beyond it
/// D, convex along each ray, grows at least in proportion. Hence D >= m min(|v|, w)^2 / 2.
#[derive(Clone, Copy, Debug)]
pub struct Convexity {
    /// m / 2, 1/mm.
    half_bending: f32,
    /// w^2, mm^2.
    square: f32,
}

/// Convexities by the radius of the contact.
pub struct Convexities {
    cells_per_mm: f64,
    cells: Vec<Convexity>,
}

impl Convexity {
    /// Whether a contact beyond a line loses more than `spare` mm; the line's distance is `area / square` under roots.
    #[inline]
    pub fn loses(&self, spare: f64, area_squared: f64, square: f64) -> bool {
        let (half, disc) = (f64::from(self.half_bending), f64::from(self.square));
        half * area_squared.min(disc * square) > spare * square
    }
}

impl Convexities {
    pub fn of(cutter: &Cutter) -> Self {
        let width = cutter.max_radius() / CELLS as f64;
        let least: Vec<f64> = (0..=CELLS).map(|i| bending(cutter, i as f64 * width)).collect();
        let cell = |cell: usize| {
            // for all contacts of the cell
            let disc = DISC * cell as f64 * width;
            let first = ((cell as f64 * width - disc) / width).floor().max(0.0) as usize;
            let last = (((cell + 1) as f64 * width + disc) / width).ceil() as usize;
            let least = least[first..=last.min(CELLS)].iter().copied().fold(f64::INFINITY, f64::min);
            let [inner, outer] = [first, last].map(|i| i as f64 * width);
            let is_curved = cutter.straights().iter().all(|s| s.outer.0 < inner || s.inner.0 > outer);
            let least = if is_curved { least } else { 0.0 };
            Convexity { half_bending: (SAFE * 0.5 * least) as f32, square: (disc * disc) as f32 }
        };
        Self { cells_per_mm: 1.0 / width, cells: (0..CELLS).map(cell).collect() }
    }

    pub fn at(&self, radius: f64) -> Convexity {
        self.cells[((radius * self.cells_per_mm) as usize).min(CELLS - 1)]
    }
}

/// The smaller of the two second derivatives of Z at a radius, 1/mm: along the meridian and around.
fn bending(cutter: &Cutter, radius: f64) -> f64 {
    if let Some(ball) = cutter.as_ball() {
        return 1.0 / ball;
    }
    let slope = cutter.slope_at_radius(radius.min(cutter.max_radius()));
    let cos = libm::cos(slope);
    let meridian = 1.0 / (cutter.curvature_radius_at(slope) * cos * cos * cos);
    let around = libm::tan(slope) / radius;
    let least = meridian.min(around);
    if least.is_finite() {
        least.max(0.0)
    } else {
        0.0
    }
}
