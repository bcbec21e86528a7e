//! Where the tool stands, and how many passes lie between two positions of it.

use styluscam_geometry::{ToolBody, Vector};

use crate::offset::Contact;
use crate::{PathPoint, Surface};

/// Cosine of the angle up to which a contact's normal is that of the smooth model behind its facet: 3 degrees.
const SMOOTH: f64 = 0.998_63;
/// Slopes in the table of chords.
const SLOPES: usize = 720;
/// Least share of the metric on a plane. Where the tool rolls over an edge its curvature is that of the surface on which its tip
/// lies, and nothing is left; but of two positions beside and on the edge the second leaves more beside it, as the tool leans
/// there: with this share no more than a tenth.
const ROLLS: f64 = 0.36;
/// Passes aim at this share of the scallop: what the curvatures leave out is of the order of its ratio to the tool's radius.
const AIM: f64 = 0.985;

/// A position of the tool on the envelope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// The tool's tip, mm.
    pub tip: Vector,
    /// Unit normal of the smooth model behind the contact; of the contact itself at an edge.
    pub normal: Vector,
    /// The point of the part that is touched.
    pub contact: Vector,
    /// Whether the tool rolls over an edge.
    pub rolls: bool,
}

impl Station {
    /// Of a contact over a position in plan; none where it is not selected.
    pub fn of(surface: &Surface<'_>, [x, y]: [f64; 2], contact: &Contact) -> Option<Self> {
        let PathPoint { tip, normal, selected, triangle } = surface.path_point(x, y, contact);
        if !selected {
            return None;
        }
        let smooth = smooth_normal(surface, triangle as usize, contact.point, normal);
        Some(Self { tip, normal: smooth.unwrap_or(normal), contact: contact.point, rolls: smooth.is_none() })
    }
}

/// The model's normal at a point of a triangle; none where the contact's `normal` differs from it by more than a facet's does.
fn smooth_normal(surface: &Surface<'_>, triangle: usize, point: Vector, normal: Vector) -> Option<Vector> {
    let mesh = surface.envelope().mesh();
    let ([a, b, c], normals) = (mesh.corners(triangle), mesh.corner_normals(triangle));
    let area = (b - a).cross(&(c - a));
    let part =
        |p: Vector, q: Vector| ((p - point).cross(&(q - point)).dot(&area) / area.norm_squared()).clamp(0.0, 1.0);
    let shares = [part(b, c), part(c, a), part(a, b)];
    let mean: Vector = normals.iter().zip(shares).map(|(normal, share)| normal * share).sum();
    mean.try_normalize(f64::EPSILON).filter(|mean| mean.dot(&normal) >= SMOOTH)
}

/// The distances between passes that leave a scallop.
///
/// Two positions of the tool that are d apart leave d' (T - S) d / 8 between them, T being the curvature of the tool at its
/// contact and S that of the surface on which its tip lies: so T - S over eight scallops is a metric in which passes lie one
/// apart. T is that of the tool's chord at the scallop's height, and S follows from how the normal turns from one position to the
/// other. Derived in docs/concepts/constant-scallop.md.
#[derive(Clone, Debug)]
pub struct Spacing {
    /// By slope: the inverse square of the chord up the wall and level, 1/mm^2.
    chords: Vec<[f64; 2]>,
    /// 1/mm.
    per_turn: f64,
}

impl Spacing {
    /// Of a tool, with the sheet that it touches, for a scallop, mm.
    pub fn new(body: &ToolBody, scallop: f64) -> Self {
        let height = AIM * scallop;
        let most = 2.0 * body.max_radius();
        let of_slope = |number: usize| {
            let slope = std::f64::consts::FRAC_PI_2 * number as f64 / SLOPES as f64;
            [body.chord(slope, height), body.level_chord(slope, height)].map(|chord| {
                let chord = chord.min(most);
                (chord * chord).recip()
            })
        };
        let chords = (0..=SLOPES).map(of_slope).collect();
        Self { chords, per_turn: (8.0 * height).recip() }
    }

    /// The ridges that passes one apart are to leave, mm.
    pub fn height(&self) -> f64 {
        (8.0 * self.per_turn).recip()
    }

    /// The distance of passes on a level plane, mm.
    pub fn on_floor(&self) -> f64 {
        self.at_slope(0.0)[0].sqrt().recip()
    }

    /// How many passes lie between two positions near to each other.
    pub fn between(&self, a: &Station, b: &Station) -> f64 {
        let (shift, turn) = (b.tip - a.tip, b.normal - a.normal);
        let tool = self.tool(a, b);
        (tool - turn.dot(&shift) * self.per_turn).max(ROLLS * tool).sqrt()
    }

    /// The same across a crease, which has a pass of its own: both sides count as planes.
    pub fn over_crease(&self, a: &Station, b: &Station) -> f64 {
        self.tool(a, b).sqrt()
    }

    /// The square of the passes between two positions on a plane between them.
    fn tool(&self, a: &Station, b: &Station) -> f64 {
        let shift = b.tip - a.tip;
        let level = Vector::new(-a.normal.y - b.normal.y, a.normal.x + b.normal.x, 0.0);
        let rise = a.normal.z + b.normal.z;
        let lean = level.norm();
        let along = if lean > 0.0 { shift.dot(&level) / lean } else { 0.0 };
        let whole = shift.norm_squared();
        let [up_chord, level_chord] = self.at_slope(libm::atan2(lean, rise));
        (whole - along * along).max(0.0) * up_chord + along * along * level_chord
    }

    fn at_slope(&self, slope: f64) -> [f64; 2] {
        let position = (slope / std::f64::consts::FRAC_PI_2 * SLOPES as f64).clamp(0.0, SLOPES as f64);
        let first = (position as usize).min(SLOPES - 1);
        let share = position - first as f64;
        [0, 1].map(|i| self.chords[first][i] + share * (self.chords[first + 1][i] - self.chords[first][i]))
    }
}
