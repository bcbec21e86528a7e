//! How long a program takes on a machine that must accelerate, slow down in corners and read its blocks.

use crate::{EventKind, Move, Program};

/// Seconds in a minute.
const MINUTE: f64 = 60.0;

/// What of a machine decides how fast it follows a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// Speed of rapids, mm/min.
    pub rapid_rate: f64,
    /// Acceleration along the path, mm/s^2; without it speeds change at once.
    pub acceleration: Option<f64>,
    /// How far the controller cuts corners, mm; at 0 it stops in each.
    pub corner_tolerance: f64,
    /// Blocks that the controller reads in a second; without it as many as it wants.
    pub blocks_per_second: Option<f64>,
}

/// What of a machine decides how fast it may turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cornering {
    /// Acceleration along the path, mm/s^2.
    pub acceleration: f64,
    /// How far the path at a corner may be from it, mm.
    pub deviation: f64,
    /// The last decimal of posted coordinates, mm.
    pub unit: f64,
}

impl Dynamics {
    /// A machine of which only the speed of rapids is known, mm/min.
    #[must_use]
    pub fn at_once(rapid_rate: f64) -> Self {
        Self { rapid_rate, acceleration: None, corner_tolerance: 0.0, blocks_per_second: None }
    }

    /// The time at the end of every move from the start of the program, s; and at the program's own end.
    ///
    /// The speed changes evenly within a move. A corner is taken as fast as a circle allows that leaves it by the corner
    /// tolerance at most (S. K. Jeon, "Improving Grbl: Cornering Algorithm", 2011); an arc as fast as its radius allows.
    /// Events stop the machine. No block is faster than the controller reads. The path to the first point is not known
    /// and takes no time; neither do tool changes, and turns of the tool's axis.
    #[must_use]
    pub fn times(&self, program: &Program) -> (Vec<f64>, f64) {
        let stretches = self.stretches(program);
        let speeds = self.speeds(&stretches);
        let mut upcoming = program.upcoming();
        let mut waits = |index| upcoming.before(index).map(seconds_of).sum::<f64>();
        let mut clock = 0.0;
        let times = stretches.iter().zip(speeds.windows(2)).enumerate();
        let times = times.map(|(index, (stretch, ends))| {
            clock += waits(index) + self.seconds(stretch, ends[0], ends[1]);
            clock
        });
        let times = times.collect();
        (times, clock + waits(program.moves.len()))
    }

    fn stretches(&self, program: &Program) -> Vec<Stretch> {
        let mut upcoming = program.upcoming();
        let mut stretches = Vec::with_capacity(program.moves.len());
        let mut rpm = None;
        for (index, (start, step)) in program.segments().enumerate() {
            let mut stopped = start.is_none();
            for event in upcoming.before(index) {
                stopped |= !matches!(event, EventKind::Comment { .. });
                rpm = rpm_after(event, rpm);
            }
            stretches.push(self.stretch(start.unwrap_or(step.end.tip), step, rpm, stopped));
        }
        stretches
    }

    fn stretch(&self, start: [f64; 3], step: &Move, rpm: Option<f64>, stopped: bool) -> Stretch {
        let path = step.path(start);
        let length = step.length(start);
        let rate = step.mm_per_min(length, rpm).filter(|rate| *rate > 0.0 && rate.is_finite());
        let mut speed = rate.unwrap_or(self.rapid_rate) / MINUTE;
        if let (Some(path), Some(acceleration)) = (path, self.acceleration) {
            speed = speed.min((acceleration * path.radius()).sqrt());
        }
        let heading =
            |from: f64, to: f64| path.map_or(direction(start, step.end.tip), |arc| direction(arc.at(from), arc.at(to)));
        Stretch { length, speed, from: heading(0.0, 1e-4), to: heading(1.0 - 1e-4, 1.0), stopped }
    }

    /// Speed at the start of each stretch and at the end of the last, mm/s.
    fn speeds(&self, stretches: &[Stretch]) -> Vec<f64> {
        let Some(acceleration) = self.acceleration else {
            return stretches.iter().map(|stretch| stretch.speed).chain([0.0]).collect();
        };
        let mut speeds = vec![0.0; stretches.len() + 1];
        for (i, pair) in stretches.windows(2).enumerate() {
            speeds[i + 1] = self.corner_speed(&pair[0], &pair[1], acceleration);
        }
        let reach = |from: f64, length: f64| (from * from + 2.0 * acceleration * length).sqrt();
        for i in (0..stretches.len()).rev() {
            speeds[i] = speeds[i].min(reach(speeds[i + 1], stretches[i].length));
        }
        for i in 0..stretches.len() {
            speeds[i + 1] = speeds[i + 1].min(reach(speeds[i], stretches[i].length));
        }
        speeds
    }

