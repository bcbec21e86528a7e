//! Exact points of a level set of the envelope: where the triangle that is touched lets the tool go.

use std::ops::RangeInclusive;

use styluscam_geometry::Vector;

use crate::offset::{Contact, Line, Verdict};
use crate::{PathPoint, Surface};

/// The tool is asked for this far over the level, mm: what it would only touch lets it pass.
const OVER: f64 = 1e-9;
/// A point of the level is free this far beyond it, mm,
const BEYOND: f64 = 1e-9;
/// or, far from the origin, so many times what rounding makes of a position.
const ROUNDINGS: f64 = 2.0;
/// Of the length of a chord: within this beside its middle the triangles touched at its ends are taken to be touched.
const BEND: f64 = 0.25;
/// Triangles met on the travel to a point at most; two or three are usual.
const STEPS: usize = 60;

/// Whether a tip's height is over a level.
pub fn is_over(tip: f64, level: f64) -> bool {
    tip > level + OVER
}

/// A height that is over a level, as little as counts.
pub fn least_over(level: f64) -> f64 {
    level + 2.0 * OVER
}

/// A position in plan.
pub type PlanPosition = [f64; 2];
type Plan = nalgebra::Vector2<f64>;

/// The level set of one height, asked along straight lines in plan.
pub struct LevelCurve<'a> {
    surface: &'a Surface<'a>,
    z: f64,
    /// A point is free this far beyond it, mm.
    beyond: f64,
    hint: Option<u32>,
}

impl<'a> LevelCurve<'a> {
    pub fn new(surface: &'a Surface<'a>, z: f64) -> Self {
        let beyond = BEYOND.max(ROUNDINGS * surface.envelope().rounding());
        Self { surface, z, beyond, hint: None }
    }

    /// The same for another height, mm; what was touched last is looked at first there too.
    pub fn at_height(&mut self, z: f64) -> &mut Self {
        self.z = z;
        self
    }

    /// Largest angle by which it turns between two witnesses, rad.
    pub fn bend(&self) -> f64 {
        self.surface.bend()
    }

    /// Height of the level, mm.
    pub fn z(&self) -> f64 {
        self.z
    }

    /// Whether the tip must stay above the level at a position.
    pub fn is_above(&mut self, [x, y]: PlanPosition) -> bool {
        self.surface.envelope().is_over(x, y, self.z + OVER, &mut self.hint)
    }

    fn contact(&mut self, [x, y]: PlanPosition) -> Option<Contact> {
        self.surface.envelope().contact_near(x, y, &mut self.hint)
    }

    fn keeps_off(&self, contact: &Contact) -> bool {
        is_over(contact.tip, self.z)
    }

    /// Whether the tip must stay above the level everywhere in a box of the plan, or need not anywhere.
    pub fn verdict(&self, corners: &[PlanPosition; 2]) -> Verdict {
        self.surface.envelope().verdict(corners, self.z + OVER)
    }

    /// The point of the level between `above`, where the tip must stay higher, and `free`, where it need not.
    ///
    /// `guess` is where to look first, as a share of the distance. What is touched there lets the tool go at a position that is
    /// known exactly; if nothing else keeps it off beyond, that is the point. Otherwise the next triangle is asked.
    pub fn crossing(&mut self, above: PlanPosition, free: PlanPosition, guess: f64) -> Option<PathPoint> {
        let span = Plan::new(free[0] - above[0], free[1] - above[1]);
        let length = span.norm();
        let line = Line { from: above, along: (span / length).into() };
        // what was touched last is most often touched here as well
        if let Some(point) = self.hint.and_then(|last| self.freed_by(&[last], &line, 0.0..=length)) {
            return Some(point);
        }
        let (mut low, mut high) = (0.0, length);
        let mut at = guess * length;
        let mut last = None;
        for _ in 0..STEPS {
            let Some(contact) = self.contact(line.at(at)) else {
                high = at;
                at = 0.5 * (low + high);
                continue;
            };
            let (is_above, release) = (self.keeps_off(&contact), self.release(&contact, &line));
            if is_above {
                (low, last) = (at, Some(contact));
            } else {
                high = at;
            }
            let within = release.filter(|(travel, _)| (low..=high).contains(travel));
            match within {
                Some((travel, contact)) if !self.is_above(line.at(travel + self.beyond)) => {
                    return self.point(&line, travel, &contact)
                }
                Some((travel, _)) => low = travel + self.beyond,
                None => {}
            }
            if high - low <= self.beyond {
                break;
            }
            // what was met beyond comes next, or else a half
            at = if within.is_some() { low } else { 0.5 * (low + high) };
        }
        // along a wall, or where the tool grazes: the last that kept it off
        let contact = last.filter(|_| high - low <= self.beyond)?;
        self.point(&line, high, &contact)
    }

