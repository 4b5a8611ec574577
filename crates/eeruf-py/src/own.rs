//! The caller's own firing and filter of a `sim.Simulation`: Python callables behind the simulator's traits.

use std::{
    collections::VecDeque,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use eeruf_core::{MAX_SENSORS, Micros, Phase, ReadingKind};
use eeruf_sim::{Echo, Filter, Filtered, FiringMethod, FiringPeriod, MakeOwn, Own, OwnError};
use pyo3::{
    PyTraverseError, PyVisit,
    prelude::*,
    types::{PyDict, PyTuple},
};

use crate::{
    arguments::{items, micros, number, shown, whole, wrong},
    errors::Raise,
    fields::{Reduced, reduce, repr, to_dict},
    ring_events::Reading,
    robot::Robot,
};

/// The echoes of one firing of one sensor, for a custom filter in a :class:`Simulation`.
///
/// Example:
///     >>> from eeruf import sim
///     >>> heard = []
///     >>> def believe(firing):
///     ...     heard.append(firing)
///     ...     return firing.reading
///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> _ = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]), filter=believe).step(0.1)
///     >>> heard[0].reading.sensor, len(heard[0].t_echoes_us), round(heard[0].fired_s, 3)
///     (4, 1, 0.014)
#[pyclass(frozen, eq, module = "eeruf.typing")]
#[derive(Clone, PartialEq)]
pub(crate) struct FiredReading {
    /// The ring's own verdict, with the paper's filter, and its sensor, phase and period.
    #[pyo3(get)]
    reading: Reading,
    t_echoes_us: Vec<u32>,
    levels_db: Vec<f32>,
    /// Time of the firing, in seconds.
    #[pyo3(get)]
    fired_s: f64,
    /// The change of a good reading since the sensor's previous firing that odometry predicts, in microseconds.
    #[pyo3(get)]
    expected_change_us: i32,
}

const FIRED: [&str; 5] = ["reading", "t_echoes_us", "fired_s", "expected_change_us", "levels_db"];

#[pymethods]
impl FiredReading {
    #[new]
    #[pyo3(signature = (reading, t_echoes_us, fired_s=None, expected_change_us=None, levels_db=None))]
    #[pyo3(text_signature = "(reading, t_echoes_us, fired_s=0.0, expected_change_us=0, levels_db=())")]
    fn new(
        reading: &Bound<'_, PyAny>,
        t_echoes_us: &Bound<'_, PyAny>,
        fired_s: Option<&Bound<'_, PyAny>>,
        expected_change_us: Option<&Bound<'_, PyAny>>,
        levels_db: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let reading = crate::arguments::instance::<Reading>("reading", reading, "an eeruf.Reading")?.get().clone();
        let echoes = crate::arguments::times_of("t_echoes_us", t_echoes_us, "echo")?;
        let each = |(place, level): (usize, Bound<'_, PyAny>)| {
            number(&format!("levels_db[{place}]"), &level, -1e3..=1e3).map(|level| level as f32)
        };
        let expected = "a sequence of levels, one for each echo, or none";
        let levels = levels_db.map_or(Ok(vec![]), |levels| items("levels_db", levels, expected))?;
        if !levels.is_empty() && levels.len() != echoes.len() {
            return Err(wrong("levels_db", format!("{} levels of {} echoes", levels.len(), echoes.len()), expected));
        }
        Ok(Self {
            levels_db: levels.into_iter().enumerate().map(each).collect::<PyResult<_>>()?,
            reading,
            t_echoes_us: echoes.into_iter().map(Micros::as_micros).collect(),
            fired_s: crate::arguments::number_or("fired_s", fired_s, 0.0, f64::MIN..=f64::MAX)?,
            expected_change_us: crate::arguments::whole_or(
                "expected_change_us",
                expected_change_us,
                0,
                i32::MIN..=i32::MAX,
            )?,
        })
    }

    /// The times of its echoes after firing, in microseconds, earliest first: a tuple of at most one, or of up to eight
    /// with methods for several echoes, such as ``"multi_echo"``.
    #[getter]
    fn t_echoes_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.t_echoes_us)
    }

    /// The levels of its echoes over the receiver's threshold at full gain, in dB, as reported by modules that measure
    /// amplitudes: a tuple as long as ``t_echoes_us``, or empty where they are unknown.
    #[getter]
    fn levels_db<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.levels_db)
    }

    /// The fields by their names: a dict of plain values.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> reading = eeruf.EchoFilter(1, 500).push(0, 9_000)
    ///     >>> eeruf.typing.FiredReading(reading, (9_000,)).to_dict()["t_echoes_us"]
    ///     [9000]
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &FIRED)
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        repr(slf, &FIRED)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce(slf, &FIRED)
    }
}

