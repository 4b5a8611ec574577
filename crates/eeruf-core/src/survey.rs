//! [`Survey`]: a measuring run that finds which sensors of a ring hear each other, and how long the paths are.
//!
//! Time is divided into slots; earlier sound has died away before each. In a slot one sensor fires alone, or another
//! fires some time, the *lead*, after it. If an edge of the second comes earlier by as much as the lead grows, it is
//! sound of the first; its own echo does not move. So even a sensor that cannot listen without sending, such as an
//! HC-SR04, can be surveyed. Each ordered pair has every lead, so both directions are measured.

use crate::schedule::MAX_SENSORS;
use crate::time::{Instant, Micros};

/// The firings of a survey, and their times.
///
/// ```
/// use eeruf_core::{Micros, survey::SurveyPlan};
/// let plan = SurveyPlan::new(8);
/// assert!(plan.firings(0).eq([(0, Micros::ZERO)]));
/// assert!(plan.firings(plan.slots() - 1).eq([(7, Micros::ZERO), (6, Micros::new(19 * 750))]));
/// assert_eq!(plan.firings(plan.slots()).count(), 0);
/// assert_eq!(plan.duration_us(), 122_694_000); // two minutes
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SurveyPlan {
    sensors: u8,
    solos: u8,
    leads: u8,
    lead_step: Micros,
    window: Micros,
    quiet: Micros,
}

/// Longest time from the first poll to a survey's beginning; an instant further ahead is taken as past.
const FURTHEST_BEGINNING: Micros = Micros::from_millis(600_000);
/// Largest step back of a clock that is tolerated.
const STEP_BACK: Micros = Micros::from_millis(1000);
/// Longest time that a setting may have, in microseconds: ten seconds.
const LONGEST: u32 = 10_000_000;

impl SurveyPlan {
    /// A plan for at most 64 sensors: each fires alone three times, then each ordered pair with 20 leads in steps of
    /// 0.75 ms. Windows of 36 ms and 57 ms of silence make slots of 107.25 ms.
    pub const fn new(sensors: u8) -> Self {
        let sensors = if sensors as usize > MAX_SENSORS { MAX_SENSORS as u8 } else { sensors };
        let [lead_step, window, quiet] = [Micros::new(750), Micros::new(36_000), Micros::new(57_000)];
        Self { sensors, solos: 3, leads: 20, lead_step, window, quiet }
    }

    /// Sets how many times each sensor fires alone.
    #[must_use]
    pub const fn with_solos(self, solos: u8) -> Self {
        Self { solos, ..self }
    }

    /// Sets the number of leads of each ordered pair, from 0 on, and their step, at most ten seconds. A path shows at
    /// leads between its length minus the receiver's own echo and its length: at least two leads must lie there.
    #[must_use]
    pub const fn with_leads(self, leads: u8, lead_step: Micros) -> Self {
        Self { leads, lead_step: at_most_ten_seconds(lead_step), ..self }
    }

    /// Sets the listening time of a sensor, and the silence after it; at most ten seconds each.
    #[must_use]
    pub const fn with_window(self, window: Micros, quiet: Micros) -> Self {
        Self { window: at_most_ten_seconds(window), quiet: at_most_ten_seconds(quiet), ..self }
    }

    /// Number of sensors in the ring.
    pub const fn sensors(&self) -> u8 {
        self.sensors
    }

    /// Listening time of a sensor.
    pub const fn window(&self) -> Micros {
        self.window
    }

    /// Number of slots.
    pub const fn slots(&self) -> u32 {
        let sensors = self.sensors as u32;
        self.alone() + sensors * sensors.saturating_sub(1) * self.leads as u32
    }

    const fn alone(&self) -> u32 {
        self.sensors as u32 * self.solos as u32
    }

    /// Length of a slot.
    pub const fn slot_length(&self) -> Micros {
        let longest = self.lead(self.leads.saturating_sub(1));
        longest.saturating_add(self.window).saturating_add(self.quiet)
    }

    /// Length of the whole survey, in microseconds.
    pub const fn duration_us(&self) -> u64 {
        self.slots() as u64 * self.slot_length().as_micros() as u64
    }

    const fn lead(&self, number: u8) -> Micros {
        // 255 times ten seconds fits.
        Micros::new(self.lead_step.as_micros().saturating_mul(number as u32))
    }

    /// The firings of a slot, counted from 0: one or two sensors, and how long after the start of the slot each fires;
    /// none beyond the last slot.
    pub fn firings(&self, slot: u32) -> impl Iterator<Item = (u8, Micros)> + use<> {
        let (alone, sensors) = (self.alone(), u32::from(self.sensors));
        let (first, second) = if slot >= self.slots() {
            (None, None)
        } else if slot < alone {
            (Some((slot % sensors) as u8), None)
        } else {
            // Leads change slowest, so that a passing event does not affect one pair's successive leads.
            let others = sensors - 1;
            let (lead, pair) = ((slot - alone) / (sensors * others), (slot - alone) % (sensors * others));
            let (first, other) = ((pair / others) as u8, (pair % others) as u8);
            let second = if other >= first { other + 1 } else { other };
            (Some(first), Some((second, self.lead(lead as u8))))
        };
        first.map(|sensor| (sensor, Micros::ZERO)).into_iter().chain(second)
    }
}

const fn at_most_ten_seconds(time: Micros) -> Micros {
    if time.as_micros() > LONGEST { Micros::new(LONGEST) } else { time }
}

