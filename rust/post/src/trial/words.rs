//! What a program holds, in words.

use styluscam_motion::{Cycle, CycleKind, EventKind, MoveKind, Program, SpindleDirection};

/// An event of a program.
pub(super) fn event(kind: &EventKind, program: &Program) -> String {
    match kind {
        EventKind::ToolChange { tool } => match program.tools.get(*tool as usize) {
            Some(tool) => format!("a change to tool {}", tool.number),
            None => format!("a change to a tool that the program does not list (index {tool})"),
        },
        EventKind::SpindleOn { rpm, direction: SpindleDirection::Clockwise } => {
            format!("the spindle clockwise at {rpm} rev/min")
        }
        EventKind::SpindleOn { rpm, direction: SpindleDirection::Counterclockwise } => {
            format!("the spindle counterclockwise at {rpm} rev/min")
        }
        EventKind::SpindleOff => "the spindle off".into(),
        EventKind::Mist { on } => format!("mist {}", switched(*on)),
        EventKind::Flood { on } => format!("flood {}", switched(*on)),
        EventKind::Stop { optional: false } => "a stop".into(),
        EventKind::Stop { optional: true } => "an optional stop".into(),
        EventKind::WorkOffset { wcs } => format!("work offset {wcs}"),
        EventKind::Probe { end, feed, must_touch } => {
            let ends: String = ["X", "Y", "Z"].iter().zip(end).filter_map(|(name, end)| axis(name, *end)).collect();
            let else_stop = if *must_touch { ", with an error if nothing is touched" } else { "" };
            format!("a probing move to{ends} at {feed} mm/min{else_stop}")
        }
        EventKind::Raw { text } => text.clone(),
        EventKind::Sync { mark } => format!("synchronisation mark {mark}"),
        EventKind::Comment { text } => format!("the comment {text:?}"),
        EventKind::Dwell { seconds } => format!("a dwell of {seconds} s"),
    }
}

fn axis(name: &str, end: Option<f64>) -> Option<String> {
    end.map(|end| format!(" {name}{end:.4}"))
}

/// A canned cycle.
pub(super) fn cycle(cycle: &Cycle) -> String {
    let kind = match cycle.kind {
        CycleKind::Drill => "a drilling cycle",
        CycleKind::Peck => "a peck drilling cycle",
        CycleKind::ChipBreak => "a chip breaking cycle",
        CycleKind::Tap => "a tapping cycle",
        CycleKind::LeftTap => "a left-hand tapping cycle",
        CycleKind::Bore => "a boring cycle",
        CycleKind::StopBore => "a boring cycle with spindle stop",
    };
    let Cycle { at: [x, y], retract, bottom, feed, dwell, peck, .. } = cycle;
    let mut text = format!("{kind} at X{x:.4} Y{y:.4} from Z{retract:.4} to Z{bottom:.4} at {feed} mm/min");
    if *dwell > 0.0 {
        text.push_str(&format!(", dwell {dwell} s"));
    }
    if *peck > 0.0 {
        text.push_str(&format!(", pecks of {peck} mm"));
    }
    text
}

/// Whether something is on.
pub(super) fn switched(on: bool) -> &'static str {
    if on {
        "on"
    } else {
        "off"
    }
}

/// A kind of move.
pub(super) fn motion(kind: MoveKind) -> &'static str {
    match kind {
        MoveKind::Rapid => "rapid",
        MoveKind::Feed => "feed move",
    }
}

/// A position of the tip.
pub(super) fn position([x, y, z]: [f64; 3]) -> String {
    format!("X{x:.4} Y{y:.4} Z{z:.4}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use styluscam_motion::SetupRecord;

    #[test]
    fn an_event_is_described_in_words() {
        let program = Program::empty(SetupRecord::default(), Vec::new(), Vec::new());
        let described = |kind: EventKind| event(&kind, &program);
        assert_eq!(described(EventKind::SpindleOff), "the spindle off");
        assert_eq!(described(EventKind::Dwell { seconds: 0.5 }), "a dwell of 0.5 s");
        let probe = EventKind::Probe { end: [Some(1.0), None, Some(-2.0)], feed: 50.0, must_touch: true };
        let words = "a probing move to X1.0000 Z-2.0000 at 50 mm/min, with an error if nothing is touched";
        assert_eq!(described(probe), words);
    }
}