/// The exception that a callable raised, kept for the caller of the simulation.
type Raised = Arc<Mutex<Option<PyErr>>>;

/// The callables of a simulation, visible to the garbage collector, and the exception that one of them raised.
#[derive(Default)]
pub(crate) struct Calls {
    callables: Vec<Mutex<Option<Py<PyAny>>>>,
    /// Callables passed to the simulation: each is a firing (true) or a filter, with its robot and its index.
    given: Vec<(bool, usize, usize)>,
    raised: Raised,
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps an exception for the caller, and reports it to the simulator.
fn keep(raised: &Raised, error: PyErr) -> OwnError {
    let said = OwnError::new(error.to_string());
    *locked(raised) = Some(error);
    said
}

impl Calls {
    /// Calls one of the callables, and keeps its exception.
    fn call<T>(&self, index: usize, ask: impl FnOnce(&Bound<'_, PyAny>) -> PyResult<T>) -> Result<T, OwnError> {
        Python::attach(|py| {
            let callable = locked(&self.callables[index]).as_ref().map(|callable| callable.clone_ref(py));
            let Some(callable) = callable else { return Err(OwnError::from("the callable is gone")) };
            ask(callable.bind(py)).map_err(|error| keep(&self.raised, error))
        })
    }

    /// Takes the exception that a callable raised, if any.
    pub(crate) fn raised(&self) -> Option<PyErr> {
        locked(&self.raised).take()
    }

    /// Returns true if some callables were arguments of the simulation.
    pub(crate) fn is_given(&self) -> bool {
        !self.given.is_empty()
    }

    pub(crate) fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        // A locked callable is being copied, so it is in use.
        for callable in self.callables.iter().filter_map(|callable| callable.try_lock().ok()) {
            visit.call(&*callable)?;
        }
        Ok(())
    }

    pub(crate) fn clear(&self) {
        for callable in &self.callables {
            let gone = locked(callable).take();
            drop(gone);
        }
    }
}

/// Makes a method's own firings and filters for each simulation.
#[derive(Debug)]
pub(crate) struct Makers {
    firing: Option<Py<PyAny>>,
    filter: Option<Py<PyAny>>,
    raised: Raised,
}

type ByRobot<'py> = Vec<(usize, Bound<'py, PyAny>)>;

impl Makers {
    /// The arguments `make_firing` and `make_filter` of a method; `None` if it has neither.
    pub(crate) fn of(
        firing: Option<&Bound<'_, PyAny>>,
        filter: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Option<Arc<Self>>> {
        for (name, maker) in [("make_firing", firing), ("make_filter", filter)] {
            if let Some(maker) = maker.filter(|maker| !maker.is_callable()) {
                return Err(wrong(name, shown(maker), "a callable that takes a robot and returns a callable"));
            }
        }
        if firing.is_none() && filter.is_none() {
            return Ok(None);
        }
        let kept = |maker: Option<&Bound<'_, PyAny>>| maker.map(|maker| maker.clone().unbind());
        Ok(Some(Arc::new(Self { firing: kept(firing), filter: kept(filter), raised: Raised::default() })))
    }

    /// Returns the callables of filters and of firings.
    pub(crate) fn callables(&self, py: Python<'_>) -> (Option<Py<PyAny>>, Option<Py<PyAny>>) {
        let copy = |maker: &Option<Py<PyAny>>| maker.as_ref().map(|maker| maker.clone_ref(py));
        (copy(&self.filter), copy(&self.firing))
    }

    pub(crate) fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.firing)?;
        visit.call(&self.filter)
    }

    /// Makes a callable for each robot that has none in `given`.
    fn fill<'py>(
        name: &str,
        maker: Option<&Py<PyAny>>,
        py: Python<'py>,
        robots: &[eeruf_sim::Robot],
        given: &mut ByRobot<'py>,
    ) -> PyResult<()> {
        let Some(maker) = maker else { return Ok(()) };
        for (index, robot) in robots.iter().enumerate() {
            if given.iter().all(|(known, _)| *known != index) {
                let made = maker.bind(py).call1((Robot::of(robot),))?;
                if !made.is_callable() {
                    return Err(wrong(&format!("what {name} returned"), shown(&made), "a callable"));
                }
                given.push((index, made));
            }
        }
        Ok(())
    }
}

