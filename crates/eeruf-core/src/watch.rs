//! [`SensorWatch`]: the known state of the space in front of each sensor, its age, and blind sensors.

use crate::reading::{Explanation, ReadingKind};
use crate::ring::{Reading, RingEvent, STEP_BACK};
use crate::sensor_error::SensorError;
use crate::time::{Instant, Micros};

/// Watches the events of a ring of up to `K` sensors: it tracks what is known of the space in front of each, and
/// reports sensors whose echoes are never accepted. It takes 16 bytes per sensor, plus eight.
///
/// ```
/// use eeruf_core::{
///     Instant, Micros, Ring, RingConfig, RingEvent, tables::PAPER_12, watch::{SensorState, SensorWatch},
/// };
/// let mut now = Instant::from_micros(0);
/// let mut ring = Ring::new(&PAPER_12, RingConfig::new(), now)?;
/// let mut watch = SensorWatch::<12>::new(20, now);
/// for _ in 0..100 {
///     now = ring.next_deadline();
///     while let Some(event) = ring.poll(now) {
///         if let RingEvent::Fire { sensor, .. } = event {
///             ring.echo(sensor, now + Micros::from_millis(9))?;
///         }
///         if let Some(blind) = watch.observe(&event, now) {
///             panic!("nothing accepted of sensor {} for 20 echoes", blind + 1);
///         }
///     }
/// }
/// match watch.state(3, now)? {
///     SensorState::Obstacle { t_echo, age } => {
///         assert!(t_echo == Micros::from_millis(9) && age < Micros::from_millis(130));
///     }
///     SensorState::Clear { .. } => { /* nothing is in range: drive on */ }
///     _ => { /* not known: slow down */ }
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SensorWatch<const K: usize> {
    sensors: [Watched; K],
    blind_after: u8,
    /// The instant of the last event.
    seen: Instant,
}

/// The state of the space in front of a sensor. Times stop at 2,147,483,648 us (36 minutes).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SensorState {
    /// An obstacle, from an accepted or a tentative echo. One reading that does not confirm it only lets its age grow;
    /// two in a row end it.
    Obstacle {
        /// The echo time.
        t_echo: Micros,
        /// Time since the last confirmation.
        age: Micros,
    },
    /// Nothing is in range: silence was confirmed. Any echo ends this state.
    Clear {
        /// Time since silence was last confirmed.
        age: Micros,
    },
    /// Something is closer than the sensor can measure.
    TooClose {
        /// Time since the object was last seen.
        age: Micros,
    },
    /// The sensor does not answer, or its line is stuck.
    Unanswered {
        /// Time without an answer.
        since: Micros,
    },
    /// Nothing is known.
    Unknown {
        /// The time for which nothing has been known.
        since: Micros,
        /// The latest reason.
        why: Doubt,
    },
}

/// Reason why nothing is known of the space in front of a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Doubt {
    /// The sensor has not fired yet.
    NoFiring,
    /// One echo or one silence that is not confirmed yet.
    Unsure,
    /// Silence again without a witness: the sensor has not shown that it listens.
    NoWitness,
    /// The last two echoes differ.
    Rejected,
    /// The last two echoes agree, and sound of another firing explains both.
    Ambiguous(Explanation),
}

#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Watched {
    known: Known,
    /// The instant of the last confirmation, or the beginning of the current state.
    at: Instant,
    /// True if the last reading did not confirm the state.
    doubted: bool,
    /// True if the last reading was [`ReadingKind::NoEcho`].
    silent: bool,
    /// Number of firings with an echo since a reading was last accepted or clear.
    echoes: u8,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Known {
    Obstacle(Micros),
    Clear,
    TooClose,
    Unanswered,
    Nothing(Doubt),
}

/// Half a turn of the clock.
const LONGEST: Micros = Micros::new(1 << 31);

impl<const K: usize> SensorWatch<K> {
    /// A watch that begins at `now` and knows nothing. A sensor counts as blind after `blind_after` firings with an
    /// echo, 1 to 255, but no accepted reading; 0 turns this off.
    pub const fn new(blind_after: u8, now: Instant) -> Self {
        let nothing =
            Watched { known: Known::Nothing(Doubt::NoFiring), at: now, doubted: false, silent: false, echoes: 0 };
        Self { sensors: [nothing; K], blind_after, seen: now }
    }

