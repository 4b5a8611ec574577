//! `sim.Method`: a method as a value with its own schedule, settings and code; and methods by name.

use std::sync::Arc;

use eeruf_sim::{Entry, Method as Named, Robot, ShortestPeriod, best_schedule_for};
use pyo3::{
    PyTraverseError, PyVisit,
    prelude::*,
    types::{PyDict, PyList, PyString},
};

use crate::{
    arguments::{instance, items, shown, text, wrong},
    errors::{EerufError, Raise},
    fields::{Reduced, call, reduce_by_name},
    flow_settings::FlowSettings,
    own::{Made, Makers},
    scene::Scene,
    schedule::Schedule,
    watch::Background,
};

/// Budget of nodes for the search for `eeruf_best`, as in the program; the proof usually takes far fewer.
const BEST_BUDGET: u64 = 300_000;

const EXPECTED: &str = "a name of eeruf.sim.METHODS, or an eeruf.sim.Method";

/// A method as a value: plan, judge and settings under a label. :func:`simulate`, :class:`Simulation` and all
/// experiments take one wherever they take a name. Immutable; methods compare, and pickle if their callables do.
///
/// Args:
///     name: one of ``METHODS``, for everything that the other arguments do not set.
///     label: the name in results and tables, unique within an experiment; by default ``name``.
///     schedule: the schedule to fire by, for methods that otherwise fire by the robot's own. It must have as many
///         sensors as the robot.
///     settings: for ``flow`` and ``flow_multi_echo``, a dict as for :meth:`eeruf.Ring.flow`, of settings that differ
///         from those derived from the robot; without ``seed`` and ``alone``, which the scene gives.
///     sketch: a dict as the argument ``firing`` of :class:`Robot`, for methods that fire like sketches and modules.
///     make_filter: makes your own filter: called with the :class:`Robot` at the start of each simulation, it returns a
///         callable as the argument ``filter`` of :class:`Simulation`. A class with callable instances works too.
///     make_firing: makes your own firing in the same way, a callable as the argument ``firing`` of
///         :class:`Simulation`.
///
/// Raises:
///     EerufError: no such method, or an argument that it does not take.
///
/// Example:
///     >>> from eeruf import sim
///     >>> believing = sim.Method("eeruf", label="all", make_filter=lambda robot: lambda firing: ("accepted",
///     ...     firing.t_echoes_us[0]) if firing.t_echoes_us else ("clear", None))
///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
///     >>> float(sim.simulate(scene, believing, 50).is_accepted.mean())
///     1.0
#[pyclass(frozen, module = "eeruf.sim")]
pub(crate) struct Method {
    entry: Entry,
    makers: Option<Arc<Makers>>,
    schedule: Option<Py<PyAny>>,
    settings: Option<Py<PyAny>>,
    sketch: Option<Py<PyAny>>,
}

fn by_name(argument: &str, name: &Bound<'_, PyAny>) -> PyResult<Entry> {
    let name = text(argument, name, EXPECTED)?;
    name.parse().map_err(|error: eeruf_sim::UnknownMethod| EerufError::new_err(error.to_string()))
}

#[pymethods]
impl Method {
    #[new]
    #[pyo3(signature = (name=None, *, label=None, schedule=None, settings=None, sketch=None, make_filter=None,
        make_firing=None))]
    #[pyo3(text_signature = "(name=\"eeruf\", *, label=None, schedule=None, settings=None, sketch=None, \
        make_filter=None, make_firing=None)")]
    fn new(
        name: Option<&Bound<'_, PyAny>>,
        label: Option<&Bound<'_, PyAny>>,
        schedule: Option<&Bound<'_, PyAny>>,
        settings: Option<&Bound<'_, PyAny>>,
        sketch: Option<&Bound<'_, PyAny>>,
        make_filter: Option<&Bound<'_, PyAny>>,
        make_firing: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let named = name.map_or_else(|| Ok(Entry::from(Named::Eeruf)), |name| by_name("name", name))?;
        let method = named.method();
        let mut entry = match label {
            None => named,
            Some(label) => named.with_name(&text("label", label, "a text")?),
        };
        let refused = |argument, value: &Bound<'_, PyAny>, takes: &str| {
            wrong(argument, shown(value), format_args!("none for the method {method}; {takes}"))
        };
        if let Some(given) = schedule {
            entry = match (method, given.cast::<Schedule>()) {
                (
                    Named::Eeruf
                    | Named::Adaptive
                    | Named::MultiEcho
                    | Named::AdaptiveMultiEcho
                    | Named::EerufBest
                    | Named::Table,
                    Ok(schedule),
                ) => entry.with_schedule(schedule.get().0),
                _ => {
                    let takes = "eeruf, adaptive, multi_echo and table take an eeruf.Schedule";
                    return Err(refused("schedule", given, takes));
                }
            };
        }
        if let Some(given) = settings {
            if !matches!(method, Named::Flow | Named::FlowMultiEcho) {
                return Err(refused("settings", given, "flow and flow_multi_echo take some"));
            }
            entry = entry.with_flow(FlowSettings::of(Some(given))?.options()?);
        }
        if let Some(given) = sketch {
            if !method.is_sketch() {
                return Err(refused("sketch", given, "methods that fire as sketches and modules do take one"));
            }
            entry = entry.with_sketch(crate::robot::sketch("sketch", given)?);
        }
        let makers = Makers::of(make_firing, make_filter)?;
        if let Some(makers) = &makers {
            entry = entry.with_own(Arc::clone(makers) as _);
        }
        let kept = |value: Option<&Bound<'_, PyAny>>| value.map(|value| value.clone().unbind());
        Ok(Self { entry, makers, schedule: kept(schedule), settings: kept(settings), sketch: kept(sketch) })
    }

    /// The method on which this one is based, one of ``METHODS``.
    #[getter]
    fn name(&self) -> &'static str {
        self.entry.method().as_str()
    }

    /// The name in results and tables.
    #[getter]
    fn label(&self) -> &str {
        self.entry.name()
    }

    /// The keyword arguments that recreate the object.
    fn _arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        all.set_item("name", self.name())?;
        all.set_item("label", self.label())?;
        let (filter, firing) = self.makers.as_ref().map_or((None, None), |makers| makers.callables(py));
        let parts = [
            ("schedule", self.schedule.as_ref().map(|value| value.clone_ref(py))),
            ("settings", self.settings.as_ref().map(|value| value.clone_ref(py))),
            ("sketch", self.sketch.as_ref().map(|value| value.clone_ref(py))),
            ("make_filter", filter),
            ("make_firing", firing),
        ];
        for (name, part) in parts {
            if let Some(part) = part {
                all.set_item(name, part)?;
            }
        }
        Ok(all)
    }

    fn __eq__(&self, py: Python<'_>, other: &Bound<'_, PyAny>) -> PyResult<bool> {
        let Ok(other) = other.cast::<Self>() else { return Ok(false) };
        self._arguments(py)?.eq(other.get()._arguments(py)?)
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        PyString::new(py, self.label()).hash()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        call("Method", &self._arguments(py)?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce_by_name(slf, slf.get()._arguments(slf.py())?)
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.makers.as_ref().map_or(Ok(()), |makers| makers.traverse(&visit))
    }
}

