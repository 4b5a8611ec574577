//! `sim.RobotState`: where a robot of a simulation is, and how it goes.

use eeruf_sim::Point;
use pyo3::{prelude::*, types::PyDict};

use crate::{
    arguments::{flag, number_or},
    fields::{Reduced, reduce, repr, to_dict},
    pose::{point_of, pose_of},
};

/// A robot of a ``Simulation``, now.
///
/// Example:
///     >>> from eeruf import sim
///     >>> robot = sim.Robot((1, 0, 0), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot])).robots[0].pose
///     (1.0, 0.0, 0.0)
#[pyclass(frozen, eq, get_all, module = "eeruf.sim")]
#[derive(Clone, PartialEq)]
pub(crate) struct RobotState {
    /// (x, y, heading) in metres and radians.
    pub(crate) pose: (f64, f64, f64),
    /// Velocity along x and y, in m/s.
    pub(crate) velocity_m_s: (f64, f64),
    /// Rate of turn, counter-clockwise, in rad/s.
    pub(crate) turn_rad_s: f64,
    /// True if the disc that holds its sensors touches a wall or a pole.
    pub(crate) touches: bool,
}

const FIELDS: [&str; 4] = ["pose", "velocity_m_s", "turn_rad_s", "touches"];

#[pymethods]
impl RobotState {
    #[new]
    #[pyo3(signature = (pose, velocity_m_s=None, turn_rad_s=None, touches=None))]
    #[pyo3(text_signature = "(pose, velocity_m_s=(0.0, 0.0), turn_rad_s=0.0, touches=False)")]
    fn new(
        pose: &Bound<'_, PyAny>,
        velocity_m_s: Option<&Bound<'_, PyAny>>,
        turn_rad_s: Option<&Bound<'_, PyAny>>,
        touches: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let velocity = velocity_m_s.map(|velocity| point_of("velocity_m_s", velocity)).transpose()?;
        Ok(Self {
            pose: pose_of("pose", pose)?,
            velocity_m_s: velocity.map_or((0.0, 0.0), |velocity: Point| (velocity.x, velocity.y)),
            turn_rad_s: number_or("turn_rad_s", turn_rad_s, 0.0, f64::MIN..=f64::MAX)?,
            touches: flag("touches", touches, false)?,
        })
    }

    /// Its fields by their names: a dict of plain values.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((1, 0, 0), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot])).robots[0].to_dict()["pose"]
    ///     [1.0, 0.0, 0.0]
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &FIELDS)
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        repr(slf, &FIELDS)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce(slf, &FIELDS)
    }
}
