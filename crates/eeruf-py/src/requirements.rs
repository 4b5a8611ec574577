//! What a schedule must meet, out of keyword arguments: layout, neighbours, times.

use eeruf_core::{Criterion, Layout, LayoutError, MAX_SENSORS, Micros, Requirements, neighbour_rows};
use eeruf_sim::AnySchedule;
use pyo3::{prelude::*, types::PyList};

use crate::arguments::{choice, flag, micros, shown, whole, whole_or, wrong};

/// How the sensors stand, with the rows of the graph if it is one.
pub(crate) enum OwnedLayout {
    Named(Layout<'static>),
    Graph(Box<[u64; MAX_SENSORS]>),
}

impl OwnedLayout {
    pub(crate) fn new(layout: Option<&Bound<'_, PyAny>>, neighbours: u8, sensors: usize) -> PyResult<Self> {
        let Some(layout) = layout else { return Ok(Self::Named(Layout::Line(neighbours))) };
        let expected = "\"line\", \"ring\", \"blocks\", or pairs of neighbours such as [(0, 1), (1, 2)]";
        if let Ok(name) = layout.extract::<String>() {
            return match name.as_str() {
                "line" => Ok(Self::Named(Layout::Line(neighbours))),
                "ring" => Ok(Self::Named(Layout::Ring(neighbours))),
                "blocks" => Ok(Self::Named(Layout::Blocks(neighbours))),
                _ => Err(wrong("layout", shown(layout), expected)),
            };
        }
        let pairs: Vec<(usize, usize)> = layout
            .try_iter()
            .and_then(|items| PyList::new(layout.py(), items.collect::<PyResult<Vec<_>>>()?)?.extract())
            .map_err(|_| wrong("layout", shown(layout), expected))?;
        let rows = neighbour_rows(pairs, sensors).map_err(|LayoutError { pair: (x, y), .. }| {
            let expected = format!("pairs of two different sensors from 0 to {}", sensors - 1);
            wrong("layout", format_args!("[({x}, {y})]"), expected)
        })?;
        Ok(Self::Graph(Box::new(rows)))
    }

    pub(crate) fn layout(&self) -> Layout<'_> {
        match self {
            Self::Named(layout) => *layout,
            Self::Graph(rows) => Layout::Graph(&rows[..]),
        }
    }
}

/// How to read (13a), (13b); exactly by default.
fn criterion(value: Option<&Bound<'_, PyAny>>) -> PyResult<Criterion> {
    choice("criterion", value, &[("exact", Criterion::Exact), ("paper", Criterion::Paper)])
}

/// What a schedule must meet.
pub(crate) struct OwnedRequirements {
    t_delta: Micros,
    min_interval: Micros,
    layout: OwnedLayout,
    criterion: Criterion,
    window: Micros,
    stale_echo: bool,
}

impl OwnedRequirements {
    pub(crate) fn requirements(&self) -> Requirements<'_> {
        Requirements {
            t_delta: self.t_delta,
            criterion: self.criterion,
            min_interval: self.min_interval,
            layout: self.layout.layout(),
            window: self.window,
            stale_echo: self.stale_echo,
            uneven: None,
        }
    }
}

/// How many sensors in a row count as neighbours; four by default, as in the paper (Sec. 3.1 c).
pub(crate) fn neighbours(value: Option<&Bound<'_, PyAny>>) -> PyResult<u8> {
    whole_or("neighbours", value, 4, 1..=MAX_SENSORS as u8)
}

/// The number of sensors.
pub(crate) fn sensors(value: &Bound<'_, PyAny>) -> PyResult<usize> {
    whole("sensors", value, 1..=MAX_SENSORS as u32).map(|sensors| sensors as usize)
}

/// The keyword arguments of `verify`, `to_rust` and `to_c`, as Python gives them.
pub(crate) struct RequirementArguments<'a, 'py> {
    pub(crate) t_delta_us: Option<&'a Bound<'py, PyAny>>,
    pub(crate) min_interval_us: Option<&'a Bound<'py, PyAny>>,
    pub(crate) neighbours: Option<&'a Bound<'py, PyAny>>,
    pub(crate) layout: Option<&'a Bound<'py, PyAny>>,
    pub(crate) criterion: Option<&'a Bound<'py, PyAny>>,
    pub(crate) window_us: Option<&'a Bound<'py, PyAny>>,
    pub(crate) stale_echo: Option<&'a Bound<'py, PyAny>>,
}

impl RequirementArguments<'_, '_> {
    /// Checked; without `t_delta_us` it is the most that `schedule` allows.
    pub(crate) fn owned(&self, schedule: &AnySchedule) -> PyResult<OwnedRequirements> {
        let or_zero =
            |name, value: Option<&Bound<'_, PyAny>>| value.map_or(Ok(Micros::ZERO), |value| micros(name, value));
        let mut requirements = OwnedRequirements {
            t_delta: or_zero("t_delta_us", self.t_delta_us)?,
            min_interval: or_zero("min_interval_us", self.min_interval_us)?,
            layout: OwnedLayout::new(self.layout, neighbours(self.neighbours)?, schedule.sensors())?,
            criterion: criterion(self.criterion)?,
            window: or_zero("window_us", self.window_us)?,
            stale_echo: flag("stale_echo", self.stale_echo, false)?,
        };
        if self.t_delta_us.is_none() {
            requirements.t_delta = schedule.verify(&requirements.requirements()).max_t_delta().unwrap_or(Micros::ZERO);
        }
        Ok(requirements)
    }
}
