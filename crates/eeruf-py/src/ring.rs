//! `Ring`.

use pyo3::prelude::*;

use crate::{
    arguments::{flag, instance, micros},
    exclusive::Exclusive,
    moments::{expected_changes, instant, until},
    owned_ring::OwnedRing,
    requirements::{RequirementArguments, UnevenArguments},
    ring_arguments::{Sound, begins, config},
    ring_events::{Fire, to_python},
    schedule::Schedule,
    sensor_watch::State,
};

/// Plan and filter together, as the firmware runs them: the caller passes the time and gets back what to do.
///
/// Moments are microseconds on a clock that wraps at 2^32, as on a small microcontroller; larger numbers are taken
/// modulo that.
///
/// Args:
///     schedule: when the sensors fire.
///     t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11). One for all,
///         or a sequence with one for each sensor.
///     now_us: when the first period begins.
///     window_us: ``T_wind``: how long a sensor listens after it has fired, 1 or more. One for all, or a sequence.
///     blanking_us: edges sooner than this after firing are ringing of the transducer, not echoes.
///     consecutive: the number of consecutive readings that must agree, 2 to 8.
///     path_change_us: P: the largest change of a foreign sound's path from one reading to the next, at
///         most 65,534; None for ``t_delta_us``. Less makes fewer readings ambiguous where firings are late.
///     audible_us: R: how long sound is audible, at most 67 s; None for one period.
///     refire_us: how soon a sensor may be triggered again, as for :func:`design`. With this, with those below or with
///         a sequence above the ring is one of sensors that are not all alike: its schedule must keep what each needs,
///         each listens and compares by its own numbers, and ``t_delta_us`` and ``window_us`` say the largest.
///     intervals_us: pairs of sensors with the least time between their firings: ``[(0, 4, 9000)]``.
///     shared_lines: groups of sensors on one echo line, ``[(0, 3), (1, 4)]``: none fires while another listens.
///     together: groups of sensors that fire at the same instants, declared not to hear each other.
///
/// Raises:
///     ArgumentError: something of the wrong type or out of range.
///     RingError: the ring cannot listen like that, such as longer than the schedule lets it; or the schedule does not
///         reject crosstalk at this ``t_delta_us`` (see ``Ring.unverified``), or breaks what a sensor needs.
///
/// Example:
///     >>> import eeruf
///     >>> ring, kinds = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000), []
///     >>> while len(kinds) < 24:
///     ...     now_us = ring.next_deadline_us
///     ...     while event := ring.poll(now_us):
///     ...         if isinstance(event, eeruf.Fire):
///     ...             ring.echo(event.sensor, now_us + 9_000)  # a wall 1.5 m away
///     ...         elif isinstance(event, eeruf.Reading):
///     ...             kinds.append(event.kind)
///     >>> kinds == ["first"] * 12 + ["accepted"] * 12
///     True
///     >>> needs = dict(t_delta_us=[999, 999, 1500, 1500], window_us=[36_000, 36_000, 12_000, 12_000])
///     >>> found = eeruf.design(4, min_interval_us=15_000, shared_lines=[(0, 2)], **needs)
///     >>> ring = eeruf.Ring(found.schedule, shared_lines=[(0, 2)], **needs)
///     >>> ring.t_delta_us, ring.window_us
///     (1500, 36000)
#[pyclass(frozen, module = "eeruf")]
pub(crate) struct Ring(pub(crate) Exclusive<OwnedRing>);

impl Ring {
    fn of(ring: OwnedRing) -> Self {
        Self(Exclusive::new("Ring", ring))
    }
}

