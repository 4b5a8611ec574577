//! Result of a study.

use eeruf_sim::ShortestPeriod;
use eeruf_sim::{Method, Readings};

/// Error from which a reading counts as wrong.
pub(crate) const TOLERANCE_US: f64 = eeruf_sim::DEFAULT_TOLERANCE_US;

/// Results of all methods in one world.
pub(crate) struct Study {
    pub(crate) runs: Vec<Readings>,
    /// Methods that cannot be simulated here, with the reason.
    pub(crate) left_out: Vec<(Method, String)>,
    pub(crate) best: Option<ShortestPeriod>,
    pub(crate) periods: u32,
    pub(crate) seed: u64,
}

impl Study {
    pub(crate) fn of(&self, method: Method) -> Option<&Readings> {
        self.runs.iter().find(|readings| readings.method == method)
    }
}

/// Returns one robot's readings alone.
pub(crate) fn of_robot(readings: &Readings, robot: usize, sensors: usize) -> Readings {
    let own: Vec<usize> =
        (0..readings.len()).filter(|&reading| usize::from(readings.robot[reading]) == robot).collect();
    Readings { sensors, ..readings.select(&own) }
}
