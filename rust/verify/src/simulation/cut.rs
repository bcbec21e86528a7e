//! A short path of a tool's tip, straight or bent a little, and how low it brings the tool over a position.

use styluscam_motion::ArcPath;

use super::underside::Underside;
use crate::body::length;

/// Newton's steps at most, on straight and on bent paths.
const STEPS: [usize; 2] = [60, 6];
/// A step that changes nothing any more, as a share of a bent path.
const SHORT_SHARE: f64 = 1e-5;
/// Thirds that are taken off a path at most: what is left of it is shorter than rounding.
const THIRDS: u32 = 60;
/// A step of Newton's after which there is none to take, as a share of the tool's radius.
const SHORT: f64 = 1e-6;
/// Positions nearer to each other than this share of the tool's radius are one.
const ROUNDING: f64 = 1e-12;

/// A position in plan, mm.
pub(super) type Position = [f64; 2];

/// A path of the tip: at a share t from 0 to 1 it is at `from + t along + 4 t (1 - t) bulge`.
///
/// On an arc that is short enough for its bulge the parabola is off it by a thousandth of that.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    from: [f64; 3],
    along: [f64; 3],
    bulge: [f64; 3],
    /// How far it is from its chord at most, mm.
    pub sag: f64,
    /// Index of the tool.
    pub tool: u32,
    /// Index of the arc that it is part of, if it is.
    arc: Option<u32>,
    /// The part of that arc: halves of halves, exact numbers.
    part: [f32; 2],
}

/// A plane that a cut's surface is nowhere below.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// Height over the position that it was made for, mm.
    pub height: f64,
    /// Its gradient.
    pub gradient: [f64; 2],
}

impl Plane {
    /// Height at an offset from that position, mm.
    #[inline]
    pub fn at(&self, offset: Position) -> f64 {
        self.height + self.gradient[0] * offset[0] + self.gradient[1] * offset[1]
    }
}

impl Cut {
    pub fn straight(from: [f64; 3], to: [f64; 3], tool: u32) -> Self {
        Self { from, along: minus(to, from), bulge: [0.0; 3], sag: 0.0, tool, arc: None, part: [0.0, 1.0] }
    }

    /// All of the arc of that index.
    pub fn bent(path: &ArcPath, arc: u32, tool: u32) -> Self {
        Self::straight([0.0; 3], [0.0; 3], tool).of_part(path, arc, [0.0, 1.0])
    }

    /// A part of the arc, given by its ends and its middle.
    fn of_part(&self, path: &ArcPath, arc: u32, part: [f32; 2]) -> Self {
        let [from, to] = part.map(|share| path.at(f64::from(share)));
        let middle = path.at(0.5 * (f64::from(part[0]) + f64::from(part[1])));
        let bulge = [0, 1, 2].map(|k| middle[k] - 0.5 * (from[k] + to[k]));
        let sag = path.part(f64::from(part[0]), f64::from(part[1])).sag();
        Self { from, along: minus(to, from), bulge, sag, arc: Some(arc), part, ..*self }
    }

    /// Both halves of a part of an arc.
    pub fn halves(&self, arcs: &[ArcPath]) -> Option<[Self; 2]> {
        let arc = self.arc?;
        let path = arcs.get(arc as usize)?;
        let [from, to] = self.part;
        let middle = 0.5 * (from + to);
        Some([[from, middle], [middle, to]].map(|part| self.of_part(path, arc, part)))
    }

    /// The tool standing where this one is at a share, on the arc itself.
    pub fn still(&self, share: f64, arcs: &[ArcPath]) -> Self {
        let [from, to] = self.part.map(f64::from);
        let path = self.arc.and_then(|arc| arcs.get(arc as usize));
        let at = path.map_or_else(|| self.at(share), |path| path.at(from + share * (to - from)));
        Self::straight(at, at, self.tool)
    }

    /// Lower and upper corner of a box in plan that holds the tip's path.
    pub fn bounds(&self) -> [Position; 2] {
        let ends = |k: usize| (self.from[k], self.from[k] + self.along[k]);
        let ((x0, x1), (y0, y1)) = (ends(0), ends(1));
        [[x0.min(x1) - self.sag, y0.min(y1) - self.sag], [x0.max(x1) + self.sag, y0.max(y1) + self.sag]]
    }

    fn at(&self, share: f64) -> [f64; 3] {
        let swing = 4.0 * share * (1.0 - share);
        [0, 1, 2].map(|k| self.from[k] + share * self.along[k] + swing * self.bulge[k])
    }

