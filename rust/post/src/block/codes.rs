//! What G and M codes ask for: one table. G codes are in tenths: 382 is G38.2.
//!
//! Sources: T. Kramer, F. Proctor, E. Messina, NISTIR 6556, 2000, tables 3 to 5; LinuxCNC's manual, "G-Codes", "M-Codes".

use styluscam_motion::{Plane, SpindleDirection};

use crate::machine::{FeedMode, LengthUnit};

/// What a code asks for. Each variant is a modal group of its own, of which a block holds one, but for G10, G28, G92 and
/// the like, which share none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Code {
    Motion(Motion),
    /// Moves that have no modal group here: curves (G5), threads (G33), contours (G70 to G72).
    OtherMotion,
    /// Whether a probe must touch: G38.2, not G38.3.
    Probe(bool),
    /// G87, which neither reader nor tracer carries out.
    BackBore,
    Dwell,
    Plane(Plane),
    Unit(LengthUnit),
    /// Whether G91, not G90.
    Incremental(bool),
    /// Whether G90.1, not G91.1.
    AbsoluteCentre(bool),
    FeedMode(FeedMode),
    /// Whether G99, not G98.
    LowReturn(bool),
    /// Whether it is switched on: G41, not G40.
    Compensation(bool),
    Length(Length),
    /// Whether the control tracks the tip, by a machine's own code.
    TipControl(bool),
    MachineCoordinates,
    WorkOffset,
    /// How closely the path is kept: G61, G64.
    PathMode,
    /// To a stored point: G28, G30.
    Home,
    /// A stored point is set: G28.1, G30.1.
    SetHome,
    /// The zero point is shifted: G10, G52, G92.
    Shift,
    /// A shift is taken back or brought back: G92.1 to G92.3.
    ShiftOff,
    Stop(Stop),
    /// None stops it.
    Spindle(Option<SpindleDirection>),
    ToolChange,
    Mist,
    Flood,
    CoolantOff,
    /// M98, M99.
    Subroutine,
    /// Known, and of no consequence for a path on three axes but for diameters (G7) and surface speed (G96).
    Other,
}

/// What G0, G1, G2, G3 or G80 ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    Rapid,
    Feed,
    /// Clockwise or not.
    Arc(bool),
    /// G73 to G89, by its number.
    Cycle(u16),
    Cancel,
}

/// Where a tool's length comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Length {
    /// G43.
    Table,
    /// G43.1: the block's axis words.
    Words,
    /// G43.2: added to the one in force.
    Added,
    /// G43.4, where a machine's file has it: the table's, and the control tracks the tip.
    Tip,
    /// G49.
    Off,
}

/// What M0, M1, M2 or M30 ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stop {
    Pause,
    OptionalPause,
    End,
}

/// What a G code asks for; none for codes that are in neither source.
pub(crate) fn g_code(tenths: u32) -> Option<Code> {
    Some(match tenths {
        0 => Code::Motion(Motion::Rapid),
        10 => Code::Motion(Motion::Feed),
        20 | 30 => Code::Motion(Motion::Arc(tenths == 20)),
        800 => Code::Motion(Motion::Cancel),
        730 | 740 | 760 | 810 | 820 | 830 | 840 | 850 | 860 | 880 | 890 => {
            Code::Motion(Motion::Cycle(u16::try_from(tenths / 10).ok()?))
        }
        870 => Code::BackBore,
        50..=53 | 330 | 331 | 700 | 710..=712 | 720..=722 => Code::OtherMotion,
        382..=385 => Code::Probe(tenths.is_multiple_of(2)),
        40 => Code::Dwell,
        170 => Code::Plane(Plane::Xy),
        180 => Code::Plane(Plane::Zx),
        190 => Code::Plane(Plane::Yz),
        200 => Code::Unit(LengthUnit::Inch),
        210 => Code::Unit(LengthUnit::Mm),
        900 | 910 => Code::Incremental(tenths == 910),
        901 | 911 => Code::AbsoluteCentre(tenths == 901),
        930 => Code::FeedMode(FeedMode::InverseTime),
        940 => Code::FeedMode(FeedMode::PerMinute),
        950 => Code::FeedMode(FeedMode::PerRevolution),
        980 | 990 => Code::LowReturn(tenths == 990),
        400 => Code::Compensation(false),
        410 | 411 | 420 | 421 => Code::Compensation(true),
        430 => Code::Length(Length::Table),
        431 => Code::Length(Length::Words),
        432 => Code::Length(Length::Added),
        490 => Code::Length(Length::Off),
        530 => Code::MachineCoordinates,
        540 | 550 | 560 | 570 | 580 | 590..=593 => Code::WorkOffset,
        610 | 611 | 640 => Code::PathMode,
        280 | 300 => Code::Home,
        281 | 301 => Code::SetHome,
        100 | 520 | 920 => Code::Shift,
        921..=923 => Code::ShiftOff,
        70 | 80 | 171 | 181 | 191 | 960 | 970 => Code::Other,
        _ => return None,
    })
}

/// What an M code asks for; none for codes that are in neither source.
pub(crate) fn m_code(number: u32) -> Option<Code> {
    Some(match number {
        0 => Code::Stop(Stop::Pause),
        1 => Code::Stop(Stop::OptionalPause),
        2 | 30 => Code::Stop(Stop::End),
        3 => Code::Spindle(Some(SpindleDirection::Clockwise)),
        4 => Code::Spindle(Some(SpindleDirection::Counterclockwise)),
        5 => Code::Spindle(None),
        6 => Code::ToolChange,
        7 => Code::Mist,
        8 => Code::Flood,
        9 => Code::CoolantOff,
        98 | 99 => Code::Subroutine,
        19 | 48..=53 | 60..=68 | 70..=73 => Code::Other,
        _ => return None,
    })
}

impl Code {
    /// Whether it moves by the axis words of its block.
    pub(crate) fn moves(self) -> bool {
        matches!(self, Self::Motion(motion) if motion != Motion::Cancel)
            || matches!(self, Self::OtherMotion | Self::Probe(_))
    }

    /// Whether it uses the axis words of its block; two such codes do not go together.
    pub(crate) fn takes_axes(self) -> bool {
        let sets =
            matches!(self, Self::Shift | Self::Home | Self::SetHome | Self::Length(Length::Words | Length::Added));
        sets || self.moves()
    }
}
