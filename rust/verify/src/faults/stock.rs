//! Faults of moves that clear stock.

use super::{Fault, FaultKind};
use crate::findings::FindingKind;

pub(crate) static ENGAGEMENT: FaultKind = FaultKind::on_part(
    FindingKind::Engagement,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the tool engages {value:.1} degrees of the stock at once ({limit:.1} degrees are allowed)")
    },
    "post the job again, or raise engagement_deg",
)
.in_unit("deg");
pub(crate) static STOCK_TO_LEAVE: FaultKind = FaultKind::on_part(
    FindingKind::StockToLeave,
    |fault| format!("the tool takes {:.4} mm of the stock that is to be left on the part", fault.value()),
    "post the job again, or lower radial_stock_to_leave and axial_stock_to_leave",
);
pub(crate) static LINK_IN_STOCK: FaultKind = FaultKind::on_part(
    FindingKind::Engagement,
    |fault| format!("a link is to cut nothing, and {:.1} degrees of the tool's rim are in stock", fault.value()),
    "post the job again, or raise the link over the stock",
)
.in_unit("deg");
pub(crate) static UNDER_STOCK: FaultKind = FaultKind::on_part(
    FindingKind::Engagement,
    |fault| {
        format!("the tool goes on below stock that is not cleared: {:.1} degrees of its rim are in it", fault.value())
    },
    "post the job again: what lies above is cleared first",
)
.in_unit("deg");
pub(crate) static REMOVAL_RATE: FaultKind = FaultKind::on_part(
    FindingKind::RemovalRate,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("with its stepover this move may have F{limit:.0}, and has F{value:.0}: more stock is removed in a minute than on a full pass")
    },
    "lower this feed, post the job again, or raise feeds.cut",
)
.in_unit("mm/min");
pub(crate) static STEEP_ENTRY: FaultKind = FaultKind::on_part(
    FindingKind::SteepEntry,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the tool goes down into stock at {value:.1} degrees ({limit:.1} degrees are allowed)")
    },
    "come down by a helix, or where the stock is cleared",
)
.in_unit("deg");

pub(crate) static RAPID_IN_STOCK: FaultKind = FaultKind::on_part(
    FindingKind::RapidIntoStock,
    |fault| {
        format!("a rapid enters stock that is not cleared: {:.1} degrees of the tool's rim are in it", fault.value())
    },
    "retract first, and come down where the stock is cleared",
)
.in_unit("deg");

pub(crate) static RAPID_BELOW_LEVELS: FaultKind =
    FaultKind::on_part(FindingKind::RapidIntoStock, |fault| below_levels("a rapid", fault), BELOW_LEVELS);
pub(crate) static FEED_BELOW_LEVELS: FaultKind =
    FaultKind::on_part(FindingKind::SteepEntry, |fault| below_levels("a feed", fault), BELOW_LEVELS);

const BELOW_LEVELS: &str = "correct this coordinate, or post the operation again";

fn below_levels(what: &str, fault: &Fault) -> String {
    let (value, limit) = (fault.value(), fault.limit());
    format!("{what} goes down to Z{value:.3}, and the operation's levels and what they clear end at Z{limit:.3}")
}

pub(crate) static STOCK_ABOVE: FaultKind = FaultKind::on_part(
    FindingKind::StockAbove,
    |fault| {
        format!("stock stands above the height at which the operation begins, up to {:.3} mm above it", fault.value())
    },
    "raise z_top, or have an operation before it take what stands there",
);
pub(crate) static LEVEL_ABOVE: FaultKind = FaultKind::on_part(
    FindingKind::StockAbove,
    |fault| format!("stock stands here that the level at Z{:.3} is to take before", fault.value()),
    "post the job again: levels are cut from the top down",
);
pub(crate) static SHANK_IN_STOCK: FaultKind = FaultKind::on_part(
    FindingKind::ShankCollision,
    |fault| format!("the shank is in stock that stands up to {:.3} mm above its underside", fault.value()),
    "use a tool with a longer base, or have an operation before it take what stands there",
);
pub(crate) static HOLDER_IN_STOCK: FaultKind = FaultKind::on_part(
    FindingKind::HolderCollision,
    |fault| format!("the holder is in stock that stands up to {:.3} mm above its underside", fault.value()),
    "let the tool stick out farther, or have an operation before it take what stands there",
);
pub(crate) static DEEP_IN_STOCK: FaultKind = FaultKind::on_part(
    FindingKind::StockAbove,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the pass cuts {value:.3} mm deep through stock at once (the tool is {limit:.3} mm wide)")
    },
    "have roughing take what stands there before",
);