    /// Distance in plan from a position to the chord, mm.
    pub fn distance(&self, position: Position) -> f64 {
        let share = self.nearest(position).clamp(0.0, 1.0);
        length(position[0] - self.from[0] - share * self.along[0], position[1] - self.from[1] - share * self.along[1])
    }

    /// Share at which the line of the chord is nearest to a position in plan; 0 where it has no length there.
    fn nearest(&self, position: Position) -> f64 {
        let [x, y, _] = self.along;
        let square = x * x + y * y;
        if square > 0.0 {
            ((position[0] - self.from[0]) * x + (position[1] - self.from[1]) * y) / square
        } else {
            0.0
        }
    }

    /// The lowest that it brings the tool over a position, mm, and the share at which; infinite where it does not come.
    #[inline]
    pub fn over(&self, tool: &Underside, position: Position) -> (f64, f64) {
        let share = self.share(tool, position);
        if self.arc.is_none() {
            return (self.height(tool, position, share), share);
        }
        if self.distance(position) > tool.radius() + self.sag {
            return (f64::INFINITY, share);
        }
        self.bent_over(tool, position, share)
    }

    fn height(&self, tool: &Underside, position: Position, share: f64) -> f64 {
        let tip = self.at(share);
        tip[2] + tool.height(length(position[0] - tip[0], position[1] - tip[1]))
    }

    /// The share at which the tool on the chord is lowest over a position; where it does not come, the nearest.
    ///
    /// Along the chord the height is convex: at its minimum the rise of the tool's surface along the path undoes the path's.
    fn share(&self, tool: &Underside, position: Position) -> f64 {
        let [x, y, z] = self.along;
        let square = x * x + y * y;
        if square <= 0.0 {
            return f64::from(u8::from(z < 0.0));
        }
        let middle = self.nearest(position);
        let nearest = middle.clamp(0.0, 1.0);
        if z == 0.0 {
            return nearest;
        }
        let size = square.sqrt();
        let aside = ((position[0] - self.from[0]) * y - (position[1] - self.from[1]) * x) / size;
        let (aside, radius) = (aside * aside, tool.radius());
        let reach = radius * radius - aside;
        if reach < 0.0 {
            return nearest;
        }
        // distances along the chord in plan from the position, towards where the chord falls
        let reach = reach.sqrt();
        let (first, last) = if z > 0.0 { (middle - 1.0, middle) } else { (-middle, 1.0 - middle) };
        let (first, last) = ((first * size).max(0.0), (last * size).min(reach));
        if first >= last {
            return nearest;
        }
        let fall = z.abs() / size;
        let best = match tool.as_ball() {
            Some(_) => (fall * reach / (1.0 + fall * fall).sqrt()).clamp(first, last),
            None => balance(tool, fall, aside, [first, last]),
        };
        // ends to the bit: elsewhere the tool's rise and the path's are taken to be in balance
        let lower_end = f64::from(u8::from(z < 0.0));
        if best >= last && last < reach {
            return lower_end;
        }
        if best <= first && first > 0.0 {
            return 1.0 - lower_end;
        }
        (middle - (best / size).copysign(z)).clamp(0.0, 1.0)
    }

    /// The lowest on a bent path: Newton from the share that is best on its chord, where that leads to a minimum.
    fn bent_over(&self, tool: &Underside, position: Position, share: f64) -> (f64, f64) {
        let mut share = share;
        for _ in 0..STEPS[1] {
            let Some((first, second)) = self.rates(tool, position, share) else { break };
            if first == 0.0 {
                return (self.height(tool, position, share), share);
            }
            let next = (share - first / second).clamp(0.0, 1.0);
            if second.is_nan() || second <= 0.0 {
                break;
            }
            if (next - share).abs() <= SHORT_SHARE {
                return (self.height(tool, position, next), next);
            }
            share = next;
        }
        self.by_thirds(tool, position)
    }

    /// How fast the height over a position changes with the share, and how fast that does; none off the tool and beside kinks.
    fn rates(&self, tool: &Underside, position: Position, share: f64) -> Option<(f64, f64)> {
        let tip = self.at(share);
        let (turn, bend) = (4.0 - 8.0 * share, -8.0);
        let rate = [0, 1, 2].map(|k| self.along[k] + turn * self.bulge[k]);
        let apart = [tip[0] - position[0], tip[1] - position[1]];
        let distance = length(apart[0], apart[1]);
        if distance <= 0.0 || !tool.reaches(distance) {
            return None;
        }
        let (rise, curvature) = tool.rise(distance);
        let out = (apart[0] * rate[0] + apart[1] * rate[1]) / distance;
        let away = rate[0] * rate[0] + rate[1] * rate[1] - out * out
            + bend * (apart[0] * self.bulge[0] + apart[1] * self.bulge[1]);
        let first = rate[2] + rise * out;
        Some((first, bend * self.bulge[2] + curvature? * out * out + rise * away / distance))
    }

