//! The methods of `Ring`.

use std::sync::Arc;

use eeruf_core::watch::SensorWatch;
use pyo3::{prelude::*, types::PyDict};

use crate::{
    arguments::{flag, instance, micros, number},
    errors::EerufError,
    exclusive::Exclusive,
    moments::{expected_changes, instant, until},
    requirements::{Asked, UNEVEN},
    ring::{AnyRing, Fires, Promise, Ring, act, ask, of_sensor, table},
    ring_arguments::{FlowNeeds, Sound, begins, config},
    ring_events::{Fire, to_python},
    schedule::Schedule,
    sensor_watch::State,
};

#[pymethods]
#[expect(clippy::too_many_arguments, reason = "keyword arguments")]
impl Ring {
    #[new]
    #[pyo3(signature = (schedule, t_delta_us, now_us=None, *, window_us=None, blanking_us=None, consecutive=None,
        path_change_us=None, audible_us=None, several_echoes=None, silence=None, **needs))]
    #[pyo3(text_signature = "(schedule, t_delta_us, now_us=0, *, window_us=None, blanking_us=0, consecutive=2, \
            path_change_us=None, audible_us=None, refire_us=None, intervals_us=None, shared_lines=None, \
            together=None, several_echoes=False, silence=\"never_free\")")]
    fn new<'py>(
        schedule: &Bound<'py, PyAny>,
        t_delta_us: &Bound<'py, PyAny>,
        now_us: Option<&Bound<'_, PyAny>>,
        window_us: Option<&Bound<'py, PyAny>>,
        blanking_us: Option<&Bound<'_, PyAny>>,
        consecutive: Option<&Bound<'_, PyAny>>,
        path_change_us: Option<&Bound<'_, PyAny>>,
        audible_us: Option<&Bound<'_, PyAny>>,
        several_echoes: Option<&Bound<'_, PyAny>>,
        silence: Option<&Bound<'_, PyAny>>,
        needs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Self> {
        let fires = instance::<Schedule>("schedule", schedule, "an eeruf.Schedule")?.get().0;
        let placed = [("t_delta_us", Some(t_delta_us)), ("window_us", window_us)];
        let needs = Asked::of(schedule.py(), "Ring", placed, needs, &[&UNEVEN])?.ring_of(&fires)?;
        let mut config =
            config(needs.t_delta, needs.listening, blanking_us, consecutive, &Sound { path_change_us, audible_us })?;
        config.path_change = config.path_change.or(needs.path_change);
        config.audible = config.audible.or(needs.audible);
        let (several, now) = (flag("several_echoes", several_echoes, false)?, begins(now_us)?);
        let promise = if needs.uneven.is_some() { Promise::EachSensor(Arc::new(needs)) } else { Promise::TDelta };
        Self::of(AnyRing::by_schedule(&fires, promise, config, several, now)?, silence)
    }

    /// A ring whose schedule was not verified. Crosstalk that it repeats, as constant waits do, makes readings
    /// ``"ambiguous"``; none of it is accepted.
    ///
    /// Args:
    ///     schedule: when the sensors fire.
    ///     t_delta_us: as for ``Ring``, as are all others.
    ///     now_us: when the first period begins.
    ///     window_us: how long a sensor listens after it has fired, 1 or more.
    ///     blanking_us: edges sooner than this after firing are no echoes.
    ///     consecutive: the number of consecutive readings that must agree, 2 to 8.
    ///     path_change_us: P, at most 65,534; None for ``t_delta_us``.
    ///     audible_us: R, at most 67 s; None for one period.
    ///     silence: as for ``Ring``.
    ///
    /// Raises:
    ///     EerufError: an argument of the wrong type or out of range; invalid listening times.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> constant = eeruf.Schedule(60_000, [0, 15_000], [0, 0], [0, 0])
    ///     >>> eeruf.Ring.unverified(constant, 500, window_us=36_000).poll(0)
    ///     Fire(sensor=0, phase=0, due_us=0)
    #[staticmethod]
    #[pyo3(signature = (schedule, t_delta_us, now_us=None, *, window_us, blanking_us=None, consecutive=None,
        path_change_us=None, audible_us=None, silence=None))]
    #[pyo3(text_signature = "(schedule, t_delta_us, now_us=0, *, window_us, blanking_us=0, consecutive=2, \
            path_change_us=None, audible_us=None, silence=\"never_free\")")]
    fn unverified(
        schedule: &Bound<'_, PyAny>,
        t_delta_us: &Bound<'_, PyAny>,
        now_us: Option<&Bound<'_, PyAny>>,
        window_us: &Bound<'_, PyAny>,
        blanking_us: Option<&Bound<'_, PyAny>>,
        consecutive: Option<&Bound<'_, PyAny>>,
        path_change_us: Option<&Bound<'_, PyAny>>,
        audible_us: Option<&Bound<'_, PyAny>>,
        silence: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (t_delta, window) = (micros("t_delta_us", t_delta_us)?, micros("window_us", window_us)?);
        let config = config(t_delta, window, blanking_us, consecutive, &Sound { path_change_us, audible_us })?;
        let schedule = instance::<Schedule>("schedule", schedule, "an eeruf.Schedule")?.get().0;
        let now = begins(now_us)?;
        Self::of(AnyRing::by_schedule(&schedule, Promise::Nothing, config, false, now)?, silence)
    }

    /// A flow ring: one sensor after the other, with only as much quiet around each firing as its readings need, and a
    /// random time in every gap. An echo is accepted if it fits the belief, or if two in a row agree and no firing of
    /// the ring explains both. A late loop costs only time. See ``docs/explanation/flow.md``.
    ///
    /// Args:
    ///     sensors: how many, 1 to 64; or a :class:`Needs`, or the path of a ring file, in place of all needs, with the
    ///         window, rest, blanking and reach of its module.
    ///     settings: a dict of settings that differ from the default. For the plan: ``least_us`` and ``most_us``, the
    ///         least and the most quiet; ``rest_us``, how long a sensor rests; ``dice_us``, the random time in every
    ///         gap; and ``seed``, not 0, by default a new one for each ring. For belief: ``t_delta_us``, ``near_us``,
    ///         ``path_change_us``, ``memory``, ``hold``; ``top_speed_m_s``, assumed while :meth:`moving` reports none;
    ///         ``alone``, whether no other robot is near; and ``votes``: ``"two_in_a_row"``, two echoes must agree;
    ///         ``"every_echo"``, one is enough; or ``"by_motion"``, one is enough while the robot moves and is
    ///         alone.
    ///     now_us: when the first cycle begins.
    ///     window_us: ``T_wind``: how long a sensor listens after it has fired, 1 or more; one for all, or each.
    ///         Required unless a :class:`Needs` is given.
    ///     blanking_us: edges sooner than this after firing are no echoes.
    ///     reach_us: R: the time after which no sound is audible, including the tail of an echo; by default two ninths
    ///         more than the window. It is the most quiet that a sensor gets.
    ///     refire_us: how soon a sensor may be triggered again, one for all, or each: the longest holds for all.
    ///     shared_lines: groups of sensors on one echo line, ``[(0, 3), (1, 4)]``: none fires while another listens.
    ///     together: groups of sensors that fire at the same instants, declared not to hear each other.
    ///     several_echoes: each sensor reports several echoes of a firing, up to eight of which are judged.
    ///     silence: as for ``Ring``.
    ///
    /// Raises:
    ///     EerufError: an argument of the wrong type or out of range; settings that contradict each other or the
    ///         window.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring.flow(8, {"rest_us": 60_000}, window_us=36_000)
    ///     >>> ring.poll(ring.next_deadline_us).sensor
    ///     0
    ///     >>> ring = eeruf.Ring.flow(eeruf.Needs(sensors=8, module="hc-sr04"))
    ///     >>> ring.window_us
    ///     24310
    #[staticmethod]
    #[pyo3(signature = (sensors, settings=None, now_us=None, *, window_us=None, blanking_us=None, reach_us=None,
        several_echoes=None, silence=None, **needs))]
    #[pyo3(text_signature = "(sensors, settings=None, now_us=0, *, window_us=None, blanking_us=0, reach_us=None, \
            refire_us=None, shared_lines=None, together=None, several_echoes=False, silence=\"never_free\")")]
    fn flow<'py>(
        sensors: &Bound<'py, PyAny>,
        settings: Option<&Bound<'_, PyAny>>,
        now_us: Option<&Bound<'_, PyAny>>,
        window_us: Option<&Bound<'py, PyAny>>,
        blanking_us: Option<&Bound<'_, PyAny>>,
        reach_us: Option<&Bound<'_, PyAny>>,
        several_echoes: Option<&Bound<'_, PyAny>>,
        silence: Option<&Bound<'_, PyAny>>,
        needs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Self> {
        let (several, now) = (flag("several_echoes", several_echoes, false)?, begins(now_us)?);
        let known: &[&[&str]] = &[&["refire_us", "shared_lines", "together"]];
        let asked = Asked::of(sensors.py(), "flow", [("window_us", window_us)], needs, known)?;
        let needs = FlowNeeds { asked, blanking_us, reach_us };
        Self::of(AnyRing::flow(sensors, settings, &needs, several, now)?, silence)
    }

    /// The next event at a time. Call again until there is none, then wait until ``next_deadline_us``.
    ///
    /// Report the echoes you know of before you poll: one that comes after the poll that closed its window is lost.
    ///
    /// Args:
    ///     now_us: the current time, 0 or more.
    ///     expected_change_us: for each sensor, the expected change of a good reading since the previous one, by the
    ///         robot's own motion: ``-2 v dt / c`` for an object approached at ``v``. None for a robot at rest.
    ///
    /// Returns:
    ///     A ``Fire``, a ``Reading``, a ``PeriodEnded``, or None if there is nothing to do now.
    ///
    /// Raises:
    ///     EerufError: an invalid time, or expected changes that are not one for each sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.poll(23_000)
    ///     >>> ring.poll(24_000)
    ///     Fire(sensor=0, phase=0, due_us=24000)
    #[pyo3(signature = (now_us, expected_change_us=None))]
    fn poll<'py>(
        &self,
        now_us: &Bound<'py, PyAny>,
        expected_change_us: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let (py, now) = (now_us.py(), instant("now_us", now_us)?);
        let changes = expected_changes(expected_change_us, self.sensors()?)?;
        let change = |sensor: u8| changes.get(usize::from(sensor)).copied().unwrap_or(0);
        let event = self.0.get()?.poll(now, change);
        event.map(|event| to_python(py, &event)).transpose()
    }

    /// Report to a flow ring how fast the robot moves and turns, once per control cycle, even at rest. Good readings
    /// may then change by that much more. After half a second without a report ``top_speed_m_s`` is assumed.
    ///
    /// Args:
    ///     speed_m_s: in m/s, up to 100 in either direction.
    ///     turn_rad_s: in rad/s, up to 100 in either direction.
    ///     now_us: the current time, 0 or more.
    ///
    /// Raises:
    ///     EerufError: an invalid speed or time; the ring fires by a schedule, whose :meth:`poll` takes
    ///         the expected change.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring.flow(8, window_us=36_000)
    ///     >>> ring.moving(0.5, 0.0, now_us=20_000)
    fn moving(
        &self,
        speed_m_s: &Bound<'_, PyAny>,
        turn_rad_s: &Bound<'_, PyAny>,
        now_us: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let permille = |name, value| number(name, value, -100.0..=100.0).map(|value| (1e3 * value.abs()).ceil() as u32);
        let (speed, turn) = (permille("speed_m_s", speed_m_s)?, permille("turn_rad_s", turn_rad_s)?);
        let now = instant("now_us", now_us)?;
        match &mut self.0.get()?.fires {
            Fires::Flow(ring) => ring.moving(speed, turn, now),
            Fires::FlowSeveral(ring) => ring.moving(speed, turn, now),
            _ => return Err(EerufError::new_err("moving of a ring by a schedule; expected a ring by eeruf.Ring.flow")),
        }
        Ok(())
    }

    /// A copy continues from the same state.
    fn __copy__(&self) -> PyResult<Self> {
        Ok(Self(Exclusive::new("Ring", self.0.get()?.clone())))
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.__copy__()
    }

    fn __repr__(&self) -> PyResult<String> {
        Ok(format!("<Ring: {} sensors, next deadline at {} us>", self.sensors()?, self.next_deadline_us()?))
    }

    /// When to poll next, in microseconds of the clock that wraps at 2^32; in the past if an event is pending.
    #[getter]
    fn next_deadline_us(&self) -> PyResult<u32> {
        Ok(ask!(self.0.get()?, |ring| ring.next_deadline()).as_micros())
    }

    /// Time to wait before polling next, in microseconds: 0 if an event is pending.
    ///
    /// It is correct across the wrap of the clock at 2^32, where ``next_deadline_us`` and a growing ``now_us`` cannot
    /// be compared.
    ///
    /// Args:
    ///     now_us: the current time, 0 or more.
    ///
    /// Raises:
    ///     EerufError: an invalid time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000, now_us=2**32 - 1_000)
    ///     >>> ring.wait_us(2**32 - 1_000), ring.wait_us(2**32 + 23_000)
    ///     (24000, 0)
    fn wait_us(&self, now_us: &Bound<'_, PyAny>) -> PyResult<u32> {
        let now = instant("now_us", now_us)?;
        Ok(until(ask!(self.0.get()?, |ring| ring.next_deadline()), now))
    }

    /// Schedule of the current period, for a ring that fires by a schedule.
    #[getter]
    fn schedule(&self) -> PyResult<Schedule> {
        Ok(Schedule(self.0.get()?.schedule()?))
    }

    /// Fire by another schedule when the current period ends. ``t_delta_us``, ``window_us`` and the needs of
    /// single sensors are unchanged.
    ///
    /// Args:
    ///     schedule: a schedule for the same number of sensors.
    ///
    /// Raises:
    ///     EerufError: not a schedule, or one for another number of sensors; a sensor would fire again while it
    ///         still listens; or the schedule does not reject crosstalk at this ``t_delta_us`` or does not meet a
    ///         sensor's needs. The ring continues as before.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.change_schedule(eeruf.tables.TABLE_I_D.scaled(4, 5))
    ///     >>> while not isinstance(ring.poll(ring.next_deadline_us), eeruf.PeriodEnded):
    ///     ...     pass
    ///     >>> ring.schedule.period_us
    ///     80000
    fn change_schedule(&self, schedule: &Bound<'_, PyAny>) -> PyResult<()> {
        let schedule = instance::<Schedule>("schedule", schedule, "an eeruf.Schedule")?;
        self.0.get()?.change_schedule(&schedule.get().0)
    }

    /// ``T_delta``, in microseconds. It can be changed while the ring runs, if the ring fires by a :class:`Schedule`.
    #[getter]
    fn t_delta_us(&self) -> PyResult<u32> {
        Ok(self.0.get()?.t_delta().as_micros())
    }

    #[setter]
    fn set_t_delta_us(&self, t_delta_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let t_delta = micros("t_delta_us", t_delta_us)?;
        self.0.get()?.set_t_delta(t_delta)
    }

    /// ``T_wind``, in microseconds. It can be changed while the ring runs, even for firings in progress.
    #[getter]
    fn window_us(&self) -> PyResult<u32> {
        Ok(ask!(self.0.get()?, |ring| ring.window()).as_micros())
    }

    #[setter]
    fn set_window_us(&self, window_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let window = micros("window_us", window_us)?;
        AnyRing::raised(act!(self.0.get()?, |ring| ring.set_window(window)))
    }

    /// Time after a firing during which edges are not echoes, in microseconds. It can be changed while the ring runs.
    #[getter]
    fn blanking_us(&self) -> PyResult<u32> {
        Ok(ask!(self.0.get()?, |ring| ring.blanking()).as_micros())
    }

    #[setter]
    fn set_blanking_us(&self, blanking_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let blanking = micros("blanking_us", blanking_us)?;
        AnyRing::raised(act!(self.0.get()?, |ring| ring.set_blanking(blanking)))
    }

    /// P, the largest change of a foreign sound's path from one reading to the next, in microseconds, for a ring with a
    /// schedule. It can be changed while the ring runs, for example when the robot's speed changes.
    #[getter]
    fn path_change_us(&self) -> PyResult<u32> {
        Ok(self.0.get()?.path_change()?.as_micros())
    }

    #[setter]
    fn set_path_change_us(&self, path_change_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let (change, mut any) = (micros("path_change_us", path_change_us)?, self.0.get()?);
        AnyRing::raised(table!(any, "path_change_us", |ring| ring.set_path_change(change))?)
    }

    /// R, how long sound is audible, in microseconds, for a ring with a schedule. It can be changed while the ring
    /// runs.
    #[getter]
    fn audible_us(&self) -> PyResult<u32> {
        table!(self.0.get()?, "audible_us", |ring| ring.audible().as_micros())
    }

    #[setter]
    fn set_audible_us(&self, audible_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let (audible, mut any) = (micros("audible_us", audible_us)?, self.0.get()?);
        AnyRing::raised(table!(any, "audible_us", |ring| ring.set_audible(audible))?)
    }

    /// Earliest time after a firing at which a reading without an echo is emitted, in microseconds: for modules that
    /// report over a bus or by a pulse's width after their window has closed. 0 for when it closes.
    #[getter]
    fn report_after_us(&self) -> PyResult<u32> {
        Ok(ask!(self.0.get()?, |ring| ring.report_after()).as_micros())
    }

    #[setter]
    fn set_report_after_us(&self, report_after_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let report_after = micros("report_after_us", report_after_us)?;
        AnyRing::raised(act!(self.0.get()?, |ring| ring.set_report_after(report_after)))
    }

    /// The firings to come, up to the end of the next period: for hardware that fires by itself.
    ///
    /// They are valid until one is late or the ring is changed. The loop itself may be late: for each firing, poll at
    /// its instant until there is no event, so that ``Fire`` reports a completed firing; then report the echoes, and
    /// finally poll at the current time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> [(fire.sensor, fire.due_us) for fire in ring.upcoming()[:4]]
    ///     [(0, 24000), (4, 24000), (8, 24000), (1, 49000)]
    fn upcoming(&self) -> PyResult<Vec<Fire>> {
        Ok(ask!(self.0.get()?, |ring| ring.upcoming().map(Fire::of).collect()))
    }

    /// The number of sensors.
    #[getter]
    fn sensors(&self) -> PyResult<usize> {
        Ok(self.0.get()?.sensors())
    }

    /// Report an edge on the echo line of a sensor. Edges may come in any order and at any time.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///     at_us: when, 0 or more.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor or time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> [ring.poll(24_000).sensor for _ in range(3)]  # one of each group of four
    ///     [0, 4, 8]
    ///     >>> ring.echo(0, 33_000)
    ///     >>> ring.poll(33_000).t_echo_us
    ///     9000
    fn echo(&self, sensor: &Bound<'_, PyAny>, at_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let (sensor, at) = (self.0.get()?.sensor(sensor)?, instant("at_us", at_us)?);
        AnyRing::raised(act!(self.0.get()?, |ring| ring.echo(sensor, at)))
    }

    /// Report an edge that lies somewhere between two times: the line was last seen without it at one, and first seen
    /// with it at the other. The middle counts as in :meth:`echo`, and foreign sound at any time in between explains
    /// the reading. If it may be off by more than 300 us (5 cm), the reading is ``"late"``.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///     earliest_us: when the line was last seen without the edge, 0 or more.
    ///     latest_us: when it was first seen with it, not before that.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor or time; the latest is before the earliest.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> [ring.poll(24_000).sensor for _ in range(3)]  # one of each group of four
    ///     [0, 4, 8]
    ///     >>> ring.echo_between(0, 32_900, 33_100)
    ///     >>> ring.poll(33_100).t_echo_us
    ///     9000
    fn echo_between(
        &self,
        sensor: &Bound<'_, PyAny>,
        earliest_us: &Bound<'_, PyAny>,
        latest_us: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let sensor = self.0.get()?.sensor(sensor)?;
        let (earliest, latest) = (instant("earliest_us", earliest_us)?, instant("latest_us", latest_us)?);
        AnyRing::raised(act!(self.0.get()?, |ring| ring.echo_between(sensor, earliest, latest)))
    }

    /// Correct the time when a sensor last fired, for example to one that a timer captured. Optional: echo times count
    /// from then, and if it is later than the poll, all later firings move by as much.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///     at_us: when, 0 or more; a time that is not after the sensor's previous firing is ignored.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor or time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> _ = [ring.poll(24_000) for _ in range(3)]  # one of each group of four fires
    ///     >>> ring.fired(0, 24_100)
    ///     >>> ring.echo(0, 33_000)
    ///     >>> ring.poll(33_000).t_echo_us
    ///     8900
    fn fired(&self, sensor: &Bound<'_, PyAny>, at_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let (sensor, at) = (self.0.get()?.sensor(sensor)?, instant("at_us", at_us)?);
        AnyRing::raised(act!(self.0.get()?, |ring| ring.fired(sensor, at)))
    }

    /// Report that the echo line of a sensor was already high when it was to fire: the firing just emitted counts as
    /// ``"stuck"``.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> _ = [ring.poll(24_000) for _ in range(3)]  # one of each group of four fires
    ///     >>> ring.stuck(0)
    ///     >>> while not isinstance(event := ring.poll(ring.next_deadline_us), eeruf.Reading):
    ///     ...     pass
    ///     >>> event.sensor, event.kind
    ///     (0, 'stuck')
    fn stuck(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        of_sensor!(self, sensor, |ring| ring.stuck(sensor))
    }

    /// The state of the space in front of a sensor, at the time of the last poll.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///
    /// Returns:
    ///     A ``State``: an obstacle, clear, too close, unanswered or unknown, with its age and the reason.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.state(3)
    ///     State(kind='unknown', t_echo_us=None, age_us=0, why='no_firing', explained_by=None)
    fn state<'py>(&self, sensor: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let ring = self.0.get()?;
        State::of(&ring.watch, ring.sensor(sensor)?, ring.now).into_python(sensor.py())
    }

    /// Report the result of a sensor's last firing that hardware or a protocol measured, before its reading is emitted:
    /// see ``report_after_us``.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///     t_echo_us: the echo time in microseconds, or None if it listened and heard nothing.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor or time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> _ = [ring.poll(24_000) for _ in range(3)]  # one of each group of four fires
    ///     >>> ring.measured(4, 9_000)
    ///     >>> ring.poll(40_000).t_echo_us
    ///     9000
    #[pyo3(signature = (sensor, t_echo_us))]
    fn measured(&self, sensor: &Bound<'_, PyAny>, t_echo_us: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let t_echo = t_echo_us.map(|us| micros("t_echo_us", us)).transpose()?;
        of_sensor!(self, sensor, |ring| ring.measured(sensor, t_echo))
    }

    /// Report that a sensor has shown that it listens for the echo of its last firing, for instance by a
    /// rising line.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///     answered: False to take the report back, if it was a disturbance.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000, silence="needs_answer")
    ///     >>> while not isinstance(event := ring.poll(ring.next_deadline_us), eeruf.Reading):
    ///     ...     if isinstance(event, eeruf.Fire):
    ///     ...         ring.answered(event.sensor)
    ///     >>> event.kind
    ///     'no_echo'
    #[pyo3(signature = (sensor, answered=None), text_signature = "($self, sensor, answered=True)")]
    fn answered(&self, sensor: &Bound<'_, PyAny>, answered: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let (sensor, answered) = (self.0.get()?.sensor(sensor)?, flag("answered", answered, true)?);
        AnyRing::raised(act!(self.0.get()?, |ring| if answered {
            ring.answered(sensor)
        } else {
            ring.unanswered(sensor)
        }))
    }

    /// Forget a sensor's last echo, such as a false one, so that its next reading is compared with nothing.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.forget(3)
    fn forget(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        of_sensor!(self, sensor, |ring| ring.forget(sensor))
    }

    /// Stop a sensor from firing. The reading of a firing in progress is still emitted.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.disable(0)
    ///     >>> ring.is_enabled(0)
    ///     False
    fn disable(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        of_sensor!(self, sensor, |ring| ring.disable(sensor))
    }

    /// Let a sensor fire again, from its next turn on. Its earlier readings are forgotten.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.disable(0)
    ///     >>> ring.enable(0)
    ///     >>> ring.is_enabled(0)
    ///     True
    fn enable(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        of_sensor!(self, sensor, |ring| ring.enable(sensor))
    }

    /// Returns true if a sensor is enabled.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.is_enabled(11)
    ///     True
    fn is_enabled(&self, sensor: &Bound<'_, PyAny>) -> PyResult<bool> {
        let sensor = self.0.get()?.sensor(sensor)?;
        Ok(ask!(self.0.get()?, |ring| ring.is_enabled(sensor)))
    }

    /// Let no sensor fire until :meth:`resume`. Readings of firings in progress are still emitted, and periods go on.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.pause()
    ///     >>> type(ring.poll(ring.next_deadline_us)).__name__
    ///     'PeriodEnded'
    fn pause(&self) -> PyResult<()> {
        act!(self.0.get()?, |ring| ring.pause());
        Ok(())
    }

    /// Let sensors fire again from the next period on. Earlier readings are forgotten.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.pause()
    ///     >>> ring.resume()
    ///     >>> _ = ring.poll(ring.next_deadline_us)  # the period ends
    ///     >>> type(ring.poll(ring.next_deadline_us)).__name__
    ///     'Fire'
    fn resume(&self) -> PyResult<()> {
        act!(self.0.get()?, |ring| ring.resume());
        Ok(())
    }

    /// Start again with phase a, for example after a long sleep: at a given time, or as soon as the last firings allow.
    /// Firings in progress are dropped, and earlier readings are forgotten.
    ///
    /// Args:
    ///     now_us: the current time, 0 or more.
    ///
    /// Raises:
    ///     EerufError: an invalid time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.restart(3_600_000_000)
    ///     >>> ring.wait_us(3_600_000_000)
    ///     24000
    fn restart(&self, now_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let now = instant("now_us", now_us)?;
        let mut any = self.0.get()?;
        act!(any, |ring| ring.restart(now));
        any.watch = SensorWatch::new(0, now);
        Ok(())
    }
}
