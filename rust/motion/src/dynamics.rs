//! How long a program takes on a machine that must accelerate, slow down in corners and read its blocks: docs/concepts/time.md.

use crate::ramps::{self, Corners, Stretch};
use crate::{EventKind, Move, Plane, Program};

/// Seconds in a minute.
const MINUTE: f64 = 60.0;

/// What of a machine decides how fast it follows a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// Speed of rapids, mm/min.
    pub rapid_rate: f64,
    /// Fastest of X, Y and Z, mm/min.
    pub axis_rate: Option<[f64; 3]>,
    /// Acceleration along the path, mm/s^2; without it, and without those of the axes, speeds change at once.
    pub acceleration: Option<f64>,
    /// Accelerations of X, Y and Z, mm/s^2, which decide along the path where they are known.
    pub axis_acceleration: Option<[f64; 3]>,
    /// How far the controller cuts corners, mm; at 0 it stops in each.
    pub corner_tolerance: f64,
    /// Whether it runs along arcs that cut corners, within moves: else corners are as fast as such arcs of any length.
    pub blends: bool,
    /// Whether it stops between rapids and feeds.
    pub stops_at_rapids: bool,
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
        Self {
            rapid_rate,
            axis_rate: None,
            acceleration: None,
            axis_acceleration: None,
            corner_tolerance: 0.0,
            blends: false,
            stops_at_rapids: false,
            blocks_per_second: None,
        }
    }

    /// The time at the end of every move from the start of the program, s; and at the program's own end.
    ///
    /// The speed changes evenly within a move. A corner is taken as fast as a circle allows that leaves it by the corner
    /// tolerance at most (S. K. Jeon, "Improving Grbl: Cornering Algorithm", 2011); an arc as fast as its radius allows.
    /// A controller that blends runs along that circle, which takes half of the shorter move at most.
    /// Events stop the machine. No block is faster than the controller reads. The path to the first point is not known
    /// and takes no time; neither do tool changes, and turns of the tool's axis.
    #[must_use]
    pub fn times(&self, program: &Program) -> (Vec<f64>, f64) {
        let stretches = self.stretches(program);
        let corners = Corners { tolerance: self.corner_tolerance, blends: self.blends, axes: self.axis_acceleration };
        let moving = ramps::seconds(&stretches, &corners);
        let mut upcoming = program.upcoming();
        let mut waits = |index| upcoming.before(index).map(seconds_of).sum::<f64>();
        let least = self.blocks_per_second.map_or(0.0, f64::recip);
        let mut clock = 0.0;
        let times = moving.iter().enumerate().map(|(index, seconds)| {
            clock += waits(index) + seconds.max(least);
            clock
        });
        let times = times.collect();
        (times, clock + waits(program.moves.len()))
    }

    fn stretches(&self, program: &Program) -> Vec<Stretch> {
        let mut upcoming = program.upcoming();
        let mut stretches = Vec::with_capacity(program.moves.len());
        let (mut rpm, mut kind) = (None, None);
        for (index, (start, step)) in program.segments().enumerate() {
            let mut stopped = start.is_none();
            for event in upcoming.before(index) {
                stopped |= !matches!(event, EventKind::Comment { .. });
                rpm = rpm_after(event, rpm);
            }
            stopped |= self.stops_at_rapids && kind.replace(step.kind) != Some(step.kind);
            stretches.push(self.stretch(start.unwrap_or(step.end.tip), step, rpm, stopped));
        }
        stretches
    }

    fn stretch(&self, start: [f64; 3], step: &Move, rpm: Option<f64>, stopped: bool) -> Stretch {
        let path = step.path(start);
        let length = step.length(start);
        let heading =
            |from: f64, to: f64| path.map_or(direction(start, step.end.tip), |arc| direction(arc.at(from), arc.at(to)));
        let (from, to) = (heading(0.0, 1e-4), heading(1.0 - 1e-4, 1.0));
        let along = |each: [f64; 3]| match (step.arc, from) {
            (Some(arc), _) => ramps::least(each, turning(arc.plane, start, step.end.tip)),
            (None, Some(to)) => (0..3).map(|axis| each[axis] / to[axis].abs()).fold(f64::INFINITY, f64::min),
            (None, None) => f64::INFINITY,
        };
        let rate = step.mm_per_min(length, rpm).filter(|rate| *rate > 0.0 && rate.is_finite());
        let rate = rate.unwrap_or(self.rapid_rate).min(self.axis_rate.map_or(f64::INFINITY, along));
        let acceleration = self.axis_acceleration.map(along).or(self.acceleration).unwrap_or(f64::INFINITY);
        let across = step.arc.map(|arc| arc.plane.axes()[2]);
        let plain = Stretch { length, speed: rate / MINUTE, acceleration, from, to, across, stopped };
        match path {
            Some(path) if self.blends && acceleration.is_finite() => {
                let (speed, acceleration) = ramps::around(path.radius(), plain.speed, acceleration);
                Stretch { speed, acceleration, ..plain }
            }
            Some(path) => Stretch { speed: plain.speed.min((acceleration * path.radius()).sqrt()), ..plain },
            None => plain,
        }
    }
}

