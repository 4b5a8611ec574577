//! [`Ring`]: plan and judge together, with what real sensors need: blanking, windows, stuck lines, late polls.
//!
//! The caller polls, fires the sensors that the ring asks for, reports the instants of echo edges, and sleeps until the
//! next deadline. Nothing here blocks, allocates, panics or reads a clock.

mod changes;
mod config;
mod events;
mod fired;
mod history;
mod listening;
mod punctuality;
mod sensor;
mod steps;

use crate::filter::EchoFilter;
use crate::judging::{Agreement, Heard, Judge, NoSounds};
use crate::own_limits::OwnLimits;
use crate::plan::{ImmediateRefiring, Plan, ScheduledFiring, Upcoming};
use crate::reading::{ReadingKind, Tally};
use crate::ring_error::RingError;
use crate::schedule::{MAX_SENSORS, Schedule};
use crate::sensor_error::SensorError;
use crate::time::{Instant, Micros};
use crate::verified::VerifiedSchedule;

pub(crate) use history::STEP_BACK;
use history::{Firings, long_before};
pub(crate) use listening::Listening;
use punctuality::Punctuality;
use sensor::{HELD, Noted, STUCK, Sensor, UNANSWERED};

pub use config::{RingConfig, Silence};
pub use events::{PeriodStats, Reading, RingEvent};

/// A ring of up to `K` sensors: the [`Plan`] `P` decides when each fires, and the [`Judge`] `J` which readings to
/// accept. `E` is the number of echoes that a sensor reports per firing.
///
/// With an [`EchoFilter`] a reading is accepted if it is near-identical to the previous one (Eq. 11) and no firing
/// explains both as crosstalk; if one does, the reading is [`Ambiguous`](ReadingKind::Ambiguous). The ring judges by
/// actual firings, not by the plan: late polls, pauses, restarts, changes of schedule and sensors that are disabled or
/// enabled may cost readings, but no single path of foreign sound that is audible for no longer than
/// [`RingConfig::audible`] and changes by no more than [`RingConfig::path_change`] is ever accepted. While it is on
/// time, a verified schedule has no ambiguous readings. `docs/explanation/theory.md` section 2.1 has the proof and its
/// limits.
///
/// `H` is the number of firings remembered of each sensor, 4 bytes each. A reading that sound of a forgotten firing
/// might explain is ambiguous too; four suffice if sound is audible for no longer than a period. A judge that compares
/// two readings does not compile with fewer than two:
///
/// ```compile_fail,E0080
/// # use eeruf_core::{Instant, Ring, RingConfig, plan::ScheduledFiring, tables::PAPER_12};
/// let now = Instant::from_micros(0);
/// let plan = ScheduledFiring::verified(&PAPER_12, now);
/// let mut ring = Ring::<_, _, 12, 1, 1>::remembering(plan, RingConfig::new(), now)?;
/// ring.poll(now);
/// # Ok::<(), eeruf_core::RingError>(())
/// ```
///
/// ```
/// use eeruf_core::{Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, tables::PAPER_12};
///
/// let mut ring = Ring::new(&PAPER_12, RingConfig::new(), Instant::from_micros(0))?;
/// let mut accepted = 0;
/// for _ in 0..1000 {
///     let now = ring.next_deadline(); // where firmware would sleep
///     while let Some(event) = ring.poll(now) {
///         match event {
///             RingEvent::Fire { sensor, .. } => ring.echo(sensor, now + Micros::from_millis(12))?, // a wall 2 m away
///             RingEvent::Reading(reading) => accepted += u32::from(reading.kind == ReadingKind::Accepted),
///             RingEvent::PeriodEnded(stats) => assert_eq!(stats.max_late, Micros::ZERO),
///         }
///     }
/// }
/// assert!(accepted > 400);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// In this order: a Cortex-M0 reaches only the first 124 bytes of a structure in one instruction, of single bytes 31.
// All before the sensors is whole words: else they are built on the stack and copied.
#[repr(C)]
pub struct Ring<P, J, const K: usize, const E: usize = 1, const H: usize = 4> {
    /// The sensor whose window closes first, or [`NOBODY`].
    oldest: u8,
    /// Number of sensors whose reading can be emitted before their window closes.
    ready: u8,
    /// The last sensor that became ready; it may have emitted its reading since.
    last_ready: u8,
    /// Number of sensors that listen.
    listening_now: u8,
    /// Time when the next reading can be emitted: when an edge came, or when the window of the oldest sensor closes.
    emit_at: Instant,
    listening: Listening,
    period: u32,
    plan: P,
    punctuality: Punctuality,
    /// Instant before which firings are unknown because the ring was restarted.
    known_from: Instant,
    /// Shortest time from a firing to a reading without an echo.
    report_after: Micros,
    sensors: [Sensor<E, H>; K],
    judge: J,
    tally: Tally<u8>,
}

