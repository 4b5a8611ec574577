//! [`replay_flow`]: judges a log of firings again, as a flow ring does.

use std::collections::VecDeque;

use eeruf_core::flow::{Belief, BeliefSettings};
use eeruf_core::judge::{Explanation, FiringContext, Judge as _};
use eeruf_core::plan::{OwnLimits, Plan, PlanLimits};
use eeruf_core::{
    EachSensor, Instant, MAX_SENSORS, Micros, Phase, Reading, ReadingKind, Ring, RingConfig, RingError, RingEvent,
    SensorLimits, Silence,
};

use crate::firings::{Firing, FiringLog};

/// Settings of the ring whose log is judged again.
#[derive(Clone, Copy, Debug)]
pub struct FlowSettings {
    /// The time for which sensors listen.
    pub window: Micros,
    /// The time for which sensors are deaf after firing.
    pub blanking: Micros,
    /// R: the time for which sound is heard, including its tail.
    pub audible: Micros,
    /// Settings of the judge.
    pub belief: BeliefSettings,
    /// Limits of each sensor, if they are not all alike.
    pub limits: EachSensor<MAX_SENSORS>,
}

/// A reading judged again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replayed {
    /// The outcome.
    pub kind: ReadingKind,
    /// The echo that is believed of its sensor from then on.
    pub believed: Option<Micros>,
    /// The explanation of an ambiguous reading.
    pub explained_by: Option<Explanation>,
}

/// Judges the readings of a log again as a flow ring does, from the actual firings. Returns one for each firing of the
/// log; `None` for late edges, which are not readings.
///
/// The readings' kinds supply information that the log lacks: whether silent sensors had shown that they listened, and
/// which lines were stuck. Earlier firings are unknown, and silence is assumed before the log.
///
/// # Errors
/// Settings that a ring refuses.
pub fn replay_flow(log: &FiringLog, settings: &FlowSettings) -> Result<Vec<Option<Replayed>>, RingError> {
    let mut replayed = vec![None; log.firings.len()];
    // An edge after the window is a row of its own.
    let is_late = |firing: &Firing| firing.reading == Some(ReadingKind::Late);
    let rows: Vec<_> = (0..log.firings.len()).filter(|&row| !is_late(&log.firings[row])).collect();
    // After such a pause, earlier firings no longer matter.
    let pauses = |two: &[usize]| log.firings[two[1]].fired_us - log.firings[two[0]].fired_us > 1 << 29;
    let mut from = 0;
    while from < rows.len() {
        let pause = rows[from..].windows(2).position(pauses);
        let to = pause.map_or(rows.len(), |pause| from + pause + 1);
        stretch(log, &rows[from..to], settings, &mut replayed)?;
        from = to;
    }
    Ok(replayed)
}

/// Judges a stretch without a long pause.
fn stretch(
    log: &FiringLog,
    rows: &[usize],
    settings: &FlowSettings,
    replayed: &mut [Option<Replayed>],
) -> Result<(), RingError> {
    let &FlowSettings { window, blanking, audible, belief, limits } = settings;
    let firing = |place: usize| &log.firings[rows[place]];
    let plan = Recorded {
        firings: rows.iter().map(|&row| (instant(log.firings[row].fired_us), log.firings[row].sensor)).collect(),
        periods: rows.iter().map(|&row| log.firings[row].period).collect(),
        next: 0,
        ended: false,
        sensors: log.sensors(),
        window,
        audible,
        limits,
    };
    let config = RingConfig::new().with_window(window).with_blanking(blanking).with_audible(audible);
    let config = config.with_path_change(belief.path_change);
    let begins = instant(firing(0).fired_us);
    let judge = Belief::<MAX_SENSORS>::new(belief)?;
    let mut ring = Ring::<_, _, MAX_SENSORS, 1, 3>::judged_by(plan, judge, config, begins)?;
    let silence = silence_of(log, belief.hold);
    ring.set_silence(silence);
    // The firings whose readings are awaited, by sensor, and the edges to come in order of time.
    let mut awaited = [None; MAX_SENSORS];
    let mut edges = VecDeque::<(i64, u8)>::new();
    let (mut next, mut now_us, last) = (0, firing(0).fired_us, firing(rows.len() - 1).fired_us);
    loop {
        let due = now_us + i64::from(ring.next_deadline().since(instant(now_us)).as_micros().cast_signed()).max(0);
        let edge = edges.front().map(|edge| edge.0);
        now_us = edge.map_or(due, |edge| edge.min(due));
        if next == rows.len() && (edges.is_empty() && awaited.iter().all(Option::is_none) || now_us > last + (1 << 29))
        {
            return Ok(());
        }
        let now = instant(now_us);
        while let Some((_, sensor)) = edges.pop_front_if(|edge| edge.0 <= now_us) {
            _ = ring.echo(sensor, now);
        }
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let of = firing(next);
                    awaited[usize::from(sensor)] = Some(rows[next]);
                    if let Some(echo) = of.t_echo_us {
                        let at = of.fired_us + i64::from(echo);
                        let place = edges.partition_point(|edge| edge.0 <= at);
                        edges.insert(place, (at, sensor));
                    }
                    told(&mut ring, of, silence, now);
                    next += 1;
                }
                RingEvent::Reading(Reading { sensor, kind, explained_by, .. }) => {
                    if let Some(row) = awaited[usize::from(sensor)].take() {
                        let believed = ring.judge().believed(sensor);
                        replayed[row] = Some(Replayed { kind, believed, explained_by });
                    }
                }
                RingEvent::PeriodEnded(_) => {}
            }
        }
    }
}

