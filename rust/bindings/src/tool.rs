//! Tools.

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use styluscam_geometry::ToolFlank;

use crate::{arrays::mapped, errors, json::json};

/// One value for each entry of an array.
type Values<'py> = Bound<'py, PyArray1<f64>>;

/// A profile document of each kind with sensible numbers, as JSON.
#[pyfunction]
pub fn profile_starters() -> Vec<&'static str> {
    styluscam_geometry::ProfileDocument::starters()
}

/// Whether a part of a profile is straight, its first and last slope, and its ends as radius and height.
type OutlinePart = (bool, [f64; 2], [(f64, f64); 2]);

/// A checked tool; see `styluscam.Tool`.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Tool {
    pub(crate) tool: styluscam_geometry::Tool,
    pub(crate) cutter: styluscam_geometry::Cutter,
}

impl Tool {
    fn side(&self) -> PyResult<ToolFlank> {
        self.tool.flank().map_err(|error| errors::raise("ToolError", &error.to_string(), "tapered-flank", "tool", ""))
    }
}

#[pymethods]
impl Tool {
    /// From a tool document as JSON.
    #[new]
    fn new(document: &str) -> PyResult<Self> {
        let document = styluscam_job::tool_from_json(document)
            .map_err(|e| errors::raise("ToolError", &e.to_string(), e.code(), &e.location(), &e.hint()))?;
        let tool = styluscam_geometry::Tool::new(document).map_err(|e| errors::of_tool(&e))?;
        Ok(Self { cutter: tool.cutter(), tool })
    }

    fn to_json(&self) -> PyResult<String> {
        json(self.tool.document())
    }

    /// What was done to the document's curve, as JSON.
    fn report(&self) -> PyResult<String> {
        json(self.tool.report())
    }

    #[getter]
    fn description(&self) -> String {
        self.tool.description()
    }

    #[getter]
    fn max_slope(&self) -> f64 {
        self.tool.profile().max_slope()
    }

    /// Radius (mm), half angle (rad), height of the lower end and of the upper one over the tip (mm) of the side with which it mills.
    fn flank(&self) -> PyResult<(f64, f64, f64, f64)> {
        let ToolFlank { radius, half_angle, height, top } = self.side()?;
        Ok((radius, half_angle, height, top))
    }

    /// Height over the tip at which that side touches a second rail, mm, where the axis between both rails' normals is so long, mm.
    fn flank_needed(&self, axis: f64) -> PyResult<f64> {
        Ok(self.side()?.needed(axis))
    }

    #[getter]
    fn diameter(&self) -> f64 {
        self.tool.diameter()
    }

    /// The parts of the profile from the tip to the base.
    fn outline(&self) -> Vec<OutlinePart> {
        let parts = self.tool.profile().outline();
        parts.iter().map(|part| (part.is_straight(), part.slopes(), part.ends())).collect()
    }

    fn radius_at<'py>(&self, py: Python<'py>, slope: PyReadonlyArray1<'py, f64>) -> PyResult<Values<'py>> {
        mapped(&slope, py, |s| self.tool.point_at(s).0)
    }

    /// Inner and outer radius at a slope: they differ where the profile is straight.
    fn radius_range_at<'py>(
        &self,
        py: Python<'py>,
        slope: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<(Values<'py>, Values<'py>)> {
        let inner = mapped(&slope, py, |s| self.tool.profile().inner_point_at(s).0)?;
        Ok((inner, mapped(&slope, py, |s| self.tool.point_at(s).0)?))
    }

    fn height_at<'py>(&self, py: Python<'py>, slope: PyReadonlyArray1<'py, f64>) -> PyResult<Values<'py>> {
        mapped(&slope, py, |s| self.tool.point_at(s).1)
    }

    fn curvature_radius_at<'py>(&self, py: Python<'py>, slope: PyReadonlyArray1<'py, f64>) -> PyResult<Values<'py>> {
        mapped(&slope, py, |s| self.cutter.curvature_radius_at(s))
    }

    fn height_at_radius<'py>(&self, py: Python<'py>, radius: PyReadonlyArray1<'py, f64>) -> PyResult<Values<'py>> {
        mapped(&radius, py, |r| self.cutter.height_at_radius(r))
    }
}
