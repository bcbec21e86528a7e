//! Speeding up and slowing down along stretches and around the corners between them.

/// Share of the acceleration that turns the path where a corner is blended; as much along it as is left, a half at least.
const TURNING: f64 = 0.866;
/// Least share of the acceleration that changes the speed along an arc.
const ALONG: f64 = 0.5;
/// Share of the acceleration of each of two moves that overlap where no arc joins them: the other one has the rest.
const OVERLAP: f64 = 0.5;
/// Sine or cosine of half an angle that is none.
const NO_ANGLE: f64 = 1e-6;
/// Sine of the angle by which a direction may leave a plane and lie in it: of rounded coordinates.
const LEVEL: f64 = 1e-2;

/// A move as its dynamics see it.
pub(crate) struct Stretch {
    /// mm
    pub length: f64,
    /// Highest speed, mm/s.
    pub speed: f64,
    /// Along it, mm/s^2.
    pub acceleration: f64,
    /// Direction at both ends; none when its length is 0.
    pub from: Option<[f64; 3]>,
    pub to: Option<[f64; 3]>,
    /// The axis across an arc.
    pub across: Option<usize>,
    /// Whether the machine stands before it.
    pub stopped: bool,
}

/// What a machine does between two stretches.
pub(crate) struct Corners {
    /// How far it cuts them, mm.
    pub tolerance: f64,
    /// Whether it runs along the arcs that cut them.
    pub blends: bool,
    /// Accelerations of the axes, mm/s^2.
    pub axes: Option<[f64; 3]>,
}

/// The way around a corner.
#[derive(Clone, Copy)]
struct Corner {
    /// What it takes of both stretches, mm.
    cut: f64,
    length: f64,
    speed: f64,
    acceleration: f64,
    /// Whether both stretches overlap there.
    overlap: bool,
}

/// A part of the path with one highest speed: a stretch or a corner.
struct Piece {
    length: f64,
    speed: f64,
    acceleration: f64,
}

/// The highest speed around a radius and what then is left along the path: mm/s and mm/s^2, of a blending controller.
pub(crate) fn around(radius: f64, speed: f64, acceleration: f64) -> (f64, f64) {
    let top = speed.min((TURNING * acceleration * radius).sqrt());
    let turning = if radius > 0.0 { top * top / (radius * acceleration) } else { TURNING };
    (top, acceleration * (1.0 - turning * turning).max(ALONG * ALONG).sqrt())
}

/// Seconds of each stretch: with a corner, half of it.
pub(crate) fn seconds(stretches: &[Stretch], corners: &Corners) -> Vec<f64> {
    let between: Vec<Corner> = stretches.windows(2).map(|pair| corners.between(&pair[0], &pair[1])).collect();
    let mut pieces = Vec::with_capacity(2 * stretches.len());
    for (index, stretch) in stretches.iter().enumerate() {
        let before = index.checked_sub(1).and_then(|before| between.get(before));
        let cut = |corner: Option<&Corner>| corner.map_or(0.0, |corner| corner.cut);
        let length = (stretch.length - cut(before) - cut(between.get(index))).max(0.0);
        pieces.extend(before.map(|c| Piece { length: c.length, speed: c.speed, acceleration: c.acceleration }));
        let overlaps = [before, between.get(index)].iter().flatten().any(|corner| corner.overlap);
        let acceleration = if overlaps { OVERLAP * stretch.acceleration } else { stretch.acceleration };
        pieces.push(Piece { length, speed: stretch.speed, acceleration });
    }
    let speeds = speeds(&pieces);
    let times: Vec<f64> =
        pieces.iter().zip(speeds.windows(2)).map(|(piece, ends)| piece.seconds(ends[0], ends[1])).collect();
    let corner = |index: Option<usize>| index.and_then(|index| times.get(index)).map_or(0.0, |time| 0.5 * time);
    let all = times.iter().enumerate().step_by(2);
    all.map(|(index, time)| corner(index.checked_sub(1)) + time + corner(Some(index + 1))).collect()
}

