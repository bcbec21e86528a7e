//! Where the way from one of the tool's positions to another crosses a hollow crease of the envelope.

use styluscam_geometry::Vector;

use super::stations::Station;
use crate::Surface;

/// Least angle between the normals on both sides of a crease, rad: 6 degrees. What is flatter is no higher than a part of the scallop.
const TURNS: f64 = 0.1;
/// Share of that angle that is left where a side of a lattice's cell has been halved [`HALVINGS`] times, if it is a crease and no
/// fillet.
const SUDDEN: f64 = 0.5;
/// What is higher over a crease, mm, and steeper, is a wall.
const JUMP: f64 = 0.01;
const STEEPEST: f64 = 100.0;
/// A pass along a wall's foot is so far off it, mm, that rounding does not lift it onto the wall.
const OFF: f64 = 0.002;
/// Halvings of a side.
const HALVINGS: usize = 10;

/// Where a side of a net crosses a crease.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The nodes, the smaller number first.
    pub side: [usize; 2],
    /// The positions on both sides of the crease, as near to each other as is looked.
    pub stations: [Station; 2],
}

impl Crossing {
    /// The station on the same side of the crease as another one.
    pub fn beside(&self, station: &Station) -> &Station {
        let [first, second] = &self.stations;
        if first.normal.dot(&station.normal) >= second.normal.dot(&station.normal) {
            first
        } else {
            second
        }
    }

    /// Whether the tool has to be lifted to cross it: an upright wall stands there.
    pub fn is_jump(&self) -> bool {
        let shift = self.stations[1].tip - self.stations[0].tip;
        shift.z.abs() > JUMP + STEEPEST * shift.xy().norm()
    }

    /// The stations below and above a wall.
    pub fn below_and_above(&self) -> [&Station; 2] {
        let [first, second] = &self.stations;
        if first.tip.z <= second.tip.z {
            [first, second]
        } else {
            [second, first]
        }
    }

    /// The position in plan of the pass along it, mm: before a wall a little off it.
    pub fn position(&self) -> [f64; 2] {
        let [below, above] = self.below_and_above();
        let (low, shift) = (below.tip.xy(), below.tip.xy() - above.tip.xy());
        let place = match shift.try_normalize(0.0) {
            Some(away) if self.is_jump() => low + OFF * away,
            Some(_) | None => low - 0.5 * shift,
        };
        [place.x, place.y]
    }
}

fn angle(a: &Vector, b: &Vector) -> f64 {
    libm::atan2(a.cross(b).norm(), a.dot(b))
}

/// Where a side between two stations crosses a crease, if it does.
pub fn crossing(surface: &Surface<'_>, side: [usize; 2], [a, b]: [&Station; 2]) -> Option<Crossing> {
    let whole = angle(&a.normal, &b.normal);
    if whole < TURNS || (b.normal - a.normal).dot(&(b.tip - a.tip)) >= 0.0 {
        return None;
    }
    let (mut low, mut high) = (*a, *b);
    let mut hint = None;
    for _ in 0..HALVINGS {
        let middle = (low.tip + high.tip) * 0.5;
        let contact = surface.envelope().contact_near(middle.x, middle.y, &mut hint)?;
        let station = Station::of(surface, [middle.x, middle.y], &contact)?;
        if angle(&low.normal, &station.normal) >= angle(&station.normal, &high.normal) {
            high = station;
        } else {
            low = station;
        }
    }
    let is_sudden = angle(&low.normal, &high.normal) >= SUDDEN * whole;
    is_sudden.then_some(Crossing { side: [side[0].min(side[1]), side[0].max(side[1])], stations: [low, high] })
}
