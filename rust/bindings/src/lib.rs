//! PyO3 module `styluscam._engine`: conversions only, no algorithm.
//!
//! Documents cross as JSON text, arrays as numpy; the Python package gives both their types.

mod arrays;
mod channel;
mod cutting;
mod earlier;
mod elementary;
mod errors;
mod flank;
mod freecad;
mod freeform;
mod job;
mod json;
mod machine;
mod offset;
mod part;
mod plan;
mod plane;
mod posting;
mod program;
mod reading;
mod scene;
mod shapes;
mod shaping;
mod sheet;
mod simulation;
mod starter;
mod tool;
mod verification;
mod waiting;
mod walls;

use pyo3::prelude::*;

#[pymodule]
mod _engine {
    #[pymodule_export]
    use crate::channel::require_channel;
    #[pymodule_export]
    use crate::cutting::{cutting_data, cutting_table, shipped_cutting_tables};
    #[pymodule_export]
    use crate::earlier::Earlier;
    #[pymodule_export]
    use crate::elementary::Elementary;
    #[pymodule_export]
    use crate::flank::{clearance_of_tilted, flank_pass, Strip};
    #[pymodule_export]
    use crate::freecad::{path_text, program_of_path};
    #[pymodule_export]
    use crate::freeform::{Nurbs, Search};
    #[pymodule_export]
    use crate::job::{job_schema, materials, Job};
    #[pymodule_export]
    use crate::machine::{machine_options, machine_schema, shipped_machines, template_names, Machine};
    #[pymodule_export]
    use crate::offset::{drop_cutter, offset_surface, push_cutter, sheet_raise, slope_matched_offset, waterlines};
    #[pymodule_export]
    use crate::part::{mended, Part};
    #[pymodule_export]
    use crate::plan::{plan, Plan};
    #[pymodule_export]
    use crate::plane::{contour_strip, engagement, pocket_path};
    #[pymodule_export]
    use crate::posting::{cl_text, lines_of_moves, post, post_to};
    #[pymodule_export]
    use crate::program::Program;
    #[pymodule_export]
    use crate::reading::{read_back, read_gcode, read_to_post, trace_gcode};
    #[pymodule_export]
    use crate::scene::Scene;
    #[pymodule_export]
    use crate::shaping::shaped;
    #[pymodule_export]
    use crate::simulation::Simulation;
    #[pymodule_export]
    use crate::starter::starter;
    #[pymodule_export]
    use crate::tool::{profile_starters, Tool};
    #[pymodule_export]
    use crate::verification::{finding_kinds, judge, Judgement};
    #[pymodule_export]
    use crate::waiting::CancelToken;

    use super::{Bound, PyModule, PyModuleMethods, PyResult};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