/// Reports to the ring what its caller did at this sensor's firing.
fn told(
    ring: &mut Ring<Recorded, Belief<MAX_SENSORS>, MAX_SENSORS, 1, 3>,
    of: &Firing,
    silence: Silence,
    now: Instant,
) {
    /// The factor `c / 2` of `v = g c / 2`, for v in mm/s and g in microseconds for each millisecond, as in logs.
    const MM_S: f32 = 171.5;
    if let Some(g) = of.g_us_ms {
        ring.moving((g * MM_S).round() as u32, 0, now);
    }
    // The ring has the sensor: it has just fired it.
    if of.reading == Some(ReadingKind::Stuck) {
        _ = ring.stuck(of.sensor);
    } else if silence == Silence::NeedsAnswer && of.reading != Some(ReadingKind::Unanswered) {
        _ = ring.answered(of.sensor);
    }
}

/// The ring's meaning of silence, from its readings: silence needs an answer if one was ever missing; it is never free
/// space if a sensor was silent more often in a row than a belief holds and nothing was ever clear.
fn silence_of(log: &FiringLog, hold: u8) -> Silence {
    let has = |kind| log.firings.iter().any(|firing| firing.reading == Some(kind));
    if has(ReadingKind::Unanswered) {
        return Silence::NeedsAnswer;
    }
    let mut silent = [0_u32; MAX_SENSORS];
    let mut longest = 0;
    for firing in &log.firings {
        let silent = &mut silent[usize::from(firing.sensor)];
        *silent = if firing.reading == Some(ReadingKind::NoEcho) { *silent + 1 } else { 0 };
        longest = longest.max(*silent);
    }
    let is_never_free = !has(ReadingKind::Clear) && longest > u32::from(hold) + 1;
    if is_never_free { Silence::NeverFree } else { Silence::Trusted }
}

/// An instant of a ring's clock, which wraps.
fn instant(us: i64) -> Instant {
    Instant::from_micros(us as u32)
}

/// A plan that repeats recorded firings.
#[derive(Debug)]
struct Recorded {
    /// Instants and sensors of the firings.
    firings: Vec<(Instant, u8)>,
    periods: Vec<u32>,
    next: usize,
    /// True if the period before that of the next firing has ended.
    ended: bool,
    sensors: usize,
    window: Micros,
    audible: Micros,
    limits: EachSensor<MAX_SENSORS>,
}

/// The horizon of the replay: half of the 71 minutes in which its clock wraps.
const ANY: Micros = Micros::new(1 << 31);

impl Recorded {
    fn begins_period(&self) -> bool {
        self.next > 0 && self.periods.get(self.next).is_some_and(|&period| period != self.periods[self.next - 1])
    }
}

impl Plan for Recorded {
    fn deadline(&self) -> Instant {
        let last = || self.firings.last().map_or(Instant::default(), |&(at, _)| at);
        // After the last firing, the period does not end within reach.
        self.firings.get(self.next).map_or_else(|| last() + Micros::new(1 << 30), |&(at, _)| at)
    }

    fn next_firing(&self) -> Option<(u8, Phase)> {
        let fires = self.ended || !self.begins_period();
        self.firings.get(self.next).filter(|_| fires).map(|&(_, sensor)| (sensor, Phase::A))
    }

    fn fire(&mut self, _: Instant) {
        (self.next, self.ended) = (self.next + 1, false);
    }

    fn postpone(&mut self, _: u8, _: Micros) {}

    fn end_period(&mut self, _: Instant) -> (Phase, bool) {
        self.ended = true;
        (Phase::A, false)
    }

    fn ended(&mut self, _: u8, _: Instant) {}

    fn sensors(&self) -> usize {
        self.sensors
    }

    fn set_enabled(&mut self, _: u8, _: bool) {}

    fn set_paused(&mut self, _: bool) {}

    fn is_enabled(&self, _: u8) -> bool {
        true
    }

    fn restart(&mut self, _: Instant) {}

    fn last_firing(&self, _: u8, _: u8) -> FiringContext {
        FiringContext::new(Phase::A)
    }

    fn limits(&self) -> PlanLimits<'_> {
        PlanLimits { longest_window: self.window, verified_for: None, audible: Some(self.audible) }
    }

    fn hears(&self, receiver: u8, emitter: u8) -> bool {
        OwnLimits::hears(&self.limits, receiver, emitter)
    }

    fn limits_of(&self, sensor: u8) -> Option<SensorLimits> {
        OwnLimits::limits_of(&self.limits, sensor)
    }

    fn min_refire(&self) -> Micros {
        self.window
    }

    fn horizon(&self) -> Micros {
        ANY
    }
}
