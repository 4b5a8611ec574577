//! Hardware in the loop: the protocol between board and host.
//!
//! The board runs a ring of eight HC-SR04 sensors as it would run on a robot; the host plays the echo lines. They
//! exchange [`Record`]s over two pipes, in lock step. The board reports everything that goes into its ring and
//! everything that comes out: each edge, each poll, each read of a pin, each event. It waits for an answer only when it
//! has triggered a sensor: the time of an emulated board stands still meanwhile. The answer lists all edges to come on
//! any line ([`Ahead`]) that are known by then; it replaces the previous answer, since the sound of a later firing may
//! be heard first.
//!
//! The host, the binary of this crate, feeds the same inputs to a ring of its own (the reference) and compares the
//! outputs word by word.
#![no_std]

use eeruf_core::{
    Edge, Instant, Micros, Reading, Requirements, RingConfig, RingError, RingEvent, Schedule, VerifiedSchedule,
    flow::{BeliefSettings, FlowRing, TurnSettings},
    judge::Explanation,
};
use eeruf_hc_sr04::Health;

/// Number of sensors: as many as in `scenes/alcove-hc-sr04.toml`.
pub const SENSORS: usize = 8;

/// The paper's Table I-d for the first eight of its twelve sensors, verified for the largest `t_delta` that it allows,
/// so that the ring knows how late firings may be.
pub const SCHEDULE: VerifiedSchedule<SENSORS> = {
    let ms = Micros::from_millis;
    let lag = [ms(0), ms(25), ms(50), ms(75), ms(0), ms(25), ms(50), ms(75)];
    let wait_b = [ms(18), ms(12), ms(6), ms(0), ms(20), ms(14), ms(8), ms(2)];
    // Only ever evaluated when this crate is compiled.
    let Ok(schedule) = Schedule::new(ms(100), lag, [[ms(24); SENSORS], wait_b]) else { panic!("not a schedule") };
    match schedule.verified(&Requirements::new(Micros::new(999))) {
        Ok(verified) => verified,
        Err(_) => panic!("not a schedule for 999 us"),
    }
};

/// Settings of the ring: those of `scenes/alcove-hc-sr04.toml`, with a window for the longest pulse and its delay.
pub const CONFIG: RingConfig = RingConfig::new().with_t_delta(Micros::new(500)).with_window(Micros::from_millis(40));

/// Makes a flow ring of the same sensors.
///
/// # Errors
/// None with these numbers.
pub fn flow_ring(now: Instant) -> Result<FlowRing<SENSORS>, RingError> {
    FlowRing::flow(SENSORS, TurnSettings::new(1), BeliefSettings::DEFAULT, CONFIG, now)
}

/// The host's first message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orders {
    /// The board's clock at the start.
    pub start: Instant,
    /// Number of periods to run.
    pub periods: u32,
    /// The period, counted from 0, after which the main loop stalls.
    pub stall_after: u32,
    /// Duration of the stall; zero for none.
    pub stall: Micros,
}

impl Orders {
    /// Converts to words.
    pub const fn to_words(self) -> [u32; 4] {
        [self.start.as_micros(), self.periods, self.stall_after, self.stall.as_micros()]
    }

    /// Converts from words.
    pub const fn from_words([start, periods, stall_after, stall]: [u32; 4]) -> Self {
        Self { start: Instant::from_micros(start), periods, stall_after, stall: Micros::new(stall) }
    }
}

/// Largest number of edges in an answer, an arbitrary choice; the host refuses a run that needs more.
pub const MOST_AHEAD: usize = 48;

/// A coming edge on an echo line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ahead {
    /// The edge, with its time.
    pub edge: Edge,
    /// True if the line changes without an interrupt.
    pub lost: bool,
}

impl Ahead {
    /// Converts to two words.
    pub const fn to_words(self) -> [u32; 2] {
        let Edge { sensor, high, at } = self.edge;
        [sensor as u32 | (high as u32) << 8 | (self.lost as u32) << 9, at.as_micros()]
    }

    /// Converts from two words.
    pub const fn from_words([what, at]: [u32; 2]) -> Self {
        let edge = Edge { sensor: what as u8, high: what & 1 << 8 != 0, at: Instant::from_micros(at) };
        Self { edge, lost: what & 1 << 9 != 0 }
    }
}

