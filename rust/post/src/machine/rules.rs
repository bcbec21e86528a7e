//! The tables of a machine file: plain data, one struct per table.

mod charset;
mod functions;
mod motion;
mod reading;
mod rotary;
mod source;
mod text;

pub(crate) use charset::ranges;
pub use functions::{
    CoolantRules, DwellRules, LengthRules, RetractRules, SpeedUnit, SpindleRules, StopRules, TimeUnit, ToolChange,
    ToolRules,
};
pub use motion::{
    ArcCentre, ArcRules, CycleRules, FeedMode, FeedRules, Lathe, Limits, MotionRules, ProbeRules, RadiusError, Rapids,
    SmoothingRules, Turns,
};
pub use reading::{AfterEnd, BlockDelete, ReaderRules, Templates};
pub use rotary::{Carrier, RotaryAxis, RotaryRules, TipControl};
pub use source::{Evidence, Family, ProgramName, ProgramNumber, ProgramRules, Source};
pub use text::{
    BlockNumber, CommentForm, CommentRules, Counted, Decimals, LengthUnit, LineEnd, LineRules, NumberRules, Numbered,
    Point, Repeat, Separator, TrailingZeros, Units, WordRules,
};

/// What switches are that are left out.
fn yes() -> bool {
    true
}
