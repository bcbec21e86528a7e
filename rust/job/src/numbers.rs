//! Numbers in messages.

/// A number as people write it, without hundreds of zeros.
pub fn shown(value: f64) -> String {
    if value == 0.0 || (1e-5..1e9).contains(&value.abs()) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}
