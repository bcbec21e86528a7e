//! Plan coordinates along and across rows.

/// Unit directions in plan, along rows and across them.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub along: [f64; 2],
    pub across: [f64; 2],
}

impl Frame {
    /// A vector of the plan, along and across.
    #[inline]
    pub fn of(&self, vector: [f64; 2]) -> [f64; 2] {
        [self.along, self.across].map(|axis| dot(axis, vector))
    }
}

#[inline]
pub fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[inline]
pub fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

#[inline]
pub fn length(vector: [f64; 2]) -> f64 {
    dot(vector, vector).sqrt()
}
