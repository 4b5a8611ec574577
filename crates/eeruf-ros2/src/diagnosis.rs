//! Faults of each sensor, of the line and of the timing, which `diagnostic_msgs/DiagnosticArray` reports once per
//! second. Times are in seconds of any one clock.

use eeruf_core::{
    Instant, MAX_SENSORS, Micros, PeriodStats, Phase, Reading, ReadingKind, RingEvent, Tally,
    judge::Explanation,
    watch::{Doubt, SensorState, SensorWatch},
};

use crate::parameters::{Parameters, Source};
use crate::range::Scale;
use crate::view::View;

/// Severity, numbered as in `DiagnosticStatus`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub(crate) enum Level {
    Ok = 0,
    Warn = 1,
    Error = 2,
}

/// State of one subject of the report.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Status {
    pub(crate) level: Level,
    /// The name: `sensor 3`, `serial line`, `timing`.
    pub(crate) about: String,
    pub(crate) message: String,
    pub(crate) values: Vec<(&'static str, String)>,
}

/// Descriptions of the health of a sensor's line, numbered as `eeruf_hc_sr04::Health`.
const HEALTH: [&str; 6] = [
    "well",
    "missing: nothing comes from its line",
    "stuck line: high when it was to be triggered",
    "chatters: several pulses follow one trigger",
    "loses edges on the way",
    "pin error",
];

/// Missing sensor, stuck line and pin error: the sensor's readings do not count.
const BROKEN: [u8; 3] = [1, 2, 5];

struct Sensor {
    heard_at_s: f64,
    health: u8,
    echoes_since_accepted: u32,
    tally: Tally,
    last: Option<(ReadingKind, Option<Micros>)>,
}

/// Counts since the last report.
#[derive(Default)]
struct Interval {
    firings: u32,
    damaged: u32,
    lost: u32,
    max_late: Micros,
    edges_lost: u32,
    unsent: u32,
}

pub(crate) struct Diagnosis {
    sensors: Vec<Sensor>,
    watch: SensorWatch<MAX_SENSORS>,
    /// The kind of connection to the ring, if it is a board or pins.
    line: Option<&'static str>,
    late_us: u32,
    blind_after: u32,
    silent_after_s: f64,
    interval: Interval,
    /// Reason why the line is not open; `None` once it is.
    pub(crate) line_lost: Option<String>,
    /// Reason why intact frames cannot be used.
    pub(crate) foreign: Option<String>,
    /// The number of sensors that the board reports.
    pub(crate) board_sensors: Option<u8>,
    /// The board's last period, and its count of lost edges then, which wraps.
    counted: Option<(u32, u8)>,
    total_edges_lost: u64,
    total_damaged: u64,
    total_lost: u64,
}

impl Diagnosis {
    pub(crate) fn new(parameters: &Parameters, now_s: f64) -> Self {
        let sensor =
            |_| Sensor { heard_at_s: now_s, health: 0, echoes_since_accepted: 0, tally: Tally::default(), last: None };
        Self {
            sensors: (0..parameters.sensors).map(sensor).collect(),
            watch: SensorWatch::new(0, instant(now_s)),
            line: match parameters.source {
                Source::Serial => Some("serial line"),
                Source::Gpio => Some("GPIO lines"),
                Source::Simulation => None,
            },
            late_us: parameters.late_us,
            blind_after: parameters.blind_after,
            silent_after_s: parameters.silent_after_s,
            interval: Interval::default(),
            line_lost: Some("not yet open".to_owned()),
            foreign: None,
            board_sensors: None,
            counted: None,
            total_edges_lost: 0,
            total_damaged: 0,
            total_lost: 0,
        }
    }

    /// Counts a reading of a sensor: how late it fired, and what explains it if it is ambiguous.
    pub(crate) fn reading(
        &mut self,
        now_s: f64,
        sensor: u8,
        kind: ReadingKind,
        t_echo: Option<Micros>,
        late: Micros,
        explained_by: Option<Explanation>,
    ) {
        self.interval.firings += 1;
        self.interval.max_late = self.interval.max_late.max(late);
        let (phase, period, previous, age) = (Phase::A, 0, None, None);
        let reading = Reading { sensor, phase, period, kind, t_echo, previous, age, explained_by };
        self.watch.observe(&RingEvent::Reading(reading), instant(now_s));
        let Some(sensor) = self.sensors.get_mut(usize::from(sensor)) else { return };
        sensor.heard_at_s = now_s;
        sensor.tally.count(kind);
        sensor.last = Some((kind, t_echo));
        match kind {
            ReadingKind::Accepted | ReadingKind::Clear => sensor.echoes_since_accepted = 0,
            ReadingKind::First | ReadingKind::Rejected | ReadingKind::Repeated | ReadingKind::Ambiguous => {
                sensor.echoes_since_accepted = sensor.echoes_since_accepted.saturating_add(1);
            }
            _ => {}
        }
    }