/// The axes that move along an arc.
fn turning(plane: Plane, start: [f64; 3], end: [f64; 3]) -> [bool; 3] {
    let [_, _, across] = plane.axes();
    [0, 1, 2].map(|axis| axis != across || (end[axis] - start[axis]).abs() > 0.0)
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
    use crate::{Arc, Event, FeedMode, MoveKind, OperationRecord, Pose, SetupRecord, SpindleDirection};

    const PLAIN: Dynamics = Dynamics {
        rapid_rate: 6000.0,
        axis_rate: None,
        acceleration: Some(1000.0),
        axis_acceleration: None,
        corner_tolerance: 0.0,
        blends: false,
        stops_at_rapids: false,
        blocks_per_second: None,
    };

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
    fn a_blend_takes_its_arc() {
        // a right angle cut by 0.1 mm: radius 0.1 / (sqrt 2 - 1), of which the acceleration allows 0.866 for the turn
        let corner =
            [(MoveKind::Rapid, [0.0; 3]), (MoveKind::Feed, [50.0, 0.0, 0.0]), (MoveKind::Feed, [50.0, 50.0, 0.0])];
        let blending = Dynamics { corner_tolerance: 0.1, blends: true, ..PLAIN };
        let radius = 0.1 / (2.0_f64.sqrt() - 1.0);
        let v = (866.0 * radius).sqrt();
        let ramps = 0.1 + (100.0 - v) / 1000.0;
        let even = (50.0 - radius - 5.0 - (100.0_f64.powi(2) - v * v) / 2000.0) / 100.0;
        let turn = radius * std::f64::consts::FRAC_PI_2 / v;
        let (times, whole) = blending.times(&program(&corner));
        assert!((whole - 2.0 * (ramps + even) - turn).abs() < 1e-9, "{whole}");
        assert!((times[1] - 0.5 * whole).abs() < 1e-9);
        // the arc ends in the middle of a short move, however far the corner may be cut: radius 0.5, then 49.5 mm
        let short =
            [(MoveKind::Rapid, [0.0; 3]), (MoveKind::Feed, [50.0, 0.0, 0.0]), (MoveKind::Feed, [50.0, 1.0, 0.0])];
        let far = Dynamics { corner_tolerance: 10.0, ..blending };
        let v = 433.0_f64.sqrt();
        let long = 0.1 + (100.0 - v) / 1000.0 + (49.5 - 5.0 - (1e4 - v * v) / 2000.0) / 100.0;
        // on the last half millimetre it stops from no more than sqrt(2 a s) = 31.6 mm/s: up to a peak and down
        let peak = (500.0 + 0.5 * v * v).sqrt();
        let last = (2.0 * peak - v) / 1000.0;
        let found = far.times(&program(&short)).1;
        assert!((found - long - 0.25 * std::f64::consts::PI / v - last).abs() < 1e-9, "{found}");
    }

    #[test]
    fn axes_have_their_own_limits() {
        // (3, 4) / 5: X allows 1000 / 0.6, Y 800 / 0.8: 1000 mm/s^2; 6000 mm/min for X and 4800 for Y: 100 mm/s
        let way = [(MoveKind::Rapid, [0.0; 3]), (MoveKind::Rapid, [60.0, 80.0, 0.0])];
        let limits = Dynamics {
            rapid_rate: 60000.0,
            axis_rate: Some([6000.0, 4800.0, 100.0]),
            axis_acceleration: Some([1000.0, 800.0, 10.0]),
            ..PLAIN
        };
        assert!((limits.times(&program(&way)).1 - 1.1).abs() < 1e-9);
    }

    #[test]
    fn rapids_and_feeds_are_apart_where_the_controller_stops() {
        let on =
            [(MoveKind::Rapid, [0.0; 3]), (MoveKind::Rapid, [50.0, 0.0, 0.0]), (MoveKind::Feed, [100.0, 0.0, 0.0])];
        assert!((PLAIN.times(&program(&on)).1 - 1.1).abs() < 1e-9);
        let stops = Dynamics { stops_at_rapids: true, ..PLAIN };
        assert!((stops.times(&program(&on)).1 - 1.2).abs() < 1e-9);
    }

    #[test]
    fn an_arc_shares_the_acceleration_of_a_blending_controller() {
        // a circle of radius 1 at 1000 mm/s^2: 29.4 mm/s, with half of the acceleration along it
        let mut circle = line();
        circle.moves[1].end = Pose::upright([0.0; 3]);
        circle.moves[1].arc = Some(Arc { centre: [1.0, 0.0, 0.0], plane: Plane::Xy, clockwise: true, turns: 0 });
        let blending = Dynamics { blends: true, ..PLAIN };
        let (length, top) = (std::f64::consts::TAU, 866.0_f64.sqrt());
        let along = 1000.0 * (1.0 - 0.866 * 0.866_f64).sqrt();
        assert!((blending.times(&circle).1 - (length / top + top / along)).abs() < 1e-9);
    }

    #[test]
    fn a_corner_out_of_the_plane_of_an_arc_halves_the_acceleration() {
        // up 50 mm at the end of a full circle of radius 50 in XY: no arc joins them, and both have 500 mm/s^2
        let mut up = line();
        up.moves[1].end = Pose::upright([0.0; 3]);
        up.moves[1].arc = Some(Arc { centre: [50.0, 0.0, 0.0], plane: Plane::Xy, clockwise: true, turns: 0 });
        let mut rise = up.moves[1].to([0.0, 0.0, 50.0]);
        rise.arc = None;
        up.moves.push(rise);
        let blending = Dynamics { blends: true, ..PLAIN };
        let turning = 100.0 * 100.0 / (50.0 * 1000.0);
        let along = 500.0 * (1.0_f64 - turning * turning).sqrt();
        let expected = std::f64::consts::TAU * 50.0 / 100.0 + 100.0 / along + 0.5 + 0.2;
        let found = blending.times(&up).1;
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
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
