//! What may be wrong with tabs.

use super::{plain, FaultKind};
use crate::findings::FindingKind;

pub(crate) static TAB_NUMBER: FaultKind = FaultKind::on_part(
    FindingKind::Tabs,
    |fault| format!("this loop has {} tabs, and {} in the job", plain(fault.value()), plain(fault.limit())),
    "post the whole operation, or correct tabs",
)
.in_unit("");
pub(crate) static TAB_HEIGHT: FaultKind = FaultKind::on_part(
    FindingKind::Tabs,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the tool is lifted by {value:.3} mm over a tab ({limit:.3} mm in the job)")
    },
    "post the whole operation, or correct tabs.height",
);
pub(crate) static TAB_WIDTH: FaultKind = FaultKind::on_part(
    FindingKind::Tabs,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the tool is lifted over {value:.3} mm of the contour, and a tab takes {limit:.3} mm")
    },
    "post the whole operation, or correct tabs.width",
);
pub(crate) static TAB_CUT: FaultKind = FaultKind::on_part(
    FindingKind::Tabs,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("a tab is cut: the tool goes down to Z{value:.3} within it, and its top is at Z{limit:.3}")
    },
    "give all operations that pass there the same tabs, or remove the moves that cut them",
);
