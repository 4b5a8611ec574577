//! The times of a `Schedule` as Python has them, and the call that gives the same schedule again.

use eeruf_core::{Micros, Phase};
use pyo3::{prelude::*, types::PyTuple};

use crate::schedule::Schedule;

impl Schedule {
    /// When each sensor fires in a phase, in microseconds.
    pub(crate) fn t_fire<'py>(&self, py: Python<'py>, phase: Phase) -> PyResult<Bound<'py, PyTuple>> {
        let fire = |sensor| self.0.t_fire(phase, sensor).unwrap_or_default().as_micros();
        PyTuple::new(py, (0..self.0.sensors()).map(fire))
    }

    /// Returns true if some sensor has a lag, so that waits say more than firing times.
    pub(crate) fn has_lags(&self) -> bool {
        self.0.t_lag().iter().any(|&lag| lag != Micros::ZERO)
    }

    /// The text of `repr`.
    pub(crate) fn shown(&self, py: Python<'_>) -> PyResult<String> {
        let period = self.period_us();
        Ok(if self.has_lags() {
            let (lag, a, b) = (self.t_lag_us(py)?, self.t_wait_a_us(py)?, self.t_wait_b_us(py)?);
            format!("Schedule(period_us={period}, t_lag_us={lag}, t_wait_a_us={a}, t_wait_b_us={b})")
        } else {
            let (a, b) = (self.t_fire_a_us(py)?, self.t_fire_b_us(py)?);
            format!("Schedule.from_firing(period_us={period}, t_fire_a_us={a}, t_fire_b_us={b})")
        })
    }
}