    /// Counts the board's frame at a period's end.
    pub(crate) fn period(&mut self, period: u32, max_late: Micros, edges_lost: u8, health: &[u8]) {
        self.interval.max_late = self.interval.max_late.max(max_late);
        let more = match self.counted.replace((period, edges_lost)) {
            // Losses from before this program listened are not news.
            None => 0,
            Some((before, counted)) if before < period => edges_lost.wrapping_sub(counted),
            // The board has started again.
            Some(_) => edges_lost,
        };
        self.interval.edges_lost += u32::from(more);
        self.total_edges_lost += u64::from(more);
        for (sensor, &health) in self.sensors.iter_mut().zip(health) {
            sensor.health = health;
        }
    }

    /// Counts a damaged frame.
    pub(crate) fn damaged(&mut self) {
        self.interval.damaged += 1;
        self.total_damaged += 1;
    }

    /// Counts frames that are missing between two that arrived.
    pub(crate) fn lost(&mut self, frames: u16) {
        self.interval.lost = self.interval.lost.saturating_add(frames.into());
        self.total_lost += u64::from(frames);
    }

    /// Counts a message that could not be sent.
    pub(crate) fn unsent(&mut self) {
        self.interval.unsent += 1;
    }

    /// The view of each sensor, and its age. A sensor that no longer fires, or whose line the board reports as broken,
    /// counts as unanswered.
    pub(crate) fn views<'a>(&'a self, now_s: f64, scale: &'a Scale) -> impl Iterator<Item = (View, Micros)> + 'a {
        (0..).zip(&self.sensors).map(move |(number, sensor)| {
            let state = self.watch.state(number, instant(now_s));
            let (view, age) = state.map_or((View::Unknown, Micros::ZERO), |state| View::of(state, scale));
            let is_silent = now_s - sensor.heard_at_s > self.silent_after_s;
            (if is_silent || BROKEN.contains(&sensor.health) { View::Unanswered } else { view }, age)
        })
    }

    /// Reports the state of everything, and begins the next interval.
    pub(crate) fn report(&mut self, now_s: f64) -> Vec<Status> {
        let interval = std::mem::take(&mut self.interval);
        // Keeps ages within the range of the watch's 32-bit clock.
        let (zero, tally) = (Micros::ZERO, Tally::default());
        let second = PeriodStats { period: 0, phase: Phase::A, tally, max_late: zero, sum_late: zero };
        self.watch.observe(&RingEvent::PeriodEnded(second), instant(now_s));
        let mut report = Vec::new();
        report.extend(self.line.map(|about| self.line(about, &interval)));
        report.push(self.timing(&interval));
        let sensors = (0..).zip(&self.sensors).map(|(number, sensor)| self.sensor(now_s, number, sensor));
        report.extend(sensors);
        self.foreign = None;
        report
    }

    fn line(&self, about: &str, interval: &Interval) -> Status {
        let Interval { damaged, lost, .. } = *interval;
        let wrong_number = self.board_sensors.filter(|&sensors| usize::from(sensors) != self.sensors.len());
        let (level, message) = if let Some(why) = &self.line_lost {
            (Level::Error, format!("closed: {why}"))
        } else if let Some(why) = &self.foreign {
            (Level::Error, why.clone())
        } else if let Some(sensors) = wrong_number {
            let expected = self.sensors.len();
            (Level::Error, format!("the board has {sensors} sensors; the parameter sensors says {expected}"))
        } else if damaged + lost > 0 {
            (Level::Warn, format!("dropped frames: {lost} missing, {damaged} damaged"))
        } else if interval.firings == 0 {
            (Level::Error, "silent: no firing arrives".to_owned())
        } else {
            (Level::Ok, "well".to_owned())
        };
        let values = vec![
            ("firings since the last report", interval.firings.to_string()),
            ("frames missing, in all", self.total_lost.to_string()),
            ("frames damaged, in all", self.total_damaged.to_string()),
            ("messages not sent since the last report", interval.unsent.to_string()),
        ];
        Status { level, about: about.to_owned(), message, values }
    }

