//! Result of a study.

use eeruf_sim::ShortestPeriod;
use eeruf_sim::{Method, Readings};

/// Error from which a reading counts as wrong.
pub(crate) const TOLERANCE_US: f64 = eeruf_sim::DEFAULT_TOLERANCE_US;

/// All methods on one world.
pub(crate) struct Study {
    pub(crate) runs: Vec<Readings>,
    /// Methods that cannot be simulated here, and why.
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

/// One robot's readings alone.
pub(crate) fn of_robot(readings: &Readings, robot: usize, sensors: usize) -> Readings {
    let own: Vec<usize> =
        (0..readings.len()).filter(|&reading| usize::from(readings.robot[reading]) == robot).collect();
    fn pick<T: Copy>(own: &[usize], of: &[T]) -> Vec<T> {
        own.iter().map(|&reading| of[reading]).collect()
    }
    let mut alone = readings.clone();
    alone.sensors = sensors;
    alone.robot = pick(&own, &readings.robot);
    alone.sensor = pick(&own, &readings.sensor);
    alone.period = pick(&own, &readings.period);
    alone.phase = pick(&own, &readings.phase);
    alone.fired_s = pick(&own, &readings.fired_s);
    alone.x_m = pick(&own, &readings.x_m);
    alone.y_m = pick(&own, &readings.y_m);
    alone.heading_rad = pick(&own, &readings.heading_rad);
    alone.kind = pick(&own, &readings.kind);
    alone.t_echo_us = pick(&own, &readings.t_echo_us);
    alone.earliest_us = pick(&own, &readings.earliest_us);
    alone.reference_us = pick(&own, &readings.reference_us);
    alone.cause = pick(&own, &readings.cause);
    alone.path = pick(&own, &readings.path);
    alone.emitted_s = pick(&own, &readings.emitted_s);
    alone.expected_change_us = pick(&own, &readings.expected_change_us);
    alone
}
