//! `sim.Robot`: a robot with its ring, for scenes built in code.

use eeruf_core::Micros;
use eeruf_sim::{Pose, Transducer, Vector};
use pyo3::{prelude::*, types::PyTuple};

use crate::{
    arguments::{self, choice, instance, micros, number, shown, whole_or, wrong},
    requirements,
    schedule::Schedule,
};

/// A robot that stands, with a ring of sensors on an arc whose middle is ahead.
///
/// Args:
///     pose: (x, y, heading) in metres and radians, counter-clockwise from the x axis.
///     sensors: how many, 1 to 64.
///     spacing_rad: the angle from one sensor to the next, in radians.
///     radius_m: the radius of the arc, in metres.
///     transducer: ``"polaroid_6500"`` or ``"hc_sr04"``.
///     period_us: ``T_p`` of the methods that bring no schedule of their own; the schedule's if there is one.
///     t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical.
///     window_us: ``T_wind``: how long a sensor listens.
///     schedule: what the EERUF methods fire by; None for the paper's table, scaled to the period.
///     consecutive: how many readings in a row must agree, 2 to 8.
///     patience: for how many firings ``multi_echo`` waits for an accepted echo that is missing, 0 to 15.
///
/// Raises:
///     ArgumentError: something of the wrong type or out of range.
///
/// Example:
///     >>> from eeruf import sim
///     >>> sim.Robot((0.0, 0.0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3).period_us
///     60000
#[pyclass(frozen, eq, module = "eeruf.sim")]
#[derive(Clone, PartialEq)]
pub(crate) struct Robot {
    pub(crate) robot: eeruf_sim::Robot,
    /// (x, y, heading) in metres and radians.
    #[pyo3(get)]
    pose: (f64, f64, f64),
    /// The angle from one sensor to the next, in radians.
    #[pyo3(get)]
    spacing_rad: f64,
    /// The radius of the arc, in metres.
    #[pyo3(get)]
    radius_m: f64,
    /// The name of the transducer.
    #[pyo3(get)]
    transducer: &'static str,
}

const TRANSDUCERS: [(&str, Transducer); 2] =
    [("polaroid_6500", Transducer::POLAROID_6500), ("hc_sr04", Transducer::HC_SR04)];

#[pymethods]
impl Robot {
    #[new]
    #[pyo3(signature = (
        pose, sensors, spacing_rad, radius_m, transducer=None, *, period_us=None, t_delta_us=None, window_us=None,
        schedule=None, consecutive=None, patience=None
    ))]
    #[pyo3(
        text_signature = "(pose, sensors, spacing_rad, radius_m, transducer=\"polaroid_6500\", *, period_us=60000, \
            t_delta_us=500, window_us=36000, schedule=None, consecutive=2, patience=0)"
    )]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn new(
        pose: &Bound<'_, PyAny>,
        sensors: &Bound<'_, PyAny>,
        spacing_rad: &Bound<'_, PyAny>,
        radius_m: &Bound<'_, PyAny>,
        transducer: Option<&Bound<'_, PyAny>>,
        period_us: Option<&Bound<'_, PyAny>>,
        t_delta_us: Option<&Bound<'_, PyAny>>,
        window_us: Option<&Bound<'_, PyAny>>,
        schedule: Option<&Bound<'_, PyAny>>,
        consecutive: Option<&Bound<'_, PyAny>>,
        patience: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let expected = "(x, y, heading) in metres and radians";
        let coordinates = arguments::items("pose", pose, expected)?;
        let [x, y, heading] = &coordinates[..] else { return Err(wrong("pose", shown(pose), expected)) };
        let coordinate = |name: &str, value| number(name, value, -1e6..=1e6);
        let pose = (coordinate("pose[0]", x)?, coordinate("pose[1]", y)?, coordinate("pose[2]", heading)?);
        let spacing_rad = number("spacing_rad", spacing_rad, -10.0..=10.0)?;
        let radius_m = number("radius_m", radius_m, 0.0..=1e3)?;
        let at = Pose::new(Vector::new(pose.0, pose.1), pose.2);
        let (name, transducer) =
            choice("transducer", transducer, &TRANSDUCERS.map(|(name, kind)| (name, (name, kind))))?;
        let mut robot = eeruf_sim::Robot::ring(at, requirements::sensors(sensors)?, spacing_rad, radius_m, transducer);
        let set = |name, value: Option<&Bound<'_, PyAny>>, field: &mut Micros| {
            value.map_or(Ok(()), |value| micros(name, value).map(|us| *field = us))
        };
        set("period_us", period_us, &mut robot.period)?;
        set("t_delta_us", t_delta_us, &mut robot.t_delta)?;
        set("window_us", window_us, &mut robot.window)?;
        robot.consecutive = whole_or("consecutive", consecutive, 2, 2..=8)?;
        robot.patience = whole_or("patience", patience, 0, 0..=15)?;
        let given = schedule.map(|schedule| instance::<Schedule>("schedule", schedule, "an eeruf.Schedule"));
        robot.schedule = given.transpose()?.map(|schedule| schedule.get().0);
        if let (Some(schedule), None) = (robot.schedule, period_us) {
            robot.period = schedule.period();
        }
        Ok(Self { robot, pose, spacing_rad, radius_m, transducer: name })
    }

    /// How many sensors.
    #[getter]
    fn sensors(&self) -> usize {
        self.robot.sensors.len()
    }

    /// ``T_p`` of the methods that bring no schedule of their own, in microseconds.
    #[getter]
    fn period_us(&self) -> u32 {
        self.robot.period.as_micros()
    }

    /// ``T_delta``, in microseconds.
    #[getter]
    fn t_delta_us(&self) -> u32 {
        self.robot.t_delta.as_micros()
    }

    /// How long a sensor listens, in microseconds.
    #[getter]
    fn window_us(&self) -> u32 {
        self.robot.window.as_micros()
    }

    /// What the EERUF methods fire by; None for the paper's table.
    #[getter]
    fn schedule(&self) -> Option<Schedule> {
        self.robot.schedule.map(Schedule)
    }

    /// How many readings in a row must agree.
    #[getter]
    fn consecutive(&self) -> u8 {
        self.robot.consecutive
    }

    /// For how many firings ``multi_echo`` waits for an accepted echo that is missing.
    #[getter]
    fn patience(&self) -> u8 {
        self.robot.patience
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let schedule = self.schedule().into_pyobject(py)?.repr()?.to_string();
        let Self { pose, spacing_rad, radius_m, transducer, .. } = self;
        Ok(format!(
            "Robot(pose={pose:?}, sensors={}, spacing_rad={spacing_rad:?}, radius_m={radius_m:?}, \
             transducer='{transducer}', \
             period_us={}, t_delta_us={}, window_us={}, schedule={schedule}, consecutive={}, patience={})",
            self.sensors(),
            self.period_us(),
            self.t_delta_us(),
            self.window_us(),
            self.consecutive(),
            self.patience(),
        ))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, this) = (slf.py(), slf.get());
        let fields = (
            this.pose,
            this.sensors(),
            this.spacing_rad,
            this.radius_m,
            this.transducer,
            this.period_us(),
            this.t_delta_us(),
            this.window_us(),
            this.schedule(),
            this.consecutive(),
            this.patience(),
        );
        let rebuild = py.import("eeruf._rebuild")?.getattr("robot")?;
        Ok((rebuild, fields.into_pyobject(py)?))
    }
}
