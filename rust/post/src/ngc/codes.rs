//! Which codes the tracer knows, and how they are written. G codes are in tenths: 382 is G38.2.

use crate::block::{g_code, m_code, Code};

/// What a code asks for; none where that is not known here.
pub(super) fn known_g(code: u32) -> Option<Code> {
    g_code(code).filter(|code| *code != Code::BackBore)
}

pub(super) fn knows_m(code: u32) -> bool {
    m_code(code).is_some()
}

/// Whether a code moves by the axis words of its block.
pub(super) fn moves(code: u32) -> bool {
    known_g(code).is_some_and(Code::moves)
}

/// Whether a code uses the axis words of its block; two such codes do not go together.
pub(super) fn takes_axes(code: u32) -> bool {
    known_g(code).is_some_and(Code::takes_axes)
}

/// As it is written.
pub(super) fn name_g(code: u32) -> String {
    match code % 10 {
        0 => format!("G{}", code / 10),
        tenth => format!("G{}.{tenth}", code / 10),
    }
}
