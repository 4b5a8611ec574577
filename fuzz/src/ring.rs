//! The ring compared with a slow and obvious model of its documented promises.
//!
//! The [`Model`] keeps true time in 64 bits, while the ring sees a counter that wraps. For each sensor it knows the
//! firing in progress with its edges, and the echoes of earlier firings. It does not know when the ring will emit
//! something, only what it may emit:
//!
//! - only enabled sensors fire, no sooner after the previous firing than in the schedule, and on time if the ring was
//!   polled on time;
//! - after a restart or a change of schedule, no two sensors fire closer together than the previous schedule allowed;
//! - each firing gives one reading, with the sensor's own phase, period and echo, before that sensor fires again and as
//!   soon as it is known;
//! - a late edge gives at most one more reading;
//! - accepted echoes were heard in the required number of consecutive firings, and no firings of any sensor explain two
//!   of them as foreign sound; an ambiguous reading is explained by the sensor that it names; if nothing disturbed the
//!   comparison, no other kind is possible;
//! - a firing later than its poll delays all later firings, and its echo times count from the later instant;
//! - no sensor fires while the ring is paused; impossible listening settings, and only those, are refused;
//! - counts, ages and periods increase one by one, and the ring never falls silent.

mod model;

use arbitrary::Arbitrary;
use eeruf_core::{Instant, Micros, Ring, RingConfig, RingEvent, Schedule, ScheduledRing, Silence};

pub(crate) use self::model::{Echo, Lines, explain, instant};
use self::model::{Listening, Model};

/// Sensors of the ring.
pub const SENSORS: usize = 5;

/// Random input.
#[derive(Arbitrary, Debug)]
pub struct Input {
    /// Reading of the clock at the start; large values make it wrap soon.
    pub start: u32,
    pub tables: [Table; 2],
    pub t_delta: u16,
    pub window: u16,
    pub blanking: u8,
    pub consecutive: u8,
    pub steps: Vec<Step>,
}

/// A schedule: the period in units of 256 us, and firing times in fractions of it.
#[derive(Arbitrary, Debug)]
pub struct Table {
    pub period: u16,
    pub fire: [[u8; SENSORS]; 2],
}

/// An event for the ring.
#[derive(Arbitrary, Debug)]
pub enum Step {
    /// Sleep until the next deadline, then this many microseconds more, and poll.
    Sleep {
        late: Option<u16>,
    },
    /// Let this time pass, in units of 64 us, and poll; deadlines may be missed.
    Pass(u16),
    /// Let a minute or two pass.
    PassLong(u8),
    /// An edge seen this many microseconds ago, which may have come sooner; it can be taken back for a while.
    Edge {
        sensor: u8,
        ago: u16,
        width: u16,
        settles: Option<u16>,
    },
    /// A value that a module reports for its last firing; see `t_echo_of`.
    Measured {
        sensor: u8,
        t_echo: u16,
        width: u16,
    },
    Answered(u8, bool),
    Holds(u8),
    Silence(u8),
    Unheard(u8),
    Forget(u8),
    /// Poll while odometry expects this change of every reading.
    Expecting(i16),
    Moving(u16),
    PathChange(u16),
    Audible(u16),
    ReportAfter(u16),
    Stuck(u8),
    Disable(u8),
    Enable(u8),
    Restart,
    Change(bool),
    /// Report that the last firing came this many microseconds after its poll; the clock has moved on.
    Fired(u8),
    Pause,
    Resume,
    TDelta(u16),
    Window(u16),
    Blanking(u8),
}

fn table(table: &Table) -> Option<Schedule<SENSORS>> {
    let period = 256 * (u32::from(table.period % 1024) + 4);
    let fire = table.fire.map(|fire| fire.map(|part| Micros::new(period / 256 * u32::from(part))));
    Schedule::from_firing(Micros::new(period), fire).ok()
}

/// The time in 64 bits of an instant that is not far from `now`.
pub(crate) fn time_of(instant_: Instant, now: u64) -> u64 {
    let ahead = instant_.as_micros().wrapping_sub(now as u32) as i32;
    now.saturating_add_signed(ahead.into())
}