    fn timing(&self, interval: &Interval) -> Status {
        let late = interval.max_late.as_micros();
        let (level, message) = if late > self.late_us {
            (Level::Warn, format!("late: a firing came {late} us after it was due; more than {} us", self.late_us))
        } else if interval.edges_lost > 0 {
            (Level::Warn, "the board loses edges: its queue was full".to_owned())
        } else {
            (Level::Ok, "well".to_owned())
        };
        let values = vec![
            ("latest firing since the last report, us", late.to_string()),
            ("edges that the board lost, in all", self.total_edges_lost.to_string()),
        ];
        Status { level, about: "timing".to_owned(), message, values }
    }

    fn sensor(&self, now_s: f64, number: u8, sensor: &Sensor) -> Status {
        let silent_s = now_s - sensor.heard_at_s;
        let last = sensor.last.map(|(kind, _)| kind);
        let (state, age) = self.watch.state(number, instant(now_s)).map_or_else(|_| Default::default(), said);
        let (level, message) = if silent_s > self.silent_after_s {
            (Level::Error, format!("silent: no firing of it for {silent_s:.1} s"))
        } else if sensor.health != 0 {
            (Level::Error, HEALTH.get(usize::from(sensor.health)).copied().unwrap_or("unwell").to_owned())
        } else if last == Some(ReadingKind::Stuck) {
            (Level::Error, HEALTH[2].to_owned())
        } else if last == Some(ReadingKind::Unanswered) {
            (Level::Error, "unanswered: its last firing left no sign that it listened".to_owned())
        } else if sensor.echoes_since_accepted >= self.blind_after {
            (Level::Warn, format!("blind: none of its last {} echoes was accepted", sensor.echoes_since_accepted))
        } else {
            (Level::Ok, state.clone())
        };
        let of = |kind| sensor.tally.of(kind).to_string();
        let (last, t_echo) = sensor.last.map_or((String::new(), None), |(kind, t_echo)| (kind.to_string(), t_echo));
        let values = vec![
            ("state", state),
            ("state's age, s", format!("{:.1}", f64::from(age.as_micros()) / 1e6)),
            ("accepted", of(ReadingKind::Accepted)),
            ("rejected", of(ReadingKind::Rejected)),
            ("ambiguous", of(ReadingKind::Ambiguous)),
            ("clear", of(ReadingKind::Clear)),
            ("too early", of(ReadingKind::TooEarly)),
            ("stuck", of(ReadingKind::Stuck)),
            ("unanswered", of(ReadingKind::Unanswered)),
            ("last reading", last),
            ("last echo time, us", t_echo.map(|t_echo| t_echo.as_micros().to_string()).unwrap_or_default()),
        ];
        Status { level, about: format!("sensor {}", number + 1), message, values }
    }
}

/// Seconds by the watch's clock, which wraps.
fn instant(now_s: f64) -> Instant {
    Instant::from_micros((now_s * 1e6) as u64 as u32)
}