    fn corner_speed(&self, before: &Stretch, after: &Stretch, acceleration: f64) -> f64 {
        let top = before.speed.min(after.speed);
        if after.stopped {
            return 0.0;
        }
        let (Some(a), Some(b)) = (before.to, after.from) else { return top };
        // half the angle between the direction back and the direction on
        let cos = -(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).clamp(-1.0, 1.0);
        let half = (0.5 * (1.0 - cos)).sqrt();
        let straight = 1.0 - half;
        if straight < 1e-9 {
            return top;
        }
        top.min((acceleration * self.corner_tolerance * half / straight).sqrt())
    }

    /// The time of one stretch between speeds at its ends, s.
    fn seconds(&self, stretch: &Stretch, from: f64, to: f64) -> f64 {
        let moving = match self.acceleration {
            _ if stretch.length <= 0.0 => 0.0,
            None => stretch.length / stretch.speed,
            Some(acceleration) => trapezoid(stretch.length, stretch.speed, from, to, acceleration),
        };
        moving.max(self.blocks_per_second.map_or(0.0, f64::recip))
    }
}

/// Speeds up to `top` if the length allows it, then down: the time, s.
fn trapezoid(length: f64, top: f64, from: f64, to: f64, acceleration: f64) -> f64 {
    let peak = (acceleration * length + 0.5 * (from * from + to * to)).sqrt().min(top.max(from).max(to));
    let ramps = (2.0 * peak * peak - from * from - to * to) / (2.0 * acceleration);
    (2.0 * peak - from - to) / acceleration + (length - ramps).max(0.0) / peak
}

/// A move as its dynamics see it.
struct Stretch {
    /// mm
    length: f64,
    /// Highest speed, mm/s.
    speed: f64,
    /// Direction at both ends; none when its length is 0.
    from: Option<[f64; 3]>,
    to: Option<[f64; 3]>,
    /// Whether the machine stands before it.
    stopped: bool,
}

fn direction(a: [f64; 3], b: [f64; 3]) -> Option<[f64; 3]> {
    let along = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
    (length > 0.0).then(|| along.map(|x| x / length))
}

/// The spindle's speed after an event, rev/min; none while it stands.
fn rpm_after(event: &EventKind, before: Option<f64>) -> Option<f64> {
    match event {
        EventKind::SpindleOn { rpm, .. } => Some(*rpm),
        EventKind::SpindleOff | EventKind::ToolChange { .. } => None,
        _ => before,
    }
}