/// An event of a survey: a firing that it asks for, or a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SurveyEvent {
    /// Fire this sensor, now.
    Fire {
        /// The sensor, from 0.
        sensor: u8,
    },
    /// A line for the log.
    Row {
        /// The sensor, from 0.
        sensor: u8,
        /// Time of the firing.
        fired: Instant,
        /// The slot: the log's `period`.
        slot: u32,
        /// Time from firing to the first edge, if there was one within the window.
        t_echo: Option<Micros>,
    },
}

/// A sensor in a slot.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Listener {
    sensor: u8,
    /// Time of the firing; after that, the time when its window ends.
    due: Instant,
    fired: Option<Instant>,
    t_echo: Option<Micros>,
    is_logged: bool,
}

/// A survey in progress: the caller passes the time, fires the sensors asked for, reports edges and logs the rows.
///
/// ```
/// use eeruf_core::{Instant, Micros, survey::{Survey, SurveyEvent, SurveyPlan}};
/// let mut survey = Survey::new(SurveyPlan::new(2), Instant::from_micros(0));
/// let at = Instant::from_micros;
/// assert_eq!(survey.poll(at(0)), Some(SurveyEvent::Fire { sensor: 0 }));
/// survey.echo(0, at(5_800));
/// assert_eq!(survey.poll(at(5_900)), None);
/// let Some(SurveyEvent::Row { sensor, t_echo, .. }) = survey.poll(survey.next_deadline().unwrap()) else { panic!() };
/// assert_eq!((sensor, t_echo), (0, Some(Micros::new(5_800))));
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Survey {
    plan: SurveyPlan,
    slot: u32,
    begins: Instant,
    listeners: [Option<Listener>; 2],
}

impl Survey {
    /// A survey whose first slot begins at `begins`, at most ten minutes ahead of the first poll.
    pub fn new(plan: SurveyPlan, begins: Instant) -> Self {
        let mut survey = Self { plan, slot: 0, begins, listeners: [None; 2] };
        survey.enter_slot();
        survey
    }

    fn enter_slot(&mut self) {
        let begins = self.begins;
        let listener = |sensor, due| Listener { sensor, due, fired: None, t_echo: None, is_logged: false };
        let mut firings = self.plan.firings(self.slot).map(|(sensor, after)| listener(sensor, begins + after));
        self.listeners = [firings.next(), firings.next()];
    }

    /// Returns the next event; call again until there is none. A poll up to 70 minutes minus a slot late delays all
    /// later steps; a closed window keeps its edge.
    pub fn poll(&mut self, now: Instant) -> Option<SurveyEvent> {
        self.catch_up(now);
        let next = self.begins + self.plan.slot_length();
        let is_done = self.listeners.iter().flatten().all(|listener| listener.is_logged);
        if is_done && !self.is_over() && now.has_reached(next) {
            self.slot += 1;
            self.begins = next;
            self.enter_slot();
        }
        let due = self.listeners.iter().flatten().find(|it| it.fired.is_none() && now.has_reached(it.due));
        if let Some(&Listener { sensor, due, .. }) = due {
            self.fire(sensor, now, now.since(due));
            return Some(SurveyEvent::Fire { sensor });
        }
        let slot = self.slot;
        self.listeners.iter_mut().flatten().find_map(|listener| {
            let fired = listener.fired.filter(|_| !listener.is_logged && now.has_reached(listener.due))?;
            listener.is_logged = true;
            Some(SurveyEvent::Row { sensor: listener.sensor, fired, slot, t_echo: listener.t_echo })
        })
    }

    /// Handles a deadline further ahead than any planned one: it passed at least half a turn of the clock ago, or the
    /// clock has jumped. The next step is due now, and all later ones move with it.
    fn catch_up(&mut self, now: Instant) {
        let Some(deadline) = self.next_deadline() else { return };
        let has_begun = self.slot > 0 || self.listeners.iter().flatten().any(|listener| listener.fired.is_some());
        let furthest = if has_begun { self.plan.slot_length().saturating_add(STEP_BACK) } else { FURTHEST_BEGINNING };
        if now.has_reached(deadline) || deadline.since(now) <= furthest {
            return;
        }
        let late = now.since(deadline);
        self.begins += late;
        for listener in self.listeners.iter_mut().flatten() {
            listener.due += late;
        }
    }

    /// Notes a firing; if it is late, all later steps are delayed too.
    fn fire(&mut self, sensor: u8, now: Instant, late: Micros) {
        self.begins += late;
        for listener in self.listeners.iter_mut().flatten().filter(|listener| listener.fired.is_none()) {
            if listener.sensor == sensor {
                (listener.fired, listener.due) = (Some(now), now + self.plan.window);
            } else {
                listener.due += late;
            }
        }
    }

    /// Reports an edge of a sensor's line; only the first within its window counts.
    pub fn echo(&mut self, sensor: u8, at: Instant) {
        for listener in self.listeners.iter_mut().flatten().filter(|listener| listener.sensor == sensor) {
            let Some(fired) = listener.fired.filter(|_| listener.t_echo.is_none() && !listener.is_logged) else {
                continue;
            };
            let t_echo = at.since(fired);
            listener.t_echo = (t_echo < self.plan.window).then_some(t_echo);
        }
    }

    /// Returns the time of the next poll; `None` once the survey is over.
    pub fn next_deadline(&self) -> Option<Instant> {
        if self.is_over() {
            return None;
        }
        let pending = self.listeners.iter().flatten().filter(|listener| !listener.is_logged);
        let next = self.begins + self.plan.slot_length();
        // The whole slot lies within 2^31 us after its start.
        let all = pending.map(|listener| listener.due).chain([next]);
        all.min_by_key(|at| at.since(self.begins))
    }

    /// Returns true if all slots are over.
    pub fn is_over(&self) -> bool {
        self.slot >= self.plan.slots()
    }
}

#[cfg(test)]
mod tests;