    /// The lowest on a bent path by thirds: at rims and kinks.
    fn by_thirds(&self, tool: &Underside, position: Position) -> (f64, f64) {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..THIRDS {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            let [at_a, at_b] = [a, b].map(|share| self.height(tool, position, share));
            // where the tool does not come at either, it is nearer at the one that is better on the chord
            let falls = if at_a.is_finite() || at_b.is_finite() { at_b < at_a } else { self.share(tool, position) > b };
            if falls {
                low = a;
            } else {
                high = b;
            }
        }
        let ends = [0.0, 0.5 * (low + high), 1.0].map(|share| (self.height(tool, position, share), share));
        ends.into_iter().fold((f64::INFINITY, 0.0), |best, found| if found.0 < best.0 { found } else { best })
    }

    /// A plane that its surface is nowhere below within `around` mm of a position.
    ///
    /// Height is convex in position and share together: a plane that touches at one share, and what the share can gain.
    pub fn plane(&self, tool: &Underside, position: Position, around: f64) -> Plane {
        let share = self.share(tool, position);
        let apart =
            [position[0] - self.from[0] - share * self.along[0], position[1] - self.from[1] - share * self.along[1]];
        let distance = length(apart[0], apart[1]);
        let line = tool.line(distance);
        let out = if distance > f64::MIN_POSITIVE { 1.0 / distance } else { 0.0 };
        let towards = (apart[0] * self.along[0] + apart[1] * self.along[1]) * out;
        let inside = share > 0.0 && share < 1.0 && tool.reaches(distance);
        let balanced = self.along[2] / towards;
        let rise = if inside && self.along[2] != 0.0 && balanced >= 0.0 && balanced.is_finite() {
            balanced
        } else if distance > 0.0 {
            line.rise
        } else {
            0.0
        };
        let rate = self.along[2] - rise * towards;
        let size = length(self.along[0], self.along[1]);
        let (middle, reach) = (self.nearest(position), (tool.radius() + around) / size);
        let [first, last] =
            if size > 0.0 { [(middle - reach).max(0.0), (middle + reach).min(1.0)] } else { [0.0, 1.0] };
        let gain = (rate * (first - share)).min(rate * (last - share)).min(0.0);
        let bend = self.sag * (1.0 + rise * rise).sqrt();
        Plane {
            height: self.from[2] + share * self.along[2] + line.height + gain - bend,
            gradient: [rise * out * apart[0], rise * out * apart[1]],
        }
    }
}

/// How far along a path that falls by `fall` the tool is lowest over a position that lies the root of `aside` off it, mm.
fn balance(tool: &Underside, fall: f64, aside: f64, [first, last]: [f64; 2]) -> f64 {
    let slope = |along: f64| {
        let distance = (aside + along * along).sqrt().min(tool.radius());
        if distance <= 0.0 {
            return (-fall, None);
        }
        let (rise, bend) = tool.rise(distance);
        let share = along / distance;
        let second = bend.map(|bend| bend * share * share + rise * aside / (distance * distance * distance));
        (rise * share - fall, second)
    };
    // where the slope was seen to be below and above 0
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut along = tool.distance_of_rise(fall).clamp(first, last);
    for _ in 0..STEPS[0] {
        let (value, second) = slope(along);
        // an end that it would pass is the end to the bit
        if (along <= first && value >= 0.0) || (along >= last && value <= 0.0) {
            return along;
        }
        if value < 0.0 {
            low = along;
        } else {
            high = along;
        }
        let newton = second.filter(|second| *second > 0.0).map(|second| (along - value / second).clamp(first, last));
        if let Some(next) = newton.filter(|next| *next > low && *next < high) {
            let step = (next - along).abs();
            along = next;
            // an interior position: the next step would be as its square
            if step <= SHORT * tool.radius() && next > first && next < last {
                break;
            }
            continue;
        }
        along = match (low.is_finite(), high.is_finite()) {
            (true, true) => 0.5 * (low + high),
            (true, false) => last,
            _ => first,
        };
        if high - low <= ROUNDING * tool.radius() {
            break;
        }
    }
    along
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