/// A [`Ring`] with scheduled firing by a schedule of the paper's kind; `U` is `&`[`EachSensor`](crate::EachSensor) if
/// sensors have limits of their own.
pub type ScheduledRing<'s, const K: usize, const E: usize = 1, U = ()> =
    Ring<ScheduledFiring<'s, K, 2, U>, EchoFilter<K, E>, K, E>;

/// A [`Ring`] that accepts each reading that agrees with the previous one, even if foreign sound explains both: a
/// baseline. It accepts crosstalk that repeats, as with constant waits.
pub type AgreementRing<P, const K: usize, const E: usize = 1> = Ring<P, Agreement<EchoFilter<K, E>>, K, E, 1>;

const NOBODY: u8 = u8::MAX;

impl<'s, const K: usize, const M: usize, U: OwnLimits, const E: usize>
    Ring<ScheduledFiring<'s, K, M, U>, EchoFilter<K, E>, K, E>
{
    /// A ring with scheduled firing that begins at `now`. It uses the window and `t_delta` that the schedule was
    /// verified for, unless `config` asks for less. Sensors keep limits of their own, if they have them; `config` then
    /// sets upper limits for all.
    ///
    /// # Errors
    /// As for [`Ring::with_plan`].
    pub fn new<L: OwnLimits<Held<'s> = U>>(
        schedule: &'s VerifiedSchedule<K, M, L>,
        config: RingConfig<E>,
        now: Instant,
    ) -> Result<Self, RingError> {
        Self::with_plan(ScheduledFiring::verified(schedule, now), config, now)
    }
}

impl<'s, const K: usize, const M: usize, const E: usize> Ring<ScheduledFiring<'s, K, M>, EchoFilter<K, E>, K, E> {
    /// Makes a ring like [`new`](Ring::new), by a schedule that was not verified; `config` needs `t_delta` and window.
    /// It accepts no crosstalk either, but readings that crosstalk could explain are ambiguous: nearly all with
    /// constant waits.
    ///
    /// # Errors
    /// As for [`Ring::with_plan`].
    pub fn unverified(schedule: &'s Schedule<K, M>, config: RingConfig<E>, now: Instant) -> Result<Self, RingError> {
        Self::with_plan(ScheduledFiring::new(schedule, now), config, now)
    }
}

impl<'s, const K: usize, const M: usize, U: OwnLimits, J, const E: usize, const H: usize>
    Ring<ScheduledFiring<'s, K, M, U>, J, K, E, H>
{
    /// The schedule of the current period.
    pub const fn schedule(&self) -> &'s Schedule<K, M> {
        self.plan.schedule()
    }
}

impl<'s, const K: usize, const M: usize, const E: usize> Ring<ImmediateRefiring<'s, K, M>, EchoFilter<K, E>, K, E> {
    /// A ring with immediate refiring that begins at `now`; no sensor fires again sooner than `min_refire`. `config`
    /// needs `t_delta` and window, since nothing can be verified without a common period.
    ///
    /// # Errors
    /// As for [`Ring::with_plan`].
    pub fn immediate(
        schedule: &'s Schedule<K, M>,
        config: RingConfig<E>,
        min_refire: Micros,
        now: Instant,
    ) -> Result<Self, RingError> {
        Self::with_plan(ImmediateRefiring::new(schedule, min_refire, now), config, now)
    }
}