/// Returns the words for a state and its age.
fn said(state: SensorState) -> (String, Micros) {
    match state {
        SensorState::Obstacle { t_echo, age } => (format!("obstacle, echo after {} us", t_echo.as_micros()), age),
        SensorState::Clear { age } => ("clear".to_owned(), age),
        SensorState::TooClose { age } => ("too close".to_owned(), age),
        SensorState::Unanswered { since } => ("unanswered".to_owned(), since),
        SensorState::Unknown { since, why } => {
            let why = match why {
                Doubt::NoFiring => "no firing".to_owned(),
                Doubt::Rejected => "rejected".to_owned(),
                Doubt::NoWitness => "no witness".to_owned(),
                Doubt::Ambiguous(Explanation::Sensor(by)) => format!("ambiguous, explained by sensor {}", by + 1),
                Doubt::Ambiguous(_) => "ambiguous".to_owned(),
                _ => "unsure".to_owned(),
            };
            (format!("unknown: {why}"), since)
        }
        _ => ("unknown".to_owned(), Micros::ZERO),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::range::Distance;

    fn diagnosis() -> Diagnosis {
        let parameters = Parameters { sensors: 2, blind_after: 3, late_us: 1_000, ..Parameters::default() };
        let mut diagnosis = Diagnosis::new(&parameters, 0.0);
        diagnosis.line_lost = None;
        diagnosis.board_sensors = Some(2);
        diagnosis
    }

    fn both(diagnosis: &mut Diagnosis, now_s: f64, kind: ReadingKind) {
        for sensor in 0..2 {
            diagnosis.reading(now_s, sensor, kind, Some(Micros::new(9_000)), Micros::ZERO, None);
        }
    }

    /// Returns level and first word of each status: line, timing, two sensors.
    fn said(diagnosis: &mut Diagnosis, now_s: f64) -> Vec<(Level, String)> {
        let report = diagnosis.report(now_s);
        assert_eq!(report.len(), 4);
        let word = |status: &Status| status.message.split([' ', ':']).next().unwrap_or_default().to_owned();
        report.iter().map(|status| (status.level, word(status))).collect()
    }

    fn well() -> (Level, String) {
        (Level::Ok, "well".to_owned())
    }

    /// Level and message of a sensor that sees something.
    fn sees() -> (Level, String) {
        (Level::Ok, "obstacle,".to_owned())
    }

    #[test]
    fn a_ring_that_is_well_is_said_to_be_well() {
        let mut diagnosis = diagnosis();
        both(&mut diagnosis, 0.5, ReadingKind::Accepted);
        assert_eq!(said(&mut diagnosis, 1.0), [well(), well(), sees(), sees()]);
    }

    // Each fault is named while it lasts, and no longer.
    #[test]
    fn fault_is_named_while_it_lasts() {
        type Fault = fn(&mut Diagnosis);
        let faults: [(usize, Level, &str, Fault); 9] = [
            (0, Level::Error, "closed", |diagnosis| diagnosis.line_lost = Some("unplugged".to_owned())),
            (0, Level::Error, "version", |diagnosis| diagnosis.foreign = Some("version 2".to_owned())),
            (0, Level::Error, "the", |diagnosis| diagnosis.board_sensors = Some(9)),
            (0, Level::Warn, "dropped", |diagnosis| diagnosis.lost(3)),
            (0, Level::Warn, "dropped", Diagnosis::damaged),
            (1, Level::Warn, "late", |diagnosis| diagnosis.period(1, Micros::new(1_001), 9, &[0, 0])),
            (1, Level::Warn, "the", |diagnosis| diagnosis.period(1, Micros::ZERO, 10, &[0, 0])),
            (2, Level::Error, "stuck", |diagnosis| diagnosis.period(1, Micros::ZERO, 9, &[2, 0])),
            (3, Level::Error, "missing", |diagnosis| diagnosis.period(1, Micros::ZERO, 9, &[0, 1])),
        ];
        for (place, level, word, fault) in faults {
            let mut diagnosis = diagnosis();
            both(&mut diagnosis, 0.5, ReadingKind::Accepted);
            diagnosis.period(0, Micros::ZERO, 9, &[0, 0]);
            fault(&mut diagnosis);
            let mut expected = [well(), well(), sees(), sees()];
            expected[place] = (level, word.to_owned());
            assert_eq!(said(&mut diagnosis, 1.0), expected);
            both(&mut diagnosis, 1.5, ReadingKind::Accepted);
            diagnosis.line_lost = None;
            diagnosis.board_sensors = Some(2);
            let counted = diagnosis.counted.map_or(0, |(_, edges_lost)| edges_lost);
            diagnosis.period(2, Micros::ZERO, counted, &[0, 0]);
            assert_eq!(said(&mut diagnosis, 2.0), [well(), well(), sees(), sees()], "after {word}");
        }
    }

    #[test]
    fn state_ages_until_confirmed_or_lost() {
        let mut diagnosis = diagnosis();
        let mut state = |readings: &[(f64, ReadingKind)], now_s: f64| {
            for &(at_s, kind) in readings {
                let by = (kind == ReadingKind::Ambiguous).then_some(Explanation::Sensor(1));
                diagnosis.reading(at_s, 0, kind, Some(Micros::new(9_000)), Micros::ZERO, by);
            }
            let report = diagnosis.report(now_s);
            let value = |name| report[2].values.iter().find(|(key, _)| *key == name).unwrap().1.clone();
            (value("state"), value("state's age, s"))
        };
        let said = |state: &str, age: &str| (state.to_owned(), age.to_owned());
        assert_eq!(state(&[], 1.0), said("unknown: no firing", "1.0"));
        let seen = [(1.1, ReadingKind::Accepted), (1.2, ReadingKind::Ambiguous)];
        assert_eq!(state(&seen, 2.0), said("obstacle, echo after 9000 us", "0.9"));
        let lost = [(2.5, ReadingKind::Ambiguous)];
        assert_eq!(state(&lost, 3.0), said("unknown: ambiguous, explained by sensor 2", "0.5"));
        assert_eq!(state(&[(3.5, ReadingKind::Clear)], 4.0), said("clear", "0.5"));
        // By a 32-bit clock an hour and a half looks like less than twenty minutes.
        for minute in 1..90 {
            state(&[], 4.0 + 60.0 * f64::from(minute));
        }
        assert_eq!(state(&[], 5404.0), said("clear", "2147.5"));
        assert_eq!(state(&[(5404.5, ReadingKind::Unanswered)], 5405.0), said("unanswered", "0.5"));
    }

    // The board's count wraps, and starts from 0 with the board.
    #[test]
    fn lost_edges_are_counted_past_256_and_a_restart() {
        let mut diagnosis = diagnosis();
        let frames = [(7, 250, 0), (8, 250, 0), (9, 3, 9), (10, 2, 264), (0, 0, 264), (1, 5, 269), (0, 4, 273)];
        for (period, edges_lost, total) in frames {
            diagnosis.period(period, Micros::ZERO, edges_lost, &[0, 0]);
            assert_eq!(diagnosis.total_edges_lost, total, "period {period}");
        }
    }

    #[test]
    fn broken_or_silent_sensor_is_unanswered() {
        let mut diagnosis = diagnosis();
        let scale = Scale::new(&Parameters::default());
        let views =
            |diagnosis: &Diagnosis, now_s| diagnosis.views(now_s, &scale).map(|(view, _)| view).collect::<Vec<_>>();
        both(&mut diagnosis, 0.5, ReadingKind::Clear);
        let clear = View::Sees(Distance::Clear);
        assert_eq!(views(&diagnosis, 1.0), [clear, clear]);
        for (health, expected) in [(1, View::Unanswered), (2, View::Unanswered), (5, View::Unanswered), (3, clear)] {
            diagnosis.period(0, Micros::ZERO, 0, &[health, 0]);
            assert_eq!(views(&diagnosis, 1.0), [expected, clear], "health {health}");
        }
        diagnosis.reading(1.4, 1, ReadingKind::Unanswered, None, Micros::ZERO, None);
        assert_eq!(views(&diagnosis, 1.5), [clear, View::Unanswered]);
        assert_eq!(views(&diagnosis, 1.6)[0], View::Unanswered);
    }

    // A sensor is blind if its echoes are not accepted, and silent if it does not fire.
    #[test]
    fn blind_and_silent_sensors_are_reported() {
        let mut diagnosis = diagnosis();
        for _ in 0..3 {
            diagnosis.reading(0.5, 1, ReadingKind::NoEcho, None, Micros::ZERO, None);
        }
        for kind in [ReadingKind::First, ReadingKind::Rejected, ReadingKind::Ambiguous] {
            diagnosis.reading(0.5, 0, kind, Some(Micros::new(9_000)), Micros::ZERO, None);
        }
        assert_eq!(
            said(&mut diagnosis, 1.0)[2..],
            [(Level::Warn, "blind".to_owned()), (Level::Ok, "unknown".to_owned())]
        );
        both(&mut diagnosis, 1.0, ReadingKind::Accepted);
        assert_eq!(said(&mut diagnosis, 1.5)[2..], [sees(), sees()]);
        diagnosis.reading(2.4, 1, ReadingKind::Stuck, None, Micros::ZERO, None);
        let (silent, stuck) = ((Level::Error, "silent".to_owned()), (Level::Error, "stuck".to_owned()));
        assert_eq!(said(&mut diagnosis, 2.5), [well(), well(), silent.clone(), stuck]);
        diagnosis.reading(2.6, 1, ReadingKind::Unanswered, None, Micros::ZERO, None);
        let unanswered = (Level::Error, "unanswered".to_owned());
        assert_eq!(said(&mut diagnosis, 2.7), [well(), well(), silent.clone(), unanswered]);
        assert_eq!(said(&mut diagnosis, 9.0), [silent.clone(), well(), silent.clone(), silent]);
    }
}