#[pymethods]
impl Ring {
    #[new]
    #[pyo3(signature = (schedule, t_delta_us, now_us=None, *, window_us, blanking_us=None, consecutive=None,
        path_change_us=None, audible_us=None, refire_us=None, intervals_us=None, shared_lines=None, together=None))]
    #[pyo3(text_signature = "(schedule, t_delta_us, now_us=0, *, window_us, blanking_us=0, consecutive=2, \
            path_change_us=None, audible_us=None, refire_us=None, intervals_us=None, shared_lines=None, \
            together=None)")]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn new(
        schedule: &Bound<'_, PyAny>,
        t_delta_us: &Bound<'_, PyAny>,
        now_us: Option<&Bound<'_, PyAny>>,
        window_us: &Bound<'_, PyAny>,
        blanking_us: Option<&Bound<'_, PyAny>>,
        consecutive: Option<&Bound<'_, PyAny>>,
        path_change_us: Option<&Bound<'_, PyAny>>,
        audible_us: Option<&Bound<'_, PyAny>>,
        refire_us: Option<&Bound<'_, PyAny>>,
        intervals_us: Option<&Bound<'_, PyAny>>,
        shared_lines: Option<&Bound<'_, PyAny>>,
        together: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let fires = instance::<Schedule>("schedule", schedule, "an eeruf.Schedule")?.get().0;
        let needs = RequirementArguments {
            uneven: UnevenArguments { refire_us, intervals_us, shared_lines, together },
            ..RequirementArguments::alike(Some(t_delta_us), None, None, None, None, (Some(window_us), None))
        };
        let needs = needs.owned(&fires)?;
        let [t_delta, window] = needs.most();
        let config = config(t_delta, window, blanking_us, consecutive, &Sound { path_change_us, audible_us })?;
        if needs.is_uneven() {
            return OwnedRing::uneven(fires, needs, config, begins(now_us)?).map(Self::of);
        }
        OwnedRing::new(fires, config, begins(now_us)?)?.verified().map(Self::of)
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
    ///     path_change_us: P: the largest change of a foreign sound's path from one reading to the next,
    ///         at most 65,534; None for ``t_delta_us``. Less makes fewer readings ambiguous where firings are late.
    ///     audible_us: R: how long sound is audible, at most 67 s; None for one period.
    ///
    /// Raises:
    ///     ArgumentError: something of the wrong type or out of range.
    ///     RingError: the ring cannot listen like that.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> constant = eeruf.Schedule(60_000, [0, 15_000], [0, 0], [0, 0])
    ///     >>> eeruf.Ring.unverified(constant, 500, window_us=36_000).poll(0)
    ///     Fire(sensor=0, phase=0, due_us=0)
    #[staticmethod]
    #[pyo3(signature = (schedule, t_delta_us, now_us=None, *, window_us, blanking_us=None, consecutive=None,
        path_change_us=None, audible_us=None))]
    #[pyo3(text_signature = "(schedule, t_delta_us, now_us=0, *, window_us, blanking_us=0, consecutive=2, \
            path_change_us=None, audible_us=None)")]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn unverified(
        schedule: &Bound<'_, PyAny>,
        t_delta_us: &Bound<'_, PyAny>,
        now_us: Option<&Bound<'_, PyAny>>,
        window_us: &Bound<'_, PyAny>,
        blanking_us: Option<&Bound<'_, PyAny>>,
        consecutive: Option<&Bound<'_, PyAny>>,
        path_change_us: Option<&Bound<'_, PyAny>>,
        audible_us: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (t_delta, window) = (micros("t_delta_us", t_delta_us)?, micros("window_us", window_us)?);
        let config = config(t_delta, window, blanking_us, consecutive, &Sound { path_change_us, audible_us })?;
        let schedule = instance::<Schedule>("schedule", schedule, "an eeruf.Schedule")?.get().0;
        OwnedRing::new(schedule, config, begins(now_us)?).map(Self::of)
    }

    /// The next event at a time. Call again until there is none, then wait until ``next_deadline_us``.
    ///
    /// Hand in the echoes you know of before you poll: one that comes after the poll that closed its window is not
    /// heard.
    ///
    /// Args:
    ///     now_us: the present, 0 or more.
    ///     expected_change_us: for each sensor, the expected change of a good reading from the one before, by the
    ///         robot's own motion: ``-2 v dt / c`` for an object approached at ``v``. None for a robot that stands.
    ///
    /// Returns:
    ///     A ``Fire``, a ``Reading``, a ``PeriodEnded``, or None if there is nothing to do now.
    ///
    /// Raises:
    ///     ArgumentError: not such a time, or not one change for each sensor.
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
        let sensors = self.0.get()?.ring().sensors();
        let changes = expected_changes(expected_change_us, sensors)?;
        let change = |sensor: u8| changes.get(usize::from(sensor)).copied().unwrap_or(0);
        let event = self.0.get()?.poll(now, change);
        event.map(|event| to_python(py, &event)).transpose()
    }

    fn __repr__(&self) -> PyResult<String> {
        Ok(format!("<Ring: {} sensors, next deadline at {} us>", self.sensors()?, self.next_deadline_us()?))
    }

    /// When to poll next, in microseconds of the clock that wraps at 2^32; in the past if an event is pending.
    #[getter]
    fn next_deadline_us(&self) -> PyResult<u32> {
        Ok(self.0.get()?.ring().next_deadline().as_micros())
    }

    /// Time to wait before polling next, in microseconds: 0 if an event is pending.
    ///
    /// This is right across the wrap of the clock at 2^32, where ``next_deadline_us`` and a ``now_us`` that goes on
    /// growing no longer compare.
    ///
    /// Args:
    ///     now_us: the present, 0 or more.
    ///
    /// Raises:
    ///     ArgumentError: not such a time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000, now_us=2**32 - 1_000)
    ///     >>> ring.wait_us(2**32 - 1_000), ring.wait_us(2**32 + 23_000)
    ///     (24000, 0)
    #[pyo3(signature = (now_us))]
    fn wait_us(&self, now_us: &Bound<'_, PyAny>) -> PyResult<u32> {
        let now = instant("now_us", now_us)?;
        Ok(until(self.0.get()?.ring().next_deadline(), now))
    }

    /// Schedule of the present period.
    #[getter]
    fn schedule(&self) -> PyResult<Schedule> {
        Ok(Schedule(*self.0.get()?.ring().schedule()))
    }

    /// Fire by another schedule when the present period ends. ``t_delta_us`` and ``window_us``
    /// stay, and so does what each sensor needs where they are not all alike.
    ///
    /// Args:
    ///     schedule: of as many sensors.
    ///
    /// Raises:
    ///     ArgumentError: no schedule, or not of as many sensors.
    ///     RingError: a sensor would fire again while it still listens, or the schedule does not reject crosstalk at
    ///         this ``t_delta_us``, or breaks what a sensor needs. The ring goes on as before.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.change_schedule(eeruf.tables.TABLE_I_D.scaled(4, 5))
    ///     >>> while not isinstance(ring.poll(ring.next_deadline_us), eeruf.PeriodEnded):
    ///     ...     pass
    ///     >>> ring.schedule.period_us
    ///     80000
    #[pyo3(signature = (schedule))]
    fn change_schedule(&self, schedule: &Bound<'_, PyAny>) -> PyResult<()> {
        let schedule = &instance::<Schedule>("schedule", schedule, "an eeruf.Schedule")?.get().0;
        self.0.get()?.change_to(schedule)
    }

    /// ``T_delta``, in microseconds. It can be changed while the ring runs.
    #[getter]
    fn t_delta_us(&self) -> PyResult<u32> {
        Ok(self.0.get()?.ring().t_delta().as_micros())
    }

    #[setter]
    fn set_t_delta_us(&self, t_delta_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let t_delta = micros("t_delta_us", t_delta_us)?;
        self.0.get()?.set_t_delta(t_delta)
    }

    /// ``T_wind``, in microseconds. It can be changed while the ring runs, also for firings that are under way.
    #[getter]
    fn window_us(&self) -> PyResult<u32> {
        Ok(self.0.get()?.ring().window().as_micros())
    }

    #[setter]
    fn set_window_us(&self, window_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let window = micros("window_us", window_us)?;
        self.0.get()?.change(|ring| ring.set_window(window))
    }

    /// For how long after firing edges are no echoes, in microseconds. It can be changed while the ring runs.
    #[getter]
    fn blanking_us(&self) -> PyResult<u32> {
        Ok(self.0.get()?.ring().blanking().as_micros())
    }

    #[setter]
    fn set_blanking_us(&self, blanking_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let blanking = micros("blanking_us", blanking_us)?;
        self.0.get()?.change(|ring| ring.set_blanking(blanking))
    }

    /// P, the largest change of a foreign sound's path from one reading to the next, in microseconds. It can be
    /// changed while the ring runs: as the robot's speed changes, for example.
    #[getter]
    fn path_change_us(&self) -> PyResult<u32> {
        let owned = self.0.get()?;
        let ring = owned.ring();
        // At most 64 sensors; their own t_delta where it was not said.
        Ok((0..ring.sensors() as u8).map(|sensor| ring.path_change_of(sensor).as_micros()).max().unwrap_or(0))
    }

    #[setter]
    fn set_path_change_us(&self, path_change_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let path_change = micros("path_change_us", path_change_us)?;
        self.0.get()?.change(|ring| ring.set_path_change(path_change))
    }

    /// R, how long sound is audible, in microseconds. It can be changed while the ring runs.
    #[getter]
    fn audible_us(&self) -> PyResult<u32> {
        Ok(self.0.get()?.ring().audible().as_micros())
    }

    #[setter]
    fn set_audible_us(&self, audible_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let audible = micros("audible_us", audible_us)?;
        self.0.get()?.change(|ring| ring.set_audible(audible))
    }

    /// Earliest time after its firing at which a reading without an echo is emitted, in microseconds: for modules that
    /// report by a bus or a pulse's width after their window has closed. 0: when it closes.
    #[getter]
    fn report_after_us(&self) -> PyResult<u32> {
        Ok(self.0.get()?.ring().report_after().as_micros())
    }

    #[setter]
    fn set_report_after_us(&self, report_after_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let report_after = micros("report_after_us", report_after_us)?;
        self.0.get()?.change(|ring| ring.set_report_after(report_after))
    }

    /// The firings to come, up to the end of the next period: for hardware that fires by itself.
    ///
    /// They hold until one is late, or the ring is changed. The loop may then come late: for each firing poll at its
    /// instant until there is no event, so that ``Fire`` says what is done already; hand in echoes; last poll at the
    /// present.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> [(fire.sensor, fire.due_us) for fire in ring.upcoming()[:4]]
    ///     [(0, 24000), (4, 24000), (8, 24000), (1, 49000)]
    fn upcoming(&self) -> PyResult<Vec<Fire>> {
        Ok(self.0.get()?.ring().upcoming().map(Fire::of).collect())
    }

    /// The number of sensors.
    #[getter]
    fn sensors(&self) -> PyResult<usize> {
        Ok(self.0.get()?.ring().sensors())
    }

    /// An edge on the echo line of a sensor. Edges may come in any order, at any time, wanted or not.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///     at_us: when, 0 or more.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor or time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> [ring.poll(24_000).sensor for _ in range(3)]  # one of each group of four
    ///     [0, 4, 8]
    ///     >>> ring.echo(0, 33_000)
    ///     >>> ring.poll(33_000).t_echo_us
    ///     9000
    #[pyo3(signature = (sensor, at_us))]
    fn echo(&self, sensor: &Bound<'_, PyAny>, at_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let (sensor, at) = (self.0.get()?.sensor(sensor)?, instant("at_us", at_us)?);
        self.0.get()?.change(|ring| ring.echo(sensor, at))
    }

    /// Corrects when a sensor last fired: by what a timer captured, for example. Optional: echo times count from then,
    /// and if it is later than the poll, all later firings move by as much.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///     at_us: when, 0 or more; a time that is not after the sensor's firing before is ignored.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor or time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> [ring.poll(24_000).sensor for _ in range(3)]  # one of each group of four
    ///     [0, 4, 8]
    ///     >>> ring.fired(0, 24_100)
    ///     >>> ring.echo(0, 33_000)
    ///     >>> ring.poll(33_000).t_echo_us
    ///     8900
    #[pyo3(signature = (sensor, at_us))]
    fn fired(&self, sensor: &Bound<'_, PyAny>, at_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let (sensor, at) = (self.0.get()?.sensor(sensor)?, instant("at_us", at_us)?);
        self.0.get()?.change(|ring| ring.fired(sensor, at))
    }

    /// The echo line of a sensor was already high when it was to fire: the firing just emitted counts as ``"stuck"``.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> [ring.poll(24_000).sensor for _ in range(3)]  # one of each group of four
    ///     [0, 4, 8]
    ///     >>> ring.stuck(0)
    ///     >>> while not isinstance(event := ring.poll(ring.next_deadline_us), eeruf.Reading):
    ///     ...     pass
    ///     >>> event.sensor, event.kind
    ///     (0, 'stuck')
    #[pyo3(signature = (sensor))]
    fn stuck(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.0.get()?.sensor(sensor)?;
        self.0.get()?.change(|ring| ring.stuck(sensor))
    }

    /// The state of the space before a sensor, at the time of the last poll.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Returns:
    ///     A ``State``: an obstacle, clear, too close, unanswered or unknown, for how long, and why.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.state(3)
    ///     State(kind='unknown', t_echo_us=None, age_us=0, why='no_firing', explained_by=None)
    #[pyo3(signature = (sensor))]
    fn state(&self, sensor: &Bound<'_, PyAny>) -> PyResult<State> {
        let sensor = self.0.get()?.sensor(sensor)?;
        let ring = self.0.get()?;
        Ok(State::of(&ring.watch, sensor, ring.now))
    }

    /// Hand in what hardware or a protocol measured of a sensor's last firing, before its reading is emitted: see
    /// ``report_after_us``.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///     t_echo_us: the echo time in microseconds, or None if it listened and heard nothing.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor or time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> [ring.poll(24_000).sensor for _ in range(3)]  # one of each group of four
    ///     [0, 4, 8]
    ///     >>> ring.measured(4, 9_000)
    ///     >>> ring.poll(40_000).t_echo_us
    ///     9000
    #[pyo3(signature = (sensor, t_echo_us))]
    fn measured(&self, sensor: &Bound<'_, PyAny>, t_echo_us: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let (sensor, t_echo) =
            (self.0.get()?.sensor(sensor)?, t_echo_us.map(|us| micros("t_echo_us", us)).transpose()?);
        self.0.get()?.change(|ring| ring.measured(sensor, t_echo))
    }

    /// Ask silence for a witness, from the next firing on: a firing without an echo is then ``"unanswered"``, which is
    /// never free space, unless :meth:`answered` or :meth:`measured` says that the sensor listened.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.expect_answers()
    ///     >>> while not isinstance(event := ring.poll(ring.next_deadline_us), eeruf.Reading):
    ///     ...     pass
    ///     >>> event.kind, ring.state(event.sensor).kind
    ///     ('unanswered', 'unanswered')
    #[expect(clippy::redundant_closure_for_method_calls, reason = "the method is of rings of one lifetime")]
    fn expect_answers(&self) -> PyResult<()> {
        self.0.get()?.with(|ring| ring.expect_answers());
        Ok(())
    }

    /// A sensor has shown that it listens for the echo of its last firing, such as by a line that rises.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///     answered: False takes that back: it was a disturbance.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.expect_answers()
    ///     >>> while not isinstance(event := ring.poll(ring.next_deadline_us), eeruf.Reading):
    ///     ...     if isinstance(event, eeruf.Fire):
    ///     ...         ring.answered(event.sensor)
    ///     >>> event.kind
    ///     'no_echo'
    #[pyo3(signature = (sensor, answered=None), text_signature = "($self, sensor, answered=True)")]
    fn answered(&self, sensor: &Bound<'_, PyAny>, answered: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let (sensor, answered) = (self.0.get()?.sensor(sensor)?, flag("answered", answered, true)?);
        self.0.get()?.change(|ring| if answered { ring.answered(sensor) } else { ring.unanswered(sensor) })
    }

    /// Forget what is known of a sensor's echo, so that its next reading is compared with nothing: the last one was not
    /// what it seemed.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.forget(3)
    #[pyo3(signature = (sensor))]
    fn forget(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.0.get()?.sensor(sensor)?;
        self.0.get()?.change(|ring| ring.forget(sensor))
    }

    /// Stop a sensor from firing. The reading of a firing that is under way is still emitted.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.disable(0)
    ///     >>> ring.is_enabled(0)
    ///     False
    #[pyo3(signature = (sensor))]
    fn disable(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.0.get()?.sensor(sensor)?;
        self.0.get()?.change(|ring| ring.disable(sensor))
    }

    /// Let a sensor fire again, from its next turn on. Its readings from before are forgotten.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.disable(0)
    ///     >>> ring.enable(0)
    ///     >>> ring.is_enabled(0)
    ///     True
    #[pyo3(signature = (sensor))]
    fn enable(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.0.get()?.sensor(sensor)?;
        self.0.get()?.change(|ring| ring.enable(sensor))
    }

    /// Returns true if a sensor fires.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.is_enabled(11)
    ///     True
    #[pyo3(signature = (sensor))]
    fn is_enabled(&self, sensor: &Bound<'_, PyAny>) -> PyResult<bool> {
        let sensor = self.0.get()?.sensor(sensor)?;
        Ok(self.0.get()?.ring().is_enabled(sensor))
    }

    /// Let no sensor fire until :meth:`resume`. Readings of firings under way are still emitted, and periods go on.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.pause()
    ///     >>> type(ring.poll(ring.next_deadline_us)).__name__
    ///     'PeriodEnded'
    #[expect(clippy::redundant_closure_for_method_calls, reason = "the method is of rings of one lifetime")]
    fn pause(&self) -> PyResult<()> {
        self.0.get()?.with(|ring| ring.pause());
        Ok(())
    }

    /// Let sensors fire again, as of the next period. Readings from before are forgotten.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.pause()
    ///     >>> ring.resume()
    ///     >>> _ = ring.poll(ring.next_deadline_us)  # the period ends
    ///     >>> type(ring.poll(ring.next_deadline_us)).__name__
    ///     'Fire'
    #[expect(clippy::redundant_closure_for_method_calls, reason = "the method is of rings of one lifetime")]
    fn resume(&self) -> PyResult<()> {
        self.0.get()?.with(|ring| ring.resume());
        Ok(())
    }

    /// Start again with phase a at a time, or as soon as the last firings allow: after a long sleep. Firings under way
    /// are dropped, and readings from before are forgotten.
    ///
    /// Args:
    ///     now_us: the present, 0 or more.
    ///
    /// Raises:
    ///     ArgumentError: not such a time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.restart(3_600_000_000)
    ///     >>> ring.wait_us(3_600_000_000)
    ///     24000
    #[pyo3(signature = (now_us))]
    fn restart(&self, now_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let now = instant("now_us", now_us)?;
        self.0.get()?.with(|ring| ring.restart(now));
        Ok(())
    }
}