/// A method from an argument, with the makers of its own code, if any.
#[derive(Clone)]
pub(crate) struct Chosen {
    pub(crate) entry: Entry,
    pub(crate) makers: Option<Arc<Makers>>,
}

impl Chosen {
    pub(crate) fn of(argument: &str, value: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let Some(value) = value else { return Ok(Self { entry: Named::Eeruf.into(), makers: None }) };
        if let Ok(method) = value.cast::<Method>() {
            let Method { entry, makers, .. } = method.get();
            return Ok(Self { entry: entry.clone(), makers: makers.clone() });
        }
        Ok(Self { entry: by_name(argument, value)?, makers: None })
    }

    /// A scene whose robots have the method's changes.
    pub(crate) fn scene<'py>(
        argument: Option<&Bound<'py, PyAny>>,
        scene: &Bound<'py, Scene>,
    ) -> PyResult<Bound<'py, Scene>> {
        let method = argument.and_then(|value| value.cast::<Method>().ok()).map(Bound::get);
        let Some(Method { schedule, sketch, .. }) = method else { return Ok(scene.clone()) };
        if schedule.is_none() && sketch.is_none() {
            return Ok(scene.clone());
        }
        let (py, robots) = (scene.py(), PyList::empty(scene.py()));
        for robot in scene.getattr("robots")?.try_iter()? {
            let (robot, changes) = (robot?, PyDict::new(py));
            if let Some(schedule) = schedule {
                changes.set_item("schedule", schedule)?;
                changes.set_item("period_us", robot.getattr("period_us")?)?;
            }
            if let Some(sketch) = sketch {
                changes.set_item("firing", sketch)?;
            }
            robots.append(robot.call_method("replace", (), Some(&changes))?)?;
        }
        let changes = PyDict::new(py);
        changes.set_item("robots", robots)?;
        let scene = scene.call_method("replace", (), Some(&changes))?;
        instance::<Scene>("scene", &scene, "an eeruf.sim.Scene").cloned()
    }
}

/// The methods in an argument, or the default.
pub(crate) fn methods(values: Option<&Bound<'_, PyAny>>, default: Vec<Entry>) -> PyResult<(Vec<Entry>, Made)> {
    let Some(values) = values else { return Ok((default, Made::default())) };
    let values = items("methods", values, "a sequence of names of eeruf.sim.METHODS and eeruf.sim.Method")?;
    let chosen = values.iter().map(|value| Chosen::of("methods", Some(value))).collect::<PyResult<Vec<_>>>()?;
    let makers = chosen.iter().filter_map(|chosen| chosen.makers.clone()).collect();
    Ok((chosen.into_iter().map(|chosen| chosen.entry).collect(), Made(makers)))
}

/// The method with a name.
pub(crate) fn method(argument: &str, name: &Bound<'_, PyAny>) -> PyResult<Named> {
    by_name(argument, name).map(|entry| entry.method())
}

/// The schedule of `eeruf_best`, if it is among these methods.
pub(crate) fn best(methods: &[Entry], robot: &Robot, background: &Background) -> PyResult<Option<ShortestPeriod>> {
    let asked = methods.iter().any(|entry| entry.method() == Named::EerufBest);
    asked
        .then(|| {
            best_schedule_for(robot, BEST_BUDGET, |_| background.go_on(None, || "designing".to_owned()))
                .map_err(Raise::raise)
        })
        .transpose()
}
