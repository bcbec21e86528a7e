//! What a kind of operation knows of the effort that planning it takes.

/// The faces of an operation as their areas show them, mm and mm^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Areas {
    /// Area in plan, over all triangles.
    pub plan: f64,
    /// Area in elevation: sum of the triangles' areas times the sine of their slopes.
    pub elevation: f64,
    /// Area of the part's box in plan.
    pub plan_box: f64,
}

/// What planning takes, by its kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// The key that decides, and its value in mm: "stepover".
    pub key: &'static str,
    /// Its value, mm.
    pub pitch: f64,
    /// Length of the path over the part, mm.
    pub length: f64,
    /// Whether a grid over the part is sampled first.
    pub samples_grid: bool,
    /// Seconds for a point of the path, on two threads of a machine of 2024, within a factor of three.
    pub seconds_per_point: f64,
}
