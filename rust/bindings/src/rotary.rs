//! Machines with two rotary axes: text for them, and what it means.

use numpy::PyArray2;
use pyo3::prelude::*;
use styluscam_post::{read_rotary, rotary_text, Carrier, RotaryAxes, RotaryAxis, RotaryError, RotaryText};

use crate::{errors, machine::Machine, program::Program};

/// An axis: letter, whether it carries the tool, direction, a point of it (mm), limits (deg).
type AxisColumns = (char, bool, [f64; 3], [f64; 3], [f64; 2]);

/// Points and directions, each (N, 3).
type Poses<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);

/// Two rotary axes, the lines that switch the tip's control on and off where there is one, decimals of angles, and how far the tip
/// may leave its line, mm.
#[pyclass(frozen, module = "styluscam._engine")]
#[derive(Debug)]
pub struct Rotary {
    axes: RotaryAxes,
    form: RotaryText,
}

#[pymethods]
impl Rotary {
    #[new]
    #[pyo3(signature = (axes, tip_control, angle_decimals, tolerance))]
    fn new(
        axes: [AxisColumns; 2],
        tip_control: Option<[String; 2]>,
        angle_decimals: u8,
        tolerance: f64,
    ) -> PyResult<Self> {
        let axes = axes.map(|(letter, is_head, direction, pivot, limits_deg)| {
            let carrier = if is_head { Carrier::Head } else { Carrier::Table };
            RotaryAxis { letter, carrier, direction, pivot, limits_deg }
        });
        let axes = RotaryAxes::new(axes).map_err(|error| of_rotary(&error))?;
        Ok(Self { axes, form: RotaryText { tip_control, angle_decimals, tolerance } })
    }

    /// The text of a program.
    fn post(&self, py: Python<'_>, program: &Program, machine: &Machine) -> PyResult<String> {
        py.detach(|| rotary_text(&program.program, &machine.machine, &self.axes, &self.form))
            .map_err(|error| of_rotary(&error))
    }

    /// The poses of such a text: tips (N, 3), mm, and directions (N, 3).
    fn read<'py>(&self, py: Python<'py>, text: &str, machine: &Machine) -> PyResult<Poses<'py>> {
        let found = read_rotary(text, &machine.machine, &self.axes, &self.form).map_err(|error| of_rotary(&error))?;
        let (tips, axes): (Vec<_>, Vec<_>) = found.iter().map(|(tip, axis)| (tip.to_vec(), axis.to_vec())).unzip();
        Ok((PyArray2::from_vec2(py, &tips)?, PyArray2::from_vec2(py, &axes)?))
    }
}

fn of_rotary(error: &RotaryError) -> PyErr {
    errors::raise("MachineError", &error.to_string(), error.code(), "", &error.hint())
}
