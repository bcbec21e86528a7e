//! Between which heights an operation's tip stays.

use styluscam_geometry::Tool;

use crate::Scene;

/// Heights of the tip, work coordinates, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TipHeights {
    /// Lowest; minus infinity where the tool goes as low as it touches.
    pub bottom: f64,
    /// Highest that was asked for by name, if any.
    pub top: Option<f64>,
}

impl TipHeights {
    /// What selected triangles keep below their lowest touch where the tip stops at `bottom`: the most, mm; none where
    /// it is within `tolerance`.
    pub fn untouched(&self, scene: &Scene, tool: &Tool, selected: &[bool], tolerance: f64) -> Option<f64> {
        let left = |triangle: usize| {
            let normal = scene.mesh.normal(triangle);
            let slope = libm::atan2(libm::hypot(normal.x, normal.y), normal.z).min(std::f64::consts::FRAC_PI_2);
            let heights = scene.mesh.corners(triangle).map(|corner| corner.z);
            let [low, high] = [f64::min, f64::max].map(|of| heights.into_iter().fold(heights[0], of));
            let touched_from = self.bottom + tool.point_at(slope).1;
            touched_from.min(high) - low
        };
        let most = (0..selected.len()).filter(|t| selected[*t]).map(left).fold(0.0, f64::max);
        (most > tolerance).then_some(most)
    }
}