    /// The point of the level where the last of some triangles lets the tool go, if nothing else keeps it off there and the
    /// travel lies within the limits.
    fn freed_by(&mut self, triangles: &[u32], line: &Line, limits: RangeInclusive<f64>) -> Option<PathPoint> {
        let envelope = self.surface.envelope();
        let travels = triangles.iter().filter_map(|triangle| envelope.release(*triangle, line, self.z + OVER));
        let (travel, contact) = travels.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let is_last = limits.contains(&travel) && !self.is_above(line.at(travel + self.beyond));
        if is_last {
            self.point(line, travel, &contact)
        } else {
            None
        }
    }

    /// Where the triangle of a contact lets the tool go on the line.
    fn release(&self, contact: &Contact, line: &Line) -> Option<(f64, Contact)> {
        self.surface.envelope().release(contact.triangle, line, self.z + OVER)
    }

    fn point(&self, line: &Line, travel: f64, contact: &Contact) -> Option<PathPoint> {
        let [x, y] = line.at(travel);
        let point = self.surface.path_point(x, y, contact);
        Some(PathPoint { tip: Vector::new(x, y, self.z), ..point })
    }

    /// The point of the level across the middle of a chord: to its left where the middle must stay higher, to its right
    /// where it need not; so a level that keeps its higher ground on the right keeps it there. None where it is
    /// not as near as the chord is long.
    pub fn between(&mut self, a: &PathPoint, b: &PathPoint) -> Option<PathPoint> {
        let (chord, middle) = ((b.tip - a.tip).xy(), ((a.tip + b.tip) * 0.5).xy());
        let (length, across) = (chord.norm(), Plan::new(-chord.y, chord.x).try_normalize(1e-12)?);
        let line = Line { from: middle.into(), along: across.into() };
        // most often what is touched at an end is touched between, and the level bends little
        let near = BEND * length;
        if let Some(point) = self.freed_by(&[a.triangle, b.triangle], &line, -near..=near) {
            let aside = (point.tip.xy() - middle).dot(&across);
            if aside.abs() <= self.beyond || self.is_above(middle.into()) == (aside > 0.0) {
                return Some(point);
            }
        }
        let mut at = 0.0;
        for _ in 0..STEPS {
            let contact = self.contact(line.at(at));
            let is_above = contact.is_some_and(|contact| self.keeps_off(&contact));
            let release = contact.and_then(|contact| self.release(&contact, &line));
            let limits = if is_above { at - self.beyond..=length } else { -length..=at + self.beyond };
            match release.filter(|(travel, _)| limits.contains(travel)) {
                Some((travel, contact)) if !self.is_above(line.at(travel + self.beyond)) => {
                    return self.point(&line, travel, &contact)
                }
                Some((travel, _)) if travel + self.beyond > at => at = travel + self.beyond,
                _ if is_above => return None,
                _ => break,
            }
        }
        // free, and what is touched below does not rise to the level nearby: what does is searched for
        let back = Line { from: line.at(at), ..line.reversed() };
        let (travel, contact) = self.surface.envelope().push(&back, self.z + OVER, at + length)?;
        self.point(&back, travel.max(0.0), &contact)
    }
}