impl<P: Plan, const K: usize, const E: usize> Ring<P, EchoFilter<K, E>, K, E> {
    /// A ring with a plan of your own, which remembers four firings of each sensor. If its schedule was verified, the
    /// ring uses that window and `t_delta`, unless `config` asks for less.
    ///
    /// # Errors
    /// As for [`Ring::remembering`].
    pub fn with_plan(plan: P, config: RingConfig<E>, now: Instant) -> Result<Self, RingError> {
        Self::remembering(plan, config, now)
    }
}

impl<P: Plan, const K: usize, const E: usize, const H: usize> Ring<P, EchoFilter<K, E>, K, E, H> {
    /// Makes a ring like [`with_plan`](Ring::with_plan), with a memory of `H` firings of each sensor.
    ///
    /// # Errors
    /// As for [`Ring::judged_by`]; also if the number of consecutive readings is not 2 to 8, or if neither `config` nor
    /// the schedule gives `t_delta`.
    pub fn remembering(plan: P, config: RingConfig<E>, now: Instant) -> Result<Self, RingError> {
        let tolerance = config.tolerance(&plan)?;
        Self::judged_by(plan, EchoFilter::of(tolerance), config, now)
    }
}

impl<P: Plan, const K: usize, const E: usize> AgreementRing<P, K, E> {
    /// A baseline: a ring that accepts every reading that agrees with the previous one.
    ///
    /// # Errors
    /// As for [`Ring::remembering`].
    pub fn agreement_alone(plan: P, config: RingConfig<E>, now: Instant) -> Result<Self, RingError> {
        let tolerance = config.tolerance(&plan)?;
        Self::judged_by(plan, Agreement(EchoFilter::of(tolerance)), config, now)
    }
}

impl<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize> Ring<P, J, K, E, H> {
    /// Initial state, copied from flash: an array made at run time would first be built on the stack.
    const SENSORS: [Sensor<E, H>; K] = [Sensor::new(Instant::from_micros(0)); K];

    /// A ring in which nothing has fired. It assumes silence: the caller must wait until earlier sound has died away.
    #[inline(always)]
    pub(crate) const fn begin(plan: P, judge: J, listening: Listening, proven: bool, now: Instant) -> Self {
        let mut ring = Self {
            oldest: NOBODY,
            ready: 0,
            last_ready: NOBODY,
            listening_now: 0,
            tally: Tally::NONE,
            punctuality: Punctuality::new(proven),
            plan,
            judge,
            emit_at: now,
            listening,
            period: 0,
            known_from: long_before(now),
            report_after: Micros::ZERO,
            sensors: Self::SENSORS,
        };
        let none = Firings::none_before(now);
        let mut sensor = 0;
        while sensor < K {
            ring.sensors[sensor].firings = none;
            sensor += 1;
        }
        ring
    }

    /// A ring with a plan and a judge of your own, which remembers `H` firings of each sensor. The judge decides how
    /// readings are compared: of `config` only the listening settings are used.
    ///
    /// # Errors
    /// [`RingError`] if judge or `config` ask for more than the schedule was verified for, or `config` gives no window
    /// for an unverified one; if `K` is more than [`MAX_SENSORS`] or less than the plan's sensors; if a sensor would
    /// fire again while it still listens, if `t_delta` or blanking time are no shorter than the window or longer than
    /// 65,535 us, if a path may change by more than 65,534 us, or if sound is audible for longer than 67 s.
    #[inline(always)]
    pub fn judged_by(plan: P, judge: J, config: RingConfig<E>, now: Instant) -> Result<Self, RingError> {
        if K > MAX_SENSORS {
            return Err(RingError::Room { capacity: K });
        }
        if plan.sensors() > K {
            return Err(RingError::Sensors { sensors: plan.sensors(), capacity: K });
        }
        let listening = Listening::new(&config, judge.t_delta(), &plan)?;
        let proven = listening.is_proven(&plan);
        Ok(Self::begin(plan, judge, listening, proven, now))
    }