/// A message of the board.
///
/// Six words: the kind with the sensor, and five more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Record(pub [u32; 6]);

/// The subject of a [`Record`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Topic {
    /// The ring gets an edge.
    Edge,
    /// The ring is polled.
    Poll,
    /// The driver reads an echo line before it triggers.
    Level,
    /// A trigger pin has fallen: the sensor sends its sound. The board waits for the answer.
    Trigger,
    /// The event that the poll returned, or none.
    Event,
    /// Time until which the board sleeps.
    Deadline,
    /// The health of the sensors at a period's end, and the number of edges lost to a full queue.
    State,
}

impl Topic {
    const ALL: [Self; 7] =
        [Self::Edge, Self::Poll, Self::Level, Self::Trigger, Self::Event, Self::Deadline, Self::State];
}

const NONE: u32 = u32::MAX;

impl Record {
    /// The length in bytes.
    pub const BYTES: usize = 24;

    /// Returns the bytes on the pipe: little-endian words.
    pub fn to_bytes(self) -> [u8; Self::BYTES] {
        let mut bytes = [0; Self::BYTES];
        for (place, word) in bytes.chunks_exact_mut(4).zip(self.0) {
            place.copy_from_slice(&word.to_le_bytes());
        }
        bytes
    }

    const fn new(topic: Topic, sensor: u8, flag: u8, rest: [u32; 5]) -> Self {
        let [a, b, c, d, e] = rest;
        Self([topic as u32 | (sensor as u32) << 8 | (flag as u32) << 16, a, b, c, d, e])
    }

    const fn at(topic: Topic, sensor: u8, flag: u8, at: Instant) -> Self {
        Self::new(topic, sensor, flag, [at.as_micros(), 0, 0, 0, 0])
    }

    /// Makes the record of an edge.
    pub const fn edge(edge: Edge) -> Self {
        Self::at(Topic::Edge, edge.sensor, edge.high as u8, edge.at)
    }

    /// Makes the record of a poll.
    pub const fn poll(now: Instant) -> Self {
        Self::at(Topic::Poll, 0, 0, now)
    }

    /// Makes the record of a read of an echo line.
    pub const fn level(sensor: u8, high: bool) -> Self {
        Self::new(Topic::Level, sensor, high as u8, [0; 5])
    }

    /// Makes the record of the end of a trigger pulse.
    pub const fn trigger(sensor: u8, at: Instant) -> Self {
        Self::at(Topic::Trigger, sensor, 0, at)
    }

    /// Makes the record of the time until which the board sleeps.
    pub const fn deadline(at: Instant) -> Self {
        Self::at(Topic::Deadline, 0, 0, at)
    }

    /// Makes the record of a poll's event, or of none.
    pub fn event(event: Option<&RingEvent>) -> Self {
        match event {
            None => Self::new(Topic::Event, 0, 0, [0; 5]),
            Some(&RingEvent::Fire { sensor, phase, due }) => {
                Self::new(Topic::Event, sensor, 1, [phase.0.into(), due.as_micros(), 0, 0, 0])
            }
            Some(&RingEvent::Reading(Reading { sensor, phase, period, kind, t_echo, previous, age, explained_by })) => {
                let us = |time: Option<Micros>| time.map_or(NONE, Micros::as_micros);
                let by = match explained_by {
                    None => 0xFF,
                    Some(Explanation::Sensor(sensor)) => u32::from(sensor),
                    Some(Explanation::History) => 0xFE,
                };
                let kind = kind as u32 | u32::from(phase.0) << 8 | by << 16;
                let age = age.map_or(NONE, u32::from);
                Self::new(Topic::Event, sensor, 2, [kind, period, us(t_echo), us(previous), age])
            }
            Some(RingEvent::PeriodEnded(stats)) => {
                // Five bits for each count, of about eight readings per period.
                let counts = eeruf_core::ReadingKind::ALL.iter();
                let counts = counts.fold(0_u64, |sum, &kind| (sum << 5) + u64::from(stats.tally.of(kind)));
                let [low, high] = [counts as u32, (counts >> 32) as u32];
                // Each of the two is at most 65,535 us.
                let late = stats.max_late.as_micros() << 16 | u32::from(stats.phase.0);
                Self::new(Topic::Event, 0, 3, [late, stats.period, stats.sum_late.as_micros(), low, high])
            }
        }
    }