impl MakeOwn for Makers {
    fn make(&self, robots: &[eeruf_sim::Robot]) -> Result<Own, OwnError> {
        Python::attach(|py| {
            let (own, _) = made(py, Some(self), ByRobot::new(), ByRobot::new(), robots)?;
            Ok(own)
        })
        .map_err(|error| keep(&self.raised, error))
    }
}

/// The makers of an experiment's methods, with the exceptions of their code.
#[derive(Default)]
pub(crate) struct Made(pub(crate) Vec<Arc<Makers>>);

impl Made {
    /// The exception of the caller's code that ended an experiment, or else the experiment's error.
    pub(crate) fn raise(&self, error: impl Raise) -> PyErr {
        self.0.iter().find_map(|makers| locked(&makers.raised).take()).unwrap_or_else(|| error.raise())
    }
}

fn made<'py>(
    py: Python<'py>,
    makers: Option<&Makers>,
    mut firing: ByRobot<'py>,
    mut filter: ByRobot<'py>,
    robots: &[eeruf_sim::Robot],
) -> PyResult<(Own, Arc<Calls>)> {
    let mut raised = Raised::default();
    let given = (firing.len(), filter.len());
    if let Some(makers) = makers {
        Makers::fill("make_firing", makers.firing.as_ref(), py, robots, &mut firing)?;
        Makers::fill("make_filter", makers.filter.as_ref(), py, robots, &mut filter)?;
        raised = Arc::clone(&makers.raised);
    }
    let callables = firing.iter().chain(&filter).map(|(_, callable)| Mutex::new(Some(callable.clone().unbind())));
    let of_firing = firing.iter().take(given.0).enumerate().map(|(place, (robot, _))| (true, *robot, place));
    let of_filter = filter.iter().take(given.1).zip(firing.len()..).map(|((robot, _), place)| (false, *robot, place));
    let given = of_firing.chain(of_filter).collect();
    let calls = Arc::new(Calls { callables: callables.collect(), given, raised });
    let mut own = Own::new();
    for (index, (robot, _)) in firing.iter().enumerate() {
        own = own.firing(*robot, OwnFiring { calls: Arc::clone(&calls), index });
    }
    for (index, (robot, _)) in (firing.len()..).zip(&filter) {
        let last = vec![VecDeque::new(); robots[*robot].sensors.len().min(MAX_SENSORS)];
        own = own.filter(*robot, OwnFilter { calls: Arc::clone(&calls), index, last });
    }
    Ok((own, calls))
}

/// The arguments `firing` and `filter` of a simulation of these robots: each is a callable for the first robot, or a
/// dict of callables by robot. The method provides them for the other robots.
pub(crate) fn own(
    py: Python<'_>,
    firing: Option<&Bound<'_, PyAny>>,
    filter: Option<&Bound<'_, PyAny>>,
    makers: Option<&Makers>,
    robots: &[eeruf_sim::Robot],
) -> PyResult<(Own, Arc<Calls>)> {
    let (firing, filter) = (by_robot("firing", firing, robots.len())?, by_robot("filter", filter, robots.len())?);
    made(py, makers, firing, filter, robots)
}

/// A copy: callables given as arguments are kept, and the method's are made again.
pub(crate) fn again(
    py: Python<'_>,
    calls: &Calls,
    makers: Option<&Makers>,
    robots: &[eeruf_sim::Robot],
) -> PyResult<(Own, Arc<Calls>)> {
    let given = |fires: bool| {
        let of = calls.given.iter().filter(|(of, ..)| *of == fires);
        let bound = |&(_, robot, place): &(bool, usize, usize)| {
            let callable = locked(&calls.callables[place]).as_ref()?.clone_ref(py);
            Some((robot, callable.into_bound(py)))
        };
        of.filter_map(bound).collect()
    };
    made(py, makers, given(true), given(false), robots)
}

fn by_robot<'py>(name: &str, value: Option<&Bound<'py, PyAny>>, robots: usize) -> PyResult<ByRobot<'py>> {
    let Some(value) = value else { return Ok(vec![]) };
    if value.is_callable() {
        return Ok(vec![(0, value.clone())]);
    }
    let expected = "a callable, or a dict of callables by robot";
    let Ok(each) = value.cast::<PyDict>() else { return Err(wrong(name, shown(value), expected)) };
    let one = |(robot, callable): (Bound<'py, PyAny>, Bound<'py, PyAny>)| {
        let number = whole(&format!("robot of {name}"), &robot, 0..=robots as u64 - 1)? as usize;
        let called = format!("{name}[{number}]");
        if callable.is_callable() {
            Ok((number, callable))
        } else {
            Err(wrong(&called, shown(&callable), "a callable"))
        }
    };
    each.iter().map(one).collect()
}