    /// The next event, if there is one at `now`. Call again until there is none, then sleep until
    /// [`next_deadline`](Self::next_deadline).
    ///
    /// Hand in the echo edges you know of before you poll: an edge that comes after the poll that closed its window is
    /// lost. A late poll loses nothing: firings that are due are postponed, and all later ones with them. If that
    /// shifts crosstalk so that it could explain a reading, the reading is [`Ambiguous`](ReadingKind::Ambiguous).
    /// [`PeriodStats`] says how late firings were.
    #[inline]
    pub fn poll(&mut self, now: Instant) -> Option<RingEvent> {
        self.poll_expecting(now, |_| 0)
    }

    /// Polls like [`poll`](Self::poll), for a robot that moves: `expected_change_us` returns the change in microseconds
    /// that a good reading of a sensor should show since its previous firing (see [`EchoFilter::push_echoes`]). If it
    /// is not 0, readings are checked for explanations even on time, and some readings of a fast robot are
    /// [`Ambiguous`](ReadingKind::Ambiguous). This accepts no more crosstalk, but does not permit higher speeds.
    ///
    /// [`EchoFilter::push_echoes`]: crate::EchoFilter::push_echoes
    #[inline]
    pub fn poll_expecting(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        if self.is_due(now) {
            return self.advance(now, expected_change_us);
        }
        if self.has_jumped(now) {
            self.clock_jumped(now);
        }
        None
    }

    /// Returns true if there may be an event.
    #[inline(always)]
    fn is_due(&self, now: Instant) -> bool {
        now.has_reached(self.plan.deadline()) || (self.has_pending() && now.has_reached(self.emit_at))
    }

    /// Returns true if the clock must have jumped, because the next step is too far ahead.
    #[inline(always)]
    fn has_jumped(&self, now: Instant) -> bool {
        self.plan.deadline().since(now) > self.plan.horizon()
    }

    /// Returns the time of the next poll; in the past if an event is pending.
    pub fn next_deadline(&self) -> Instant {
        let due = self.plan.deadline();
        if self.has_pending() && !self.emit_at.has_reached(due) { self.emit_at } else { due }
    }