impl Corners {
    fn between(&self, before: &Stretch, after: &Stretch) -> Corner {
        let acceleration = before.acceleration.min(after.acceleration);
        let top = before.speed.min(after.speed);
        let still = Corner { cut: 0.0, length: 0.0, speed: 0.0, acceleration, overlap: false };
        let past = Corner { speed: top, ..still };
        if after.stopped {
            return still;
        }
        let (Some(a), Some(b)) = (before.to, after.from) else { return past };
        // of half the angle that the path turns by
        let sin = 0.5 * norm([b[0] - a[0], b[1] - a[1], b[2] - a[2]]);
        let cos = 0.5 * norm([b[0] + a[0], b[1] + a[1], b[2] + a[2]]);
        if sin < NO_ANGLE || acceleration.is_infinite() {
            return past;
        }
        if cos < NO_ANGLE {
            return still;
        }
        // 1 - cos, without the digits that it loses
        let radius = self.tolerance * cos * (1.0 + cos) / (sin * sin);
        if !self.blends {
            return Corner { speed: top.min((acceleration * radius).sqrt()), ..still };
        }
        if !(flat(before, b) && flat(after, a)) {
            let speed = top.min((OVERLAP * acceleration * radius).sqrt());
            return Corner { speed, overlap: true, ..still };
        }
        let limit = self.axes.map_or(acceleration, |axes| {
            let moved = [0, 1, 2].map(|axis| a[axis].abs().max(b[axis].abs()) > NO_ANGLE);
            least(axes, moved)
        });
        let radius = radius.min(0.5 * before.length.min(after.length) * cos / sin);
        let (speed, acceleration) = around(radius, top, limit);
        Corner { cut: radius * sin / cos, length: 2.0 * radius * libm::atan2(sin, cos), speed, acceleration, ..past }
    }
}

/// Whether a direction lies in the plane of a stretch that is an arc.
fn flat(stretch: &Stretch, direction: [f64; 3]) -> bool {
    stretch.across.and_then(|axis| direction.get(axis)).is_none_or(|part| part.abs() < LEVEL)
}

/// The least of the values of axes that move; infinite where none does.
pub(crate) fn least(each: [f64; 3], moved: [bool; 3]) -> f64 {
    each.into_iter().zip(moved).filter(|(_, moves)| *moves).map(|(value, _)| value).fold(f64::INFINITY, f64::min)
}

/// Speed at the start of each piece and at the end of the last, mm/s.
fn speeds(pieces: &[Piece]) -> Vec<f64> {
    let mut speeds = vec![0.0; pieces.len() + 1];
    for (i, pair) in pieces.windows(2).enumerate() {
        speeds[i + 1] = pair[0].speed.min(pair[1].speed);
    }
    if pieces.iter().all(|piece| piece.acceleration.is_infinite()) {
        return speeds;
    }
    for i in (0..pieces.len()).rev() {
        speeds[i] = speeds[i].min(pieces[i].reach(speeds[i + 1]));
    }
    for i in 0..pieces.len() {
        speeds[i + 1] = speeds[i + 1].min(pieces[i].reach(speeds[i]));
    }
    speeds
}

impl Piece {
    /// The highest speed at its other end, mm/s.
    fn reach(&self, from: f64) -> f64 {
        if self.length > 0.0 {
            (from * from + 2.0 * self.acceleration * self.length).sqrt()
        } else {
            from
        }
    }

    /// Its time between speeds at its ends, s: it speeds up to its highest if the length allows it, then slows down.
    fn seconds(&self, from: f64, to: f64) -> f64 {
        let (length, top, acceleration) = (self.length, self.speed, self.acceleration);
        if length <= 0.0 {
            return 0.0;
        }
        if acceleration.is_infinite() {
            return length / top;
        }
        let peak = (acceleration * length + 0.5 * (from * from + to * to)).sqrt().min(top.max(from).max(to));
        let ramps = (2.0 * peak * peak - from * from - to * to) / (2.0 * acceleration);
        (2.0 * peak - from - to) / acceleration + (length - ramps).max(0.0) / peak
    }
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}