/// How long an event lasts, s.
fn seconds_of(event: &EventKind) -> f64 {
    match event {
        EventKind::Dwell { seconds } => *seconds,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Arc, Event, FeedMode, MoveKind, OperationRecord, Plane, Pose, SetupRecord, SpindleDirection};

    const PLAIN: Dynamics =
        Dynamics { rapid_rate: 6000.0, acceleration: Some(1000.0), corner_tolerance: 0.0, blocks_per_second: None };

    fn program(moves: &[(MoveKind, [f64; 3])]) -> Program {
        let step = |(kind, tip): &(MoveKind, [f64; 3])| Move::new(*kind, *tip, 6000.0);
        let setup = SetupRecord { wcs: "G54".into(), ..SetupRecord::default() };
        let operations = vec![OperationRecord { id: "a".into(), kind: "z-level".into(), tool: 0 }];
        Program { moves: moves.iter().map(step).collect(), ..Program::empty(setup, Vec::new(), operations) }
    }

    fn line() -> Program {
        program(&[(MoveKind::Rapid, [0.0; 3]), (MoveKind::Feed, [100.0, 0.0, 0.0])])
    }

    #[test]
    fn a_trapezoid_by_hand() {
        // 100 mm at 100 mm/s: 0.1 s and 5 mm up, as much down, 90 mm between: 1.1 s
        let (times, whole) = PLAIN.times(&line());
        assert!((times[1] - 1.1).abs() < 1e-12 && (whole - 1.1).abs() < 1e-12, "{times:?}");
        // 2.5 mm: up and down at 50 mm/s at most, 0.1 s
        let short = program(&[(MoveKind::Rapid, [0.0; 3]), (MoveKind::Feed, [2.5, 0.0, 0.0])]);
        assert!((PLAIN.times(&short).1 - 0.1).abs() < 1e-12);
        assert!((Dynamics::at_once(6000.0).times(&line()).1 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn straight_on_costs_nothing_and_a_corner_a_stop() {
        let on = [(MoveKind::Rapid, [0.0; 3]), (MoveKind::Feed, [40.0, 0.0, 0.0]), (MoveKind::Feed, [100.0, 0.0, 0.0])];
        assert!((PLAIN.times(&program(&on)).1 - 1.1).abs() < 1e-9);
        let corner =
            [(MoveKind::Rapid, [0.0; 3]), (MoveKind::Feed, [50.0, 0.0, 0.0]), (MoveKind::Feed, [50.0, 50.0, 0.0])];
        assert!((PLAIN.times(&program(&corner)).1 - 1.2).abs() < 1e-9);
        // a right angle cut by 0.01 mm: v^2 = a d sin 45 / (1 - sin 45), 4.914 mm/s there
        let rounded = Dynamics { corner_tolerance: 0.01, ..PLAIN };
        let v = (1000.0 * 0.01 * 0.5_f64.sqrt() / (1.0 - 0.5_f64.sqrt())).sqrt();
        let each = 0.1 + (100.0 - v) / 1000.0 + (50.0 - 5.0 - (100.0_f64.powi(2) - v * v) / 2000.0) / 100.0;
        assert!((rounded.times(&program(&corner)).1 - 2.0 * each).abs() < 1e-9);
    }

    #[test]
    fn events_stop_and_dwells_last() {
        let mut waits = line();
        waits.moves.push(waits.moves[1].to([200.0, 0.0, 0.0]));
        waits.events.push(Event { before: 2, kind: EventKind::Dwell { seconds: 0.5 } });
        waits.events.push(Event { before: 3, kind: EventKind::Dwell { seconds: 2.0 } });
        let (times, whole) = PLAIN.times(&waits);
        assert!((times[2] - (1.1 + 0.5 + 1.1)).abs() < 1e-9 && (whole - times[2] - 2.0).abs() < 1e-9);
    }

    #[test]
    fn blocks_take_their_time_and_arcs_their_radius() {
        let slow = Dynamics { acceleration: None, blocks_per_second: Some(100.0), ..PLAIN };
        let short: Vec<_> = (0..101).map(|i| (MoveKind::Feed, [0.01 * f64::from(i), 0.0, 0.0])).collect();
        assert!((slow.times(&program(&short)).1 - 1.01).abs() < 1e-9);
        // a circle of radius 1 at 1000 mm/s^2: 31.6 mm/s at most
        let mut circle = line();
        circle.moves[1].end = Pose::upright([0.0; 3]);
        circle.moves[1].arc = Some(Arc { centre: [1.0, 0.0, 0.0], plane: Plane::Xy, clockwise: true, turns: 0 });
        let (length, top) = (std::f64::consts::TAU, 1000.0_f64.sqrt());
        assert!((PLAIN.times(&circle).1 - (length / top + top / 1000.0)).abs() < 1e-9);
    }
    #[test]
    fn feeds_of_other_modes_have_their_speed() {
        let timed = |feed, mode, rpm: Option<f64>| {
            let mut program = line();
            program.moves[1] = program.moves[1].with_feed(feed, mode);
            let direction = SpindleDirection::Clockwise;
            let on = rpm.map(|rpm| Event { before: 1, kind: EventKind::SpindleOn { rpm, direction } });
            program.events.extend(on);
            Dynamics::at_once(6000.0).times(&program).1
        };
        // 100 mm in half a minute; at 0.1 mm/rev and 1000 rev/min in one
        assert!((timed(2.0, FeedMode::InverseTime, None) - 30.0).abs() < 1e-9);
        assert!((timed(0.1, FeedMode::PerRevolution, Some(1000.0)) - 60.0).abs() < 1e-9);
        // no spindle, no feed: as without a feed, at the rapid rate
        assert!((timed(0.1, FeedMode::PerRevolution, None) - 1.0).abs() < 1e-9);
    }
}