    /// The upcoming firings in order, for hardware that fires by itself: a timer, PIO or RMT. They are valid until one
    /// is late or the ring is changed. With a table they reach to the end of the next period, otherwise to the end of
    /// the current one.
    ///
    /// The main loop may then run late. Replay what happened in order: for each firing, poll at its instant until there
    /// is no event ([`RingEvent::Fire`] then reports a firing that is already done) and report its echoes; finally poll
    /// at the current time. A firing that hardware has missed is then still due.
    ///
    /// ```
    /// use eeruf_core::{Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, tables::PAPER_12};
    ///
    /// let mut ring = Ring::new(&PAPER_12, RingConfig::new(), Instant::from_micros(0))?;
    /// let mut accepted = 0;
    /// for turn in 0..1000 {
    ///     let Some(timer) = ring.upcoming().next() else { break };
    ///     let now = timer.due + Micros::new(turn % 900); // when the loop comes round
    ///     for at in [timer.due, now] {
    ///         while let Some(event) = ring.poll(at) {
    ///             match event {
    ///                 // Fired by the timer; a capture unit reports a wall 2 m away.
    ///                 RingEvent::Fire { sensor, .. } => ring.measured(sensor, Some(Micros::from_millis(12)))?,
    ///                 RingEvent::Reading(reading) => accepted += u32::from(reading.kind == ReadingKind::Accepted),
    ///                 RingEvent::PeriodEnded(stats) => assert_eq!(stats.sum_late, Micros::ZERO),
    ///             }
    ///         }
    ///     }
    /// }
    /// assert!(accepted > 950);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn upcoming(&self) -> impl Iterator<Item = Upcoming> {
        self.plan.upcoming()
    }

    /// Returns true if a reading will be emitted without another firing.
    #[inline]
    fn has_pending(&self) -> bool {
        self.ready > 0 || self.oldest != NOBODY
    }

    /// Reports an edge on the echo line of a sensor, `at` this instant. The call is cheap; edges may come in any order,
    /// at any time and from any sensor.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    #[inline]
    pub fn echo(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError> {
        self.hear(sensor, at, Micros::ZERO, at)
    }

    /// Reports an edge like [`echo`](Self::echo) that came between two instants: the line was last seen without it at
    /// `earliest`, and with it at `latest`. The middle counts, with half the width as its uncertainty: foreign sound
    /// heard at any time in between explains the reading. If the uncertainty exceeds 300 us (5 cm), the reading is
    /// [`Late`](ReadingKind::Late), without echo time.
    ///
    /// # Errors
    /// [`RingError::Interval`] if `latest` is before `earliest`, [`RingError::Sensor`] for a sensor out of range.
    pub fn echo_between(&mut self, sensor: u8, earliest: Instant, latest: Instant) -> Result<(), RingError> {
        if !latest.has_reached(earliest) {
            let [earliest, latest] = [earliest, latest].map(Instant::as_micros);
            return Err(RingError::Interval { earliest, latest });
        }
        Ok(self.echo_within(sensor, earliest, latest.since(earliest), latest)?)
    }

    /// Reports an edge like [`echo_between`](Self::echo_between) that came up to `width` after `earliest`, for drivers
    /// that may take it back: its reading is emitted at `settled` or later, unless another sensor's reading is emitted
    /// first.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn echo_within(
        &mut self,
        sensor: u8,
        earliest: Instant,
        width: Micros,
        settled: Instant,
    ) -> Result<(), SensorError> {
        let before = width.as_micros() / 2;
        self.hear(sensor, earliest + Micros::new(before), Micros::new(width.as_micros() - before), settled)
    }

    /// Reports an edge like [`echo`](Self::echo), for drivers that may take it back: its reading is emitted at
    /// `settled` or later, unless another sensor's reading is emitted first.
    ///
    /// # Errors
    /// See [`echo`](Self::echo).
    #[inline]
    pub fn echo_until(&mut self, sensor: u8, at: Instant, settled: Instant) -> Result<(), SensorError> {
        self.hear(sensor, at, Micros::ZERO, settled)
    }

    #[inline]
    fn hear(&mut self, sensor: u8, at: Instant, off: Micros, settled: Instant) -> Result<(), SensorError> {
        let window = self.listening.window_of(&self.plan, sensor);
        let Some(heard) = self.sensors.get_mut(usize::from(sensor)) else {
            return self.no_such(sensor);
        };
        match heard.echo(at, off, self.listening.blanking(), window) {
            Noted::Ready => {
                if !self.has_pending() || !settled.has_reached(self.emit_at) {
                    self.emit_at = settled;
                }
                self.ready = self.ready.saturating_add(1);
                self.last_ready = sensor;
            }
            Noted::Late => self.tally.count(ReadingKind::Late),
            // An edge of a sensor that the ring has room for but does not have is an error too.
            Noted::Unwanted if usize::from(sensor) >= self.sensors() => return self.no_such(sensor),
            Noted::Stored | Noted::Unwanted => {}
        }
        Ok(())
    }

    /// Reports that the echo line of a sensor was already high when it was to fire: the firing just emitted counts as
    /// [`ReadingKind::Stuck`], whatever edges follow.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn stuck(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.sensor_mut(sensor)?.shows(STUCK);
        Ok(())
    }

    /// Sets the meaning of silence from the next firing on; initially [`Silence::NeverFree`].
    pub fn set_silence(&mut self, silence: Silence) {
        self.listening.set_silence(silence);
    }

    /// Reports that a sensor holds its line: the line rose after the trigger, or was still high, so that the sensor was
    /// not triggered. Its silence counts once [`answered`](Self::answered) reports that the line has fallen. Until then
    /// its readings repeat the judge's last verdict: [`Clear`](ReadingKind::Clear), or else
    /// [`NoEcho`](ReadingKind::NoEcho). They neither add to a run of silences nor break it.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn holds(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.sensor_mut(sensor)?.shows(HELD);
        Ok(())
    }

    /// Reports that a sensor has shown that it listened for the echo of its last firing. If its reading was emitted
    /// while it [held](Self::holds) its line, the judge learns of that silence now.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn answered(&mut self, sensor: u8) -> Result<(), SensorError> {
        if self.sensor_mut(sensor)?.answered() {
            self.judge_silence(sensor);
        }
        Ok(())
    }

    /// Gives the judge a silence whose reading was already emitted.
    #[cold]
    fn judge_silence(&mut self, sensor: u8) {
        let Some(own) = self.sensors.get(usize::from(sensor)) else { return };
        let firing = self.plan.last_firing(sensor, own.periods_ago(self.period));
        let t_delta = self.listening.t_delta_of(&self.plan, sensor);
        // The time since the firing before was counted with the reading.
        let heard = Heard { sensor, fired: own.fired(), since_before: Micros::ZERO, echoes: &[], firing, t_delta };
        let verdict = self.judge.judge(&heard, &NoSounds);
        self.plan.judged(&heard, &verdict, &self.judge);
    }

    /// Takes back [`answered`](Self::answered), if the answer turns out to be noise.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn unanswered(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.sensor_mut(sensor)?.shows(UNANSWERED);
        Ok(())
    }

    /// Reports a sensor's last result, measured by hardware or read over a protocol, before its reading is emitted: the
    /// echo time, or `None` if it listened and heard nothing. See [`set_report_after`](Self::set_report_after).
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn measured(&mut self, sensor: u8, t_echo: Option<Micros>) -> Result<(), SensorError> {
        let fired = self.sensor_mut(sensor)?.fired();
        match t_echo {
            Some(t_echo) => self.echo(sensor, fired + t_echo),
            None => self.answered(sensor),
        }
    }

    /// Reports a result like [`measured`](Self::measured), with an echo time between two limits: a pulse with uncertain
    /// edges, for example, lasts at least from the latest rise to the earliest fall, and at most from the earliest rise
    /// to the latest fall. See [`echo_between`](Self::echo_between).
    ///
    /// # Errors
    /// See [`echo_between`](Self::echo_between).
    pub fn measured_between(&mut self, sensor: u8, least: Micros, most: Micros) -> Result<(), RingError> {
        let fired = self.sensor_mut(sensor)?.fired();
        let Some(width) = most.checked_sub(least) else {
            let [earliest, latest] = [least, most].map(Micros::as_micros);
            return Err(RingError::Interval { earliest, latest });
        };
        Ok(self.echo_within(sensor, fired + least, width, fired + most)?)
    }

    /// Takes back a false echo of a sensor whose reading has not been emitted yet. See
    /// [`echo_until`](Self::echo_until).
    ///
    /// # Errors
    /// [`SensorError`] if the sensor is out of range.
    pub fn unheard(&mut self, sensor: u8) -> Result<(), SensorError> {
        if self.sensor_mut(sensor)?.unhear() {
            self.ready = self.ready.saturating_sub(1);
            self.emit_when_oldest_ends();
        }
        Ok(())
    }

    /// Forgets the readings of a sensor, so that its next one is compared with nothing: for a driver that learns that
    /// the last one was false. The age keeps counting.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn forget(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.sensor_mut(sensor)?;
        self.judge.forget(sensor);
        self.plan.forget(sensor);
        Ok(())
    }

    /// Returns true if a sensor is enabled, even while the ring is paused.
    pub fn is_enabled(&self, sensor: u8) -> bool {
        self.plan.is_enabled(sensor)
    }

    /// `T_delta`: the greatest difference between near-identical consecutive readings. If sensors have their own, the
    /// largest: see [`t_delta_of`](Self::t_delta_of).
    pub const fn t_delta(&self) -> Micros {
        self.listening.t_delta()
    }

    /// `T_delta` of one sensor.
    pub fn t_delta_of(&self, sensor: u8) -> Micros {
        self.listening.t_delta_of(&self.plan, sensor)
    }

    /// `T_wind`: how long a sensor listens after it has fired. If sensors have their own, the longest: see
    /// [`window_of`](Self::window_of).
    pub const fn window(&self) -> Micros {
        self.listening.window()
    }

    /// `T_wind` of one sensor.
    #[inline]
    pub fn window_of(&self, sensor: u8) -> Micros {
        self.listening.window_of(&self.plan, sensor)
    }

    /// P: the largest change of a foreign sound's path to a sensor from one of its readings to the next.
    pub fn path_change_of(&self, sensor: u8) -> Micros {
        self.listening.path_change_of(&self.plan, sensor)
    }

    /// R: how long sound is audible.
    pub const fn audible(&self) -> Micros {
        self.listening.audible()
    }

    /// Least time from a firing to a reading without an echo; 0 for the end of its window.
    pub const fn report_after(&self) -> Micros {
        self.report_after
    }

    /// Returns true while all firings audible in a sensor's last three readings kept a timetable that was verified for
    /// the ring's settings, so that crosstalk moves as (13a), (13b) say.
    pub const fn is_on_time(&self) -> bool {
        self.punctuality.is_on_time()
    }

    /// Deaf time of a sensor after it has fired.
    pub const fn blanking(&self) -> Micros {
        self.listening.blanking()
    }

    /// The number of sensors.
    pub fn sensors(&self) -> usize {
        self.plan.sensors()
    }

    /// Makes the error out of line, since it is rare and takes more instructions than the rest.
    #[cold]
    #[inline(never)]
    fn no_such(&self, sensor: u8) -> Result<(), SensorError> {
        Err(SensorError::new(sensor, self.sensors()))
    }

    #[inline]
    fn sensor_mut(&mut self, sensor: u8) -> Result<&mut Sensor<E, H>, SensorError> {
        let sensors = self.plan.sensors();
        match self.sensors.get_mut(usize::from(sensor)) {
            Some(found) if usize::from(sensor) < sensors => Ok(found),
            _ => Err(SensorError::new(sensor, sensors)),
        }
    }

    /// Returns the plan.
    pub const fn plan(&self) -> &P {
        &self.plan
    }

    /// The judge of the readings.
    pub const fn judge(&self) -> &J {
        &self.judge
    }

    /// Reports how fast the robot moves and turns; call it once per control cycle. A judge may let readings change by
    /// as much. After half a second without a call, the ring's top speed, if any, is assumed.
    pub fn moving(&mut self, speed_mm_s: u32, turn_mrad_s: u32, now: Instant) {
        self.judge.moving(speed_mm_s, turn_mrad_s, now);
        let due = self.plan.deadline();
        self.plan.set_pace(self.judge.pace());
        self.brought_forward(due, now);
    }

    /// Returns true if sensors have windows of their own, so that the one that fired first need not be the first to
    /// stop listening.
    #[inline]
    fn windows_differ(&self) -> bool {
        self.plan.limits_of(0).is_some()
    }

    /// Returns the time when a sensor last fired, as [`fired`](Self::fired) corrected it; if it has not fired yet, an
    /// instant too long ago to be heard. `None` for a sensor out of range.
    pub fn last_firing(&self, sensor: u8) -> Option<Instant> {
        let there = usize::from(sensor) < self.sensors();
        self.sensors.get(usize::from(sensor)).filter(|_| there).map(Sensor::fired)
    }

    /// Handles a jump of the clock.
    #[cold]
    fn clock_jumped(&mut self, now: Instant) {
        self.restart(now);
    }
}
