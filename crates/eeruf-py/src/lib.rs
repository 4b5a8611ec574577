//! `eeruf._eeruf`: the compiled part of the Python package. One file for each concept; what they do is in `eeruf-core` and
//! `eeruf-sim`, here it only changes its clothes: microseconds as `int`, many numbers as `NumPy` arrays, errors as exceptions.
//! What users read is in `python/eeruf`.

#![allow(
    clippy::doc_markdown,
    clippy::doc_lazy_continuation,
    clippy::doc_overindented_list_items,
    reason = "the docs of what Python sees are docstrings, in their own markup"
)]

mod arguments;
mod errors;
mod experiments;
mod filter;
mod paths;
mod readings;
mod report;
mod ring;
mod robot;
mod scene;
mod schedule;
mod search;
mod watch;

use pyo3::prelude::*;

#[pymodule]
mod _eeruf {
    #[pymodule_export]
    use crate::{
        errors::{
            ArgumentError, EerufError, ExperimentError, FilterError, PathsError, RingError, SceneError, ScheduleError,
            SearchError, SimulationError,
        },
        experiments::{set_one, set_two, speed_sweep},
        filter::EchoFilter,
        paths::Paths,
        readings::Readings,
        readings::{readings_from_columns, simulate},
        report::{Report, Violation},
        ring::{Fire, PeriodEnded, Reading, Ring},
        robot::Robot,
        scene::{Scene, scene_from_text},
        schedule::Schedule,
        search::{Found, WaitSearch, WaitTables, design},
    };
    use pyo3::prelude::*;
    use pyo3::types::PyTuple;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let kinds = eeruf_core::ReadingKind::ALL.map(eeruf_core::ReadingKind::as_str);
        module.add("KINDS", PyTuple::new(module.py(), kinds)?)?;
        let methods = eeruf_sim::Method::ALL.map(eeruf_sim::Method::as_str);
        module.add("METHODS", PyTuple::new(module.py(), methods)?)?;
        module.add("CAUSES", PyTuple::new(module.py(), crate::readings::CAUSES)?)?;
        // What the picture of a course shows.
        module.add("_ROOM_M", eeruf_sim::experiments::set_two::ROOM_M)?;
        module.add("_SIDE_M", eeruf_sim::LabMate::default().side_m)
    }
}