/// Runs all steps on the ring and the model.
pub fn check(input: &Input) {
    let (Some(first), Some(second)) = (table(&input.tables[0]), table(&input.tables[1])) else { return };
    let [t_delta, window, blanking] =
        [input.t_delta.into(), input.window.into(), 16 * u32::from(input.blanking)].map(Micros::new);
    let config = RingConfig::new().with_t_delta(t_delta).with_window(window).with_blanking(blanking);
    let config = config.with_consecutive(2 + input.consecutive % 3);
    let mut now = (1 << 32) + u64::from(input.start);
    let Ok(mut ring) = Ring::unverified(&first, config, instant(now)) else { return };
    ring.set_silence(Silence::Trusted);
    let begin = now;
    let mut model = Model {
        lines: Lines::new(now, Silence::Trusted),
        listening: Listening {
            t_delta,
            window,
            blanking,
            consecutive: usize::from(config.consecutive),
            path_change: ring.path_change_of(0),
            audible: ring.audible(),
            report_after: ring.report_after(),
        },
        enabled: [true; SENSORS],
        schedule: &first,
        next_schedule: None,
        period: 0,
        since: 0,
        phase: 0,
        last: None,
        last_sensor: None,
        paused: false,
        epoch: 0,
        before: None,
        on_time: true,
        quiet_periods: 0,
    };
    let mut expected = 0;
    for step in input.steps.iter().take(400) {
        let known = |sensor: &u8| usize::from(*sensor) < SENSORS;
        model.lines.now = now;
        if model.lines.hand_in(&mut ring, step) {
            (model.listening.path_change, model.listening.audible) = (ring.path_change_of(0), ring.audible());
            if let Step::Answered(sensor, true) = step
                && known(sensor)
            {
                model.answered((*sensor).into());
            }
            continue;
        }
        match step {
            Step::Sleep { late } => {
                let deadline = time_of(ring.next_deadline(), now).max(now);
                now = deadline + u64::from(late.unwrap_or(0));
            }
            Step::Pass(units) => now += 64 * u64::from(*units),
            // Firings are forgotten when they are 18 minutes old.
            Step::PassLong(units) if now - begin < 1 << 29 => now += u64::from(*units) << 20,
            Step::PassLong(_) => {}
            Step::Forget(sensor) => {
                assert_eq!(ring.forget(*sensor).is_ok(), known(sensor));
                if known(sensor) {
                    let forgotten = &mut model.lines.sensors[usize::from(*sensor)];
                    forgotten.heard.clear();
                    forgotten.undisturbed = 0;
                }
                continue;
            }
            Step::Expecting(change) => expected = (*change).into(),
            Step::ReportAfter(us) => {
                let _ = ring.set_report_after(Micros::new((*us).into()));
                model.listening.report_after = ring.report_after();
            }
            Step::Disable(sensor) => {
                assert_eq!(ring.disable(*sensor).is_ok(), known(sensor));
                if known(sensor) {
                    model.enabled[usize::from(*sensor)] = false;
                    model.on_time = false;
                }
                continue;
            }
            Step::Enable(sensor) => {
                assert_eq!(ring.enable(*sensor).is_ok(), known(sensor));
                if known(sensor) {
                    let x = usize::from(*sensor);
                    if !model.enabled[x] {
                        model.lines.sensors[x].heard.clear();
                        model.lines.sensors[x].undisturbed = 0;
                    }
                    model.enabled[x] = true;
                }
                continue;
            }
            Step::Restart => {
                ring.restart(instant(now));
                let same = model.schedule;
                model.new_epoch(same);
                model.phase = 0;
                model.lines.drop_firings();
                model.lines.sensors.iter_mut().for_each(|sensor| sensor.heard.clear());
                continue;
            }
            Step::Change(which) => {
                let schedule = if *which { &second } else { &first };
                let done = match t_delta.as_micros() % 2 {
                    0 => ring.change_to_unverified(schedule),
                    _ => ring.change_to(schedule, ()),
                };
                if done.is_ok() {
                    model.next_schedule = Some(schedule);
                } else {
                    assert!(model.listening.window > schedule.min_refire(), "refused without cause");
                }
                continue;
            }
            Step::Fired(later) => {
                // Only if the last firing came with this poll, and nothing was heard or reported yet.
                let Some(x) = model.last_sensor else { continue };
                if model.last.is_none_or(|last| last.at != now) || !model.lines.sensors[x].is_silent() {
                    continue;
                }
                now += u64::from(*later);
                ring.fired(x as u8, instant(now)).expect("a sensor that there is");
                model.fired_at(x, now);
            }
            Step::Pause | Step::Resume => {
                let pauses = matches!(step, Step::Pause);
                if pauses {
                    ring.pause()
                } else {
                    ring.resume()
                }
                model.pause(pauses);
                continue;
            }
            Step::TDelta(us) => {
                let t_delta = Micros::new((*us).into());
                let done = ring.set_t_delta(t_delta).is_ok();
                let changed = Listening { t_delta, path_change: ring.path_change_of(0), ..model.listening };
                model.listen(done, changed);
                continue;
            }
            Step::Window(us) => {
                let window = Micros::new((*us).into());
                let changed = Listening { window, ..model.listening };
                let done = ring.set_window(window).is_ok();
                model.listen(done, changed);
                // An open window may be closed by now.
            }
            Step::Blanking(units) => {
                let blanking = Micros::new(16 * u32::from(*units));
                let changed = Listening { blanking, ..model.listening };
                let done = ring.set_blanking(blanking).is_ok();
                model.listen(done, changed);
                continue;
            }
            _ => unreachable!("handed in above"),
        }
        model.lines.now = now;
        drain(&mut ring, &mut model, expected);
    }
}

/// Polls until nothing is left to do or to report.
fn drain(ring: &mut ScheduledRing<'_, SENSORS>, model: &mut Model<'_>, expected: i32) {
    let now = model.lines.now;
    for turn in 0.. {
        assert!(turn < 1000, "the ring never comes to rest");
        let deadline = time_of(ring.next_deadline(), now);
        model.on_time &= deadline >= now;
        assert!(!ring.is_on_time(), "by a table that was not verified");
        assert_eq!((ring.t_delta(), ring.window()), (model.listening.t_delta, model.listening.window));
        let Some(event) = ring.poll_expecting(instant(now), |_| expected) else { break };
        match event {
            RingEvent::Fire { sensor, .. } => model.fired(sensor, deadline),
            RingEvent::Reading(reading) => model.emitted(&reading, expected),
            RingEvent::PeriodEnded(stats) => model.ended(&stats),
        }
    }
    model.drained();
    let deadline = time_of(ring.next_deadline(), now);
    assert!(deadline > now, "a deadline in the past, and nothing to do");
    let longest = 3 * u64::from(model.schedule.period().as_micros().max(longest_before(model)));
    assert!(deadline - now <= longest, "silent for {} us", deadline - now);
    for x in 0..SENSORS as u8 {
        assert_eq!(ring.is_enabled(x), model.enabled[usize::from(x)]);
    }
}

fn longest_before(model: &Model<'_>) -> u32 {
    model.before.map_or(0, |before| before.period().as_micros())
}
