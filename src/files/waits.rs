//! Ring files for `search`: the paper's problem, lags given and waits on a grid.

use std::path::Path;

use clap::ValueEnum;
use eeruf_core::search::WaitProblem;
use eeruf_core::{Criterion, Micros};
use eeruf_design::{LayoutKey, OwnedLayout, four, neighbours_in_range, sensors_in_range};
use eeruf_files::Kind;
use serde::Deserialize;

use super::error::InputError;
use super::toml::read_toml;

/// A ring file for `search`: the paper's problem.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WaitFile {
    sensors: usize,
    period_us: u32,
    wait_max_us: u32,
    tick_us: u32,
    t_lag_us: Option<Vec<u32>>,
    t_delta_us: u32,
    #[serde(default)]
    min_interval_us: u32,
    #[serde(default = "four")]
    neighbours: u8,
    #[serde(default)]
    layout: LayoutKey,
    #[serde(default)]
    criterion: CriterionKey,
}

/// Reading of (13a), (13b), as files and options name it.
#[derive(Clone, Copy, Debug, Default, Deserialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub(crate) enum CriterionKey {
    /// The form that suffices to reject all crosstalk
    Exact,
    /// As printed, with an outer absolute value
    #[default]
    Paper,
}

impl From<CriterionKey> for Criterion {
    fn from(key: CriterionKey) -> Self {
        match key {
            CriterionKey::Paper => Self::Paper,
            CriterionKey::Exact => Self::Exact,
        }
    }
}

/// Contents of a file for `eeruf lab search`.
pub(crate) struct WaitSpec {
    file: WaitFile,
    layout: OwnedLayout,
    t_lag: Option<Vec<Micros>>,
}

/// Reads a ring file for `search`.
pub(crate) fn read_waits(file: &Path) -> Result<WaitSpec, InputError> {
    read_toml(file, Kind::Waits, |waits: WaitFile| {
        sensors_in_range(waits.sensors)?;
        neighbours_in_range(waits.neighbours)?;
        let layout = waits.layout.owned(waits.neighbours, waits.sensors)?;
        let t_lag = waits.t_lag_us.as_ref().map(|lags| lags.iter().copied().map(Micros::new).collect());
        Ok(WaitSpec { file: waits, layout, t_lag })
    })
}

impl WaitSpec {
    pub(crate) fn problem(&self) -> WaitProblem<'_> {
        let WaitFile { sensors, period_us, wait_max_us, tick_us, t_delta_us, min_interval_us, neighbours, .. } =
            self.file;
        WaitProblem {
            sensors,
            period: Micros::new(period_us),
            wait_max: Micros::new(wait_max_us),
            tick: Micros::new(tick_us),
            t_lag: self.t_lag.as_deref(),
            t_delta: Micros::new(t_delta_us),
            min_interval: Micros::new(min_interval_us),
            neighbours,
            layout: self.layout.layout(),
            criterion: self.file.criterion.into(),
        }
    }
}