struct OwnFiring {
    calls: Arc<Calls>,
    index: usize,
}

const PERIOD: &str = "(length_us, [(t_fire_us, sensor), ..]), or the same with the phase, 0 to 7, as a third";

impl FiringMethod for OwnFiring {
    fn plan(&mut self, period: u32) -> Result<FiringPeriod, OwnError> {
        self.calls.call(self.index, |callable| period_of(&callable.call1((period,))?))
    }
}

/// The period returned by a callable.
fn period_of(returned: &Bound<'_, PyAny>) -> PyResult<FiringPeriod> {
    let refused = || wrong("what firing returned", shown(returned), PERIOD);
    let parts = returned.cast::<PyTuple>().map_err(|_| refused())?;
    if !(2..=3).contains(&parts.len()) {
        return Err(refused());
    }
    let firings = items("what firing returned", &parts.get_item(1)?, PERIOD)?;
    let one = |(place, pair): (usize, Bound<'_, PyAny>)| {
        let pair = pair.cast_into::<PyTuple>().ok().filter(|pair| pair.len() == 2).ok_or_else(refused)?;
        let at = micros(&format!("t_fire_us of firing {place}"), &pair.get_item(0)?)?;
        Ok((at, whole(&format!("sensor of firing {place}"), &pair.get_item(1)?, 0..=MAX_SENSORS as u8 - 1)?))
    };
    Ok(FiringPeriod {
        length: micros("length_us", &parts.get_item(0)?)?,
        phase: if parts.len() == 3 { Phase(whole("phase", &parts.get_item(2)?, 0..=7)?) } else { Phase::A },
        firings: firings.into_iter().enumerate().map(one).collect::<PyResult<_>>()?,
    })
}

struct OwnFilter {
    calls: Arc<Calls>,
    index: usize,
    /// The last echoes of each sensor, the latest first; a filter may return one of them.
    last: Vec<VecDeque<Echo>>,
}

/// Number of echoes of a sensor that are kept.
const KEPT: usize = 16;
const JUDGED: &str = "an eeruf.Reading, or (kind, t_echo_us) with None for no echo";

impl Filter for OwnFilter {
    fn push(&mut self, firing: &eeruf_sim::FiredReading<'_>) -> Result<Filtered, OwnError> {
        let mut none = VecDeque::new();
        let last = self.last.get_mut(usize::from(firing.reading.sensor)).unwrap_or(&mut none);
        for &echo in firing.echoes.iter().rev() {
            last.truncate(KEPT - 1);
            last.push_front(echo);
        }
        self.calls.call(self.index, |callable| {
            let fired = FiredReading {
                reading: Reading::of_ring(firing.reading),
                t_echoes_us: firing.echoes.iter().map(|echo| echo.t_echo().as_micros()).collect(),
                fired_s: firing.fired_s,
                expected_change_us: firing.expected_change_us,
                levels_db: firing.echoes.iter().map(Echo::level_db).collect(),
            };
            let returned = callable.call1((fired,))?;
            let (kind, t_echo) = kind_and_t_echo(&returned)?;
            // The latest echo with that time; if there is none, the firing's first echo, or else the latest of all.
            let echo = t_echo
                .map(|t_echo| {
                    let same = last.iter().find(|echo| echo.t_echo() == t_echo);
                    let nearest = firing.echoes.first().or_else(|| last.front());
                    same.or(nearest).map(|echo| echo.at(t_echo)).ok_or_else(|| {
                        wrong("what filter returned", shown(&returned), "no echo, for a sensor that never had one")
                    })
                })
                .transpose()?;
            Ok(Filtered { kind, echo })
        })
    }
}

/// The kind and the echo time returned by a callable.
fn kind_and_t_echo(returned: &Bound<'_, PyAny>) -> PyResult<(ReadingKind, Option<Micros>)> {
    if let Ok(reading) = returned.cast::<Reading>() {
        return Ok(reading.get().kind_and_t_echo());
    }
    let refused = || wrong("what filter returned", shown(returned), JUDGED);
    let pair = returned.cast::<PyTuple>().ok().filter(|pair| pair.len() == 2).ok_or_else(refused)?;
    let said = pair.get_item(0)?.extract::<String>().map_err(|_| refused())?;
    let kind = ReadingKind::ALL.into_iter().find(|kind| kind.as_str() == said).ok_or_else(refused)?;
    let time = pair.get_item(1)?;
    let t_echo = if time.is_none() {
        None
    } else {
        Some(Micros::new(number("t_echo_us that filter returned", &time, 0.0..=f64::from(u32::MAX))?.round() as u32))
    };
    Ok((kind, t_echo))
}
