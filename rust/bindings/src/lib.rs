//! PyO3 module `styluscam._engine`: conversions only, no algorithm.
//!
//! Documents cross as JSON text, arrays as numpy; the Python package gives both their types.

mod arrays;
mod errors;
mod freeform;
mod job;
mod machine;
mod offset;
mod part;
mod program;
mod simulation;
mod tool;
mod waiting;

use pyo3::prelude::*;

#[pymodule]
mod _engine {
    #[pymodule_export]
    use crate::freeform::{Nurbs, Search};
    #[pymodule_export]
    use crate::job::{job_schema, judge, materials, plan, read_back, starter, trace_gcode};
    #[pymodule_export]
    use crate::job::{Job, Judgement, Plan, Scene};
    #[pymodule_export]
    use crate::machine::{
        cl_text, lines_of_moves, machine_options, machine_schema, post, post_to, program_of_path, read_gcode,
        read_to_post, shipped_machines, template_names, Machine,
    };
    #[pymodule_export]
    use crate::offset::{drop_cutter, offset_surface, push_cutter, sheet_raise, slope_matched_offset, waterlines};
    #[pymodule_export]
    use crate::part::{mended, Part};
    #[pymodule_export]
    use crate::program::Program;
    #[pymodule_export]
    use crate::simulation::Simulation;
    #[pymodule_export]
    use crate::tool::{profile_starters, Tool};
    #[pymodule_export]
    use crate::waiting::CancelToken;

    use super::{Bound, PyModule, PyModuleMethods, PyResult};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
