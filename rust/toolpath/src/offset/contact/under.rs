//! Whether the tips that a triangle asks for stay under a chord: concave functions under their tangents.
//!
//! The cuts of a chord where tangents meet: J. E. Kelley, "The cutting-plane method for solving convex programs", Journal of the SIAM
//! 8, 1960.

use styluscam_geometry::Vector;

use super::{gap_to_segment, Chord, Contacts, Feature};

/// Cuts of a chord, for one triangle, before its tips count as too high.
const CUTS: usize = 6;
/// Parts are cut off a chord of at least this share of it.
const LEAST_CUT: f64 = 0.1;

/// A triangle, and of it one part or all.
type Part = (u32, Option<Feature>);

/// Distance in plan between a triangle and a segment.
fn apart_in_plan(corners: &[Vector; 3], [from, to]: [[f64; 2]; 2]) -> f64 {
    let side = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let plan = corners.map(|p| [p.x, p.y]);
    let turns = [0, 1, 2].map(|i| side(plan[i], plan[(i + 1) % 3], from));
    if turns.iter().all(|turn| *turn >= 0.0) || turns.iter().all(|turn| *turn <= 0.0) {
        return 0.0;
    }
    let [a, b] = [from, to].map(|p| Vector::new(p[0], p[1], 0.0));
    let mut least = f64::INFINITY;
    for i in 0..3 {
        let (p, q) = (plan[i], plan[(i + 1) % 3]);
        if side(p, q, from) * side(p, q, to) < 0.0 && side(from, to, p) * side(from, to, q) < 0.0 {
            return 0.0;
        }
        let gaps = [
            gap_to_segment(p, a, b),
            gap_to_segment(from, corners[i], corners[(i + 1) % 3]),
            gap_to_segment(to, corners[i], corners[(i + 1) % 3]),
        ];
        least = gaps.iter().fold(least, |least, gap| least.min(libm::hypot(gap[0], gap[1])));
    }
    least
}

impl Contacts<'_> {
    /// Whether the tips that a triangle alone asks for stay within `most` mm over a chord of tips.
    ///
    /// Along the chord they are concave, so they stay below their tangents over its ends, and over any position between them:
    /// over the one where those meet, the highest that they allow. What is too high there is, or looks so after a few cuts.
    pub fn stays_under(&self, triangle: u32, chord: &Chord, most: f64) -> bool {
        self.part_stays_under((triangle, None), chord, most)
    }

    /// As [`stays_under`](Self::stays_under), of one part of a triangle, an edge with its ends.
    pub fn feature_stays_under(&self, triangle: u32, feature: Feature, chord: &Chord, most: f64) -> bool {
        self.part_stays_under((triangle, Some(feature)), chord, most)
    }

    fn part_stays_under(&self, part: Part, chord: &Chord, most: f64) -> bool {
        let triangle = part.0;
        let over_plane = |share: f64| {
            let (at, tip) = chord.at(share);
            self.greatest_of_plane(triangle, at, [0.0; 2]) - tip
        };
        if [0.0, 1.0].map(over_plane).iter().all(|over| *over <= most) {
            return true; // never for a wall
        }
        // most are far below: one tangent decides
        if let Some([over, rise]) = self.over_chord(part, chord, 0.5) {
            if over > most || over + 0.5 * rise.abs() <= most {
                return over <= most;
            }
        }
        let ends = [0.0, 1.0].map(|share| self.over_chord(part, chord, share));
        self.stays_under_between(part, chord, most, [(0.0, ends[0]), (1.0, ends[1])], CUTS)
    }

    fn stays_under_between(
        &self,
        part: Part,
        chord: &Chord,
        most: f64,
        ends: [(f64, Option<[f64; 2]>); 2],
        cuts: usize,
    ) -> bool {
        let [(from, first), (to, last)] = ends;
        if [first, last].into_iter().flatten().any(|[over, _]| over > most) {
            return false;
        }
        let next = match (first, last) {
            (Some([first, rise]), Some([last, fall])) => {
                // where the tangents meet; where they do not fall towards each other, they are one line but for rounding
                let bend = rise - fall;
                let step = if bend > 0.0 { (last - first - fall * (to - from)) / bend } else { 0.0 };
                let step = step.clamp(0.0, to - from);
                if first + rise * step <= most {
                    return true;
                }
                (from + step).clamp(from + LEAST_CUT * (to - from), to - LEAST_CUT * (to - from))
            }
            _ if self.is_out_of_reach(part.0, chord, [from, to], most) => return true,
            _ => 0.5 * (from + to),
        };
        if cuts == 0 {
            return false;
        }
        let middle = (next, self.over_chord(part, chord, next));
        self.stays_under_between(part, chord, most, [ends[0], middle], cuts - 1)
            && self.stays_under_between(part, chord, most, [middle, ends[1]], cuts - 1)
    }

    /// How far the tip that a triangle alone asks for lies over a chord, at a share of its length, and how that rises by the
    /// share; none where the cutter does not reach it.
    fn over_chord(&self, (triangle, feature): Part, chord: &Chord, share: f64) -> Option<[f64; 2]> {
        let (position, tip) = chord.at(share);
        let (found, [gx, gy]) = match feature {
            None => self.tangent(triangle, position),
            Some(feature) => self.tangent_of(triangle, feature, position),
        }?;
        let rise = gx * chord.along[0] + gy * chord.along[1] - chord.rise;
        (!rise.is_nan()).then_some([found - tip, rise])
    }

    /// Whether a triangle is nowhere on a part of a chord near and high enough to reach over it, by its distance in plan.
    fn is_out_of_reach(&self, triangle: u32, chord: &Chord, [from, to]: [f64; 2], most: f64) -> bool {
        let corners = self.index.triangles().at(triangle);
        let [(a, low), (b, high)] = [from, to].map(|share| chord.at(share));
        let apart = apart_in_plan(&corners, [a, b]);
        if apart > self.cutter.max_radius() + self.overhang() {
            return true;
        }
        let top = corners.iter().fold(f64::NEG_INFINITY, |most, p| most.max(p.z));
        top - self.cutter.height_bound(apart.min(self.cutter.max_radius())) <= low.min(high) + most
    }
}
