//! The lower right hull of points, and its chords.

use std::f64::consts::FRAC_PI_2;

/// Slopes this near to 0 or a right angle, rad, are it: a flat end, a cylindrical side.
const AXIAL: f64 = 1e-13;

/// Points in the order along the hull, and which of them are its corners.
pub struct Hull {
    points: Vec<Candidate>,
    /// Places of the corners in `points`.
    corners: Vec<usize>,
}

/// A point that may be a corner of the hull.
#[derive(Clone, Copy)]
struct Candidate {
    at: [f64; 2],
    /// Its number in the document.
    number: usize,
}

/// A chord between two corners.
#[derive(Clone, Debug)]
pub struct Chord {
    pub from: [f64; 2],
    pub to: [f64; 2],
    /// Numbers of its ends in the document.
    pub numbers: [usize; 2],
    /// Its direction, rad.
    pub slope: f64,
    /// mm.
    pub length: f64,
    /// The deepest point that it passes by, mm inside of it; negative if all are outside, `None` without any.
    pub depth: Option<f64>,
    /// Whether all points that it passes by are on it within the thinning.
    pub on_line: bool,
    /// Whether it is a flat end or a cylindrical side.
    pub axial: bool,
}

impl Hull {
    /// The hull of points from a tip at the radius `begin`, its lowest at height 0, to their largest r and z.
    pub fn of(points: &[[f64; 2]], begin: f64) -> Self {
        let mut candidates: Vec<Candidate> =
            points.iter().enumerate().map(|(number, p)| Candidate { at: [p[0].max(begin), p[1]], number }).collect();
        if let Some(first) = candidates.first_mut() {
            first.at = [begin, 0.0];
        }
        let most = candidates.iter().fold([0.0_f64; 2], |m, c| [m[0].max(c.at[0]), m[1].max(c.at[1])]);
        if let Some(last) = candidates.last_mut() {
            last.at = most;
        }
        // along the hull r + z rises; points that noise has put in another order are few
        let along = |c: &Candidate| c.at[0] + c.at[1];
        let inward = |c: &Candidate| c.at[1] - c.at[0];
        candidates.sort_by(|a, b| along(a).total_cmp(&along(b)).then(inward(a).total_cmp(&inward(b))));
        let corners = corners(&candidates);
        Self { points: candidates, corners }
    }

    /// The larger of its extents, mm.
    pub fn size(&self) -> f64 {
        self.points.last().map_or(0.0, |last| last.at[0].max(last.at[1]))
    }

    /// The chords between its corners, those within `close` mm of a chord left out.
    pub fn chords(&self, close: f64) -> Vec<Chord> {
        self.thinned(close).windows(2).map(|pair| self.chord(pair[0], pair[1], close)).collect()
    }

    /// As few corners as a greedy walk takes, such that those between are within `close` of the chord.
    ///
    /// From each corner the directions in which all corners passed so far are close enough form a wedge (Imai and Iri
    /// 1988); of a convex chain only its upper side can be left.
    fn thinned(&self, close: f64) -> Vec<usize> {
        let [first, .., last] = self.corners[..] else { return self.corners.clone() };
        let mut kept = vec![first];
        // a direction is a vector: the turn from one to another is the sign of their cross product
        let (mut from, mut wedge, mut before) = (first, None, first);
        for &corner in &self.corners[1..] {
            let mut to = self.vector(from, corner);
            if before != from && wedge.is_some_and(|wedge| cross(wedge, to) > 0.0) {
                kept.push(before);
                (from, wedge) = (before, None);
                to = self.vector(from, corner);
            }
            // turned by an angle whose tangent is that share: less than the arcsine
            let share = close / length(to);
            if share < 1.0 {
                let upper = [to[0] - share * to[1], to[1] + share * to[0]];
                wedge = wedge.filter(|&wedge| cross(wedge, upper) >= 0.0).or(Some(upper));
            }
            before = corner;
        }
        // a stub at the end would have the direction of its noise
        while kept.len() > 1 && kept.last().is_some_and(|&corner| length(self.vector(corner, last)) <= close) {
            kept.pop();
        }
        kept.push(last);
        kept
    }

    fn vector(&self, from: usize, to: usize) -> [f64; 2] {
        let (a, b) = (self.points[from].at, self.points[to].at);
        [b[0] - a[0], b[1] - a[1]]
    }

    fn chord(&self, from: usize, to: usize, close: f64) -> Chord {
        let vector = self.vector(from, to);
        let slope = libm::atan2(vector[1], vector[0]);
        let axial = slope <= AXIAL || slope >= FRAC_PI_2 - AXIAL;
        let slope = match slope {
            _ if !axial => slope,
            slope if slope < 1.0 => 0.0,
            _ => FRAC_PI_2,
        };
        let (a, b) = (self.points[from], self.points[to]);
        let mut chord = Chord {
            from: a.at,
            to: b.at,
            numbers: [a.number, b.number],
            slope,
            length: length(vector),
            depth: None,
            on_line: to > from + 1,
            axial,
        };
        for between in &self.points[from + 1..to] {
            let depth = chord.depth_of(between.at);
            chord.on_line &= depth.abs() <= close;
            chord.depth = Some(chord.depth.map_or(depth, |deepest: f64| deepest.max(depth)));
        }
        chord
    }
}

impl Chord {
    /// How far a point is inside of its line, mm; negative outside.
    pub fn depth_of(&self, point: [f64; 2]) -> f64 {
        turn(self.from, self.to, point) / self.length
    }
}

/// Positive where c lies to the left of the line from a to b: towards the axis and up, inside of a convex tool.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    cross([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]])
}

/// Positive where b is turned upwards from a.
fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn length(vector: [f64; 2]) -> f64 {
    (vector[0] * vector[0] + vector[1] * vector[1]).sqrt()
}

/// The lower right hull by Andrew's monotone chain (1979).
fn corners(points: &[Candidate]) -> Vec<usize> {
    let mut corners: Vec<usize> = Vec::new();
    for (i, p) in points.iter().enumerate() {
        while let [.., a, b] = corners[..] {
            if turn(points[a].at, points[b].at, p.at) > 0.0 {
                break;
            }
            corners.pop();
        }
        corners.push(i);
    }
    corners
}