    /// Forgets everything, as of `now`. Call it with [`Ring::restart`](crate::Ring::restart): after a long sleep the
    /// clock may have wrapped, so that an old state would look recent.
    pub const fn restart(&mut self, now: Instant) {
        *self = Self::new(self.blind_after, now);
    }

    /// Processes an event that a poll at `now` returned. Returns a sensor (from 0) that has just become blind: once,
    /// and again only after one of its readings was accepted or confirmed clear.
    ///
    /// Pass every event, or at least readings and ends of periods, which keep ages within the range of the clock. If
    /// the clock has jumped back by more than a second since the last event, the watch forgets everything, like the
    /// ring.
    pub fn observe(&mut self, event: &RingEvent, now: Instant) -> Option<u8> {
        if !(now + STEP_BACK).has_reached(self.seen) {
            self.restart(now);
        }
        self.seen = now;
        match event {
            RingEvent::Fire { .. } => None,
            RingEvent::PeriodEnded(_) => {
                for sensor in &mut self.sensors {
                    if now.since(sensor.at) > LONGEST {
                        sensor.at = Instant::from_micros(now.as_micros().wrapping_sub(LONGEST.as_micros()));
                    }
                }
                None
            }
            RingEvent::Reading(reading) => {
                let sensor = self.sensors.get_mut(usize::from(reading.sensor))?;
                sensor.read(reading, now);
                let blind = sensor.counts(reading.kind, self.blind_after);
                blind.then_some(reading.sensor)
            }
        }
    }

    /// Returns the state of the space in front of a sensor, at `now`.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn state(&self, sensor: u8, now: Instant) -> Result<SensorState, SensorError> {
        let watched = self.sensors.get(usize::from(sensor)).ok_or(SensorError::new(sensor, K))?;
        let age = now.since(watched.at).min(LONGEST);
        Ok(match watched.known {
            Known::Obstacle(t_echo) => SensorState::Obstacle { t_echo, age },
            Known::Clear => SensorState::Clear { age },
            Known::TooClose => SensorState::TooClose { age },
            Known::Unanswered => SensorState::Unanswered { since: age },
            Known::Nothing(why) => SensorState::Unknown { since: age, why },
        })
    }
}

impl Watched {
    fn read(&mut self, reading: &Reading, now: Instant) {
        let was_silent = self.silent;
        let follows = reading.kind == ReadingKind::Late && reading.t_echo.is_some();
        if !follows {
            self.silent = reading.kind == ReadingKind::NoEcho;
        }
        let doubt = match reading.kind {
            ReadingKind::Accepted | ReadingKind::Tentative => {
                return self.confirm(Known::Obstacle(reading.t_echo.unwrap_or_default()), now);
            }
            ReadingKind::Clear => return self.confirm(Known::Clear, now),
            ReadingKind::TooEarly => return self.confirm(Known::TooClose, now),
            ReadingKind::Stuck | ReadingKind::Unanswered if self.known == Known::Unanswered => return,
            ReadingKind::Stuck | ReadingKind::Unanswered => return self.confirm(Known::Unanswered, now),
            // The firing has already had its reading.
            ReadingKind::Late if follows => return,
            ReadingKind::NoEcho if was_silent => Doubt::NoWitness,
            ReadingKind::First | ReadingKind::NoEcho | ReadingKind::Repeated | ReadingKind::Late => Doubt::Unsure,
            ReadingKind::Rejected => Doubt::Rejected,
            ReadingKind::Ambiguous => Doubt::Ambiguous(reading.explained_by.unwrap_or(Explanation::History)),
        };
        match self.known {
            // One echo may be missed, or a foreign one heard. A clear state ends with the first echo.
            Known::Obstacle(_) if !self.doubted => self.doubted = true,
            Known::Nothing(_) => self.known = Known::Nothing(doubt),
            _ => self.confirm(Known::Nothing(doubt), now),
        }
    }

    fn confirm(&mut self, known: Known, now: Instant) {
        (self.known, self.at, self.doubted) = (known, now, false);
    }

    /// Counts a firing whose echo was not accepted. Returns true if the sensor has just become blind.
    fn counts(&mut self, kind: ReadingKind, blind_after: u8) -> bool {
        match kind {
            ReadingKind::Accepted | ReadingKind::Clear => self.echoes = 0,
            ReadingKind::First | ReadingKind::Rejected | ReadingKind::Repeated | ReadingKind::Ambiguous
                if self.echoes < blind_after =>
            {
                self.echoes += 1;
                return self.echoes == blind_after;
            }
            _ => {}
        }
        false
    }
}
