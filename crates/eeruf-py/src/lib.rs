//! `eeruf._eeruf`: the compiled part of the Python package, one file for each concept. `eeruf-core` and `eeruf-sim` do
//! the work; this crate converts arguments and results: microseconds to `int`, many numbers to `NumPy` arrays, errors
//! to exceptions. The public interface is in `python/eeruf`.

#![allow(
    clippy::doc_markdown,
    clippy::doc_lazy_continuation,
    clippy::doc_overindented_list_items,
    reason = "the docs of what Python sees are docstrings, in their own markup"
)]

mod adaptation;
mod arguments;
mod batch;
mod batch_state;
mod body;
mod columns;
mod contents;
mod design;
mod drawing;
mod errors;
mod exclusive;
mod experiments;
mod faults;
mod fields;
mod file_object;
mod filter;
mod flow_settings;
mod found;
mod himm;
mod log_blocks;
mod logs;
mod maps;
mod memory;
mod methods;
mod module;
mod moments;
mod needs;
mod own;
mod paths;
mod pose;
mod program;
mod questions;
mod reading_blocks;
mod readings;
mod report;
mod requirements;
mod ring;
mod ring_arguments;
mod ring_events;
mod ring_methods;
mod robot;
mod scene;
mod schedule;
mod search;
mod sensor_watch;
mod simulate;
mod simulation;
mod surroundings;
mod unpickle;
mod vfh;
mod watch;

use pyo3::prelude::*;

#[pymodule]
mod _eeruf {
    #[pymodule_export]
    use crate::{
        adaptation::Adaptation,
        batch::Batch,
        batch_state::BatchState,
        design::{check_certificate, design},
        errors::{CertificateError, EerufError, EerufWarning},
        experiments::{alcove, course, difference, figures, recommend, room, set_one, set_three, set_two, speed_sweep},
        filter::EchoFilter,
        himm::Himm,
        log_blocks::{LogBlocks, judge},
        logs::{LogError, diagnose, read_firings, survey},
        methods::Method,
        needs::Needs,
        own::FiredReading,
        paths::Paths,
        program::{example, run_program},
        questions::{curve, fit},
        reading_blocks::{ReadingBlocks, simulate_blocks},
        readings::Readings,
        ring::Ring,
        ring_events::{Fire, PeriodEnded, Reading},
        robot::Robot,
        scene::Scene,
        schedule::Schedule,
        search::{WaitSearch, WaitTables},
        sensor_watch::SensorWatch,
        simulate::simulate,
        simulation::Simulation,
        surroundings::{Material, Noise},
        unpickle::readings_from_columns,
        vfh::Vfh,
        watch::{Switch, until_stopped},
    };
    use pyo3::prelude::*;
    use pyo3::types::PyTuple;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let kinds = eeruf_core::ReadingKind::ALL.map(eeruf_core::ReadingKind::as_str);
        module.add("KINDS", PyTuple::new(module.py(), kinds)?)?;
        let methods = eeruf_sim::Method::ALL;
        module.add("METHODS", PyTuple::new(module.py(), methods.map(eeruf_sim::Method::as_str))?)?;
        let eeruf = methods.into_iter().filter(|method| method.is_eeruf()).map(eeruf_sim::Method::as_str);
        module.add("EERUF_METHODS", PyTuple::new(module.py(), eeruf.collect::<Vec<_>>())?)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("CAUSES", PyTuple::new(module.py(), crate::readings::CAUSES)?)?;
        // Needed for the picture of a course.
        module.add("_ROOM_M", eeruf_sim::experiments::set_two::ROOM_M)?;
        module.add("_SIDE_M", eeruf_sim::LabMate::default().side_m)
    }
}