    /// Makes the record of the sensors' health and the number of edges lost to a full queue.
    pub fn state(health: [Health; SENSORS], edges_lost: u8) -> Self {
        let code = health.iter().fold(0, |sum, &health| sum << 4 | health as u32);
        Self::new(Topic::State, 0, edges_lost, [code, 0, 0, 0, 0])
    }

    /// Returns the subject, if any.
    pub fn topic(self) -> Option<Topic> {
        Topic::ALL.get(usize::from(self.0[0] as u8)).copied()
    }

    /// The sensor of the record.
    pub const fn sensor(self) -> u8 {
        (self.0[0] >> 8) as u8
    }

    /// Returns a level or direction, a kind of event, or a count.
    pub const fn flag(self) -> u8 {
        (self.0[0] >> 16) as u8
    }

    /// Returns the instant of a record that has one.
    pub const fn instant(self) -> Instant {
        Instant::from_micros(self.0[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eeruf_core::{PeriodStats, Phase, ReadingKind, Tally, judge::Explanation};

    #[test]
    fn what_the_host_says_arrives_as_it_was_said() {
        let orders =
            Orders { start: Instant::from_micros(7), periods: 8, stall_after: 9, stall: Micros::from_millis(50) };
        assert_eq!(Orders::from_words(orders.to_words()), orders);
        for (sensor, high, lost) in [(0, false, true), (7, true, false), (255, true, true)] {
            let ahead = Ahead { edge: Edge { sensor, high, at: Instant::from_micros(u32::MAX) }, lost };
            assert_eq!(Ahead::from_words(ahead.to_words()), ahead);
        }
    }

    #[test]
    fn readings_that_differ_in_anything_are_different_records() {
        let reading = Reading {
            sensor: 3,
            phase: Phase::A,
            period: 5,
            kind: ReadingKind::Accepted,
            t_echo: Some(Micros::new(4000)),
            previous: Some(Micros::new(4001)),
            age: Some(0),
            explained_by: None,
        };
        let record = |reading| Record::event(Some(&RingEvent::Reading(reading)));
        assert_eq!(record(reading), record(reading));
        for other in [
            Reading { sensor: 2, ..reading },
            Reading { phase: Phase::B, ..reading },
            Reading { period: 6, ..reading },
            Reading { kind: ReadingKind::Rejected, ..reading },
            Reading { t_echo: Some(Micros::new(4002)), ..reading },
            Reading { t_echo: None, ..reading },
            Reading { previous: None, ..reading },
            Reading { age: None, ..reading },
            Reading { explained_by: Some(Explanation::Sensor(0)), ..reading },
            Reading { explained_by: Some(Explanation::History), ..reading },
        ] {
            assert_ne!(record(other), record(reading), "{other:?}");
        }
    }

    #[test]
    fn period_ends_that_differ_in_any_count_are_different_records() {
        let stats = PeriodStats {
            period: 1,
            phase: Phase::A,
            tally: Tally::default(),
            max_late: Micros::ZERO,
            sum_late: Micros::ZERO,
        };
        let record = |stats| Record::event(Some(&RingEvent::PeriodEnded(stats)));
        for kind in ReadingKind::ALL {
            let mut other = stats;
            other.tally.count(kind);
            assert_ne!(record(other), record(stats), "{kind}");
        }
        for late in
            [PeriodStats { max_late: Micros::new(1), ..stats }, PeriodStats { sum_late: Micros::new(1), ..stats }]
        {
            assert_ne!(record(late), record(stats), "{late:?}");
        }
    }

    #[test]
    fn every_record_says_what_it_is_about() {
        for topic in Topic::ALL {
            let record = Record::new(topic, 9, 1, [0; 5]);
            assert_eq!((record.topic(), record.sensor(), record.flag()), (Some(topic), 9, 1));
        }
        assert_eq!(Record([99; 6]).topic(), None);
        let bytes = Record::poll(Instant::from_micros(0x0403_0201)).to_bytes();
        assert_eq!(bytes[..9], [Topic::Poll as u8, 0, 0, 0, 1, 2, 3, 4, 0]);
    }
}

/// Doctest of the project's README, here because published crates cannot include that file.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
