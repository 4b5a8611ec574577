//! [`SensorWatch`]: what was last accepted of each sensor and how long ago, and which sensors are blind.

use crate::filter::NO_ECHO;
use crate::reading::ReadingKind;
use crate::ring::RingEvent;
use crate::sensor_error::SensorError;
use crate::time::{Instant, Micros};

/// Watches the events of a ring of up to `K` sensors: what was last accepted of each, how old it is, and which sensors
/// hear echoes none of which is accepted. Eight bytes for each sensor; a ring without it costs nothing.
///
/// ```
/// use eeruf_core::{Instant, Micros, Ring, RingConfig, RingEvent, SensorWatch, tables::PAPER_12};
/// let mut ring = Ring::new(&PAPER_12, RingConfig::new(), Instant::from_micros(0))?;
/// let mut watch = SensorWatch::<12>::new(20);
/// let mut now = Instant::from_micros(0);
/// for _ in 0..100 {
///     now = ring.next_deadline();
///     while let Some(event) = ring.poll(now) {
///         if let RingEvent::Fire { sensor, .. } = event {
///             ring.echo(sensor, now + Micros::from_millis(9))?;
///         }
///         if let Some(blind) = watch.observe(&event, now) {
///             panic!("nothing accepted of sensor {} for {} echoes", blind.sensor + 1, blind.firings);
///         }
///     }
/// }
/// let last = watch.last_accepted(3, now)?.expect("something stands there");
/// assert_eq!(last.t_echo, Micros::from_millis(9));
/// assert!(last.age < Micros::from_millis(130));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SensorWatch<const K: usize> {
    sensors: [Watched; K],
    blind_after: u8,
}

/// The last accepted echo of a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LastAccepted {
    /// Its echo time.
    pub t_echo: Micros,
    /// How long ago it was accepted, to 256 us; at most 2,147,483,648 us (36 minutes), which stands for all longer
    /// times.
    pub age: Micros,
}

/// A sensor that hears echoes, and none was accepted for so many firings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Blind {
    /// The sensor, from 0.
    pub sensor: u8,
    /// For how many firings with an echo nothing was accepted.
    pub firings: u8,
}

#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Watched {
    /// The last accepted echo time.
    t_echo: u32,
    /// When it was accepted, in steps of 256 us of the clock, in the upper 24 bits; in the lower 8 the echoes since.
    at_and_echoes: u32,
}

const STEP_BITS: u32 = 8;
const ECHOES: u32 = (1 << STEP_BITS) - 1;
/// Half a turn of the clock.
const LONGEST: u32 = 1 << 31;

impl<const K: usize> SensorWatch<K> {
    /// Nothing was accepted yet. A sensor counts as blind when nothing was accepted for `blind_after` firings with an
    /// echo, 1 to 255; with 0 no sensor does.
    pub const fn new(blind_after: u8) -> Self {
        Self { sensors: [Watched { t_echo: NO_ECHO, at_and_echoes: 0 }; K], blind_after }
    }

    /// Takes in an event that a poll at `now` returned. Returns a sensor that has just become blind; it is returned
    /// once, and again only after something was accepted or confirmed clear.
    ///
    /// Observe every event, or at least the ends of periods, since ages are kept within what the clock can tell there.
    pub fn observe(&mut self, event: &RingEvent, now: Instant) -> Option<Blind> {
        match event {
            RingEvent::Fire { .. } => None,
            RingEvent::PeriodEnded(_) => {
                for sensor in &mut self.sensors {
                    if sensor.age(now).as_micros() > LONGEST {
                        sensor.set_at(Instant::from_micros(now.as_micros().wrapping_sub(LONGEST)));
                    }
                }
                None
            }
            RingEvent::Reading(reading) => {
                let sensor = self.sensors.get_mut(usize::from(reading.sensor))?;
                match reading.kind {
                    ReadingKind::Accepted => {
                        sensor.t_echo = reading.t_echo?.as_micros().min(NO_ECHO - 1);
                        sensor.set_at(now);
                        sensor.at_and_echoes &= !ECHOES;
                    }
                    ReadingKind::Clear => sensor.at_and_echoes &= !ECHOES,
                    ReadingKind::First | ReadingKind::Rejected | ReadingKind::Repeated | ReadingKind::Ambiguous => {
                        let echoes = sensor.at_and_echoes & ECHOES;
                        if echoes < u32::from(self.blind_after) {
                            sensor.at_and_echoes += 1;
                            let (sensor, firings) = (reading.sensor, self.blind_after);
                            return (echoes + 1 == u32::from(firings)).then_some(Blind { sensor, firings });
                        }
                    }
                    _ => {}
                }
                None
            }
        }
    }

    /// What was last accepted of a sensor, however long ago; `None` if nothing ever was.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn last_accepted(&self, sensor: u8, now: Instant) -> Result<Option<LastAccepted>, SensorError> {
        let watched = self.sensors.get(usize::from(sensor)).ok_or(SensorError::new(sensor, K))?;
        let age = watched.age(now).min(Micros::new(LONGEST));
        Ok((watched.t_echo != NO_ECHO).then_some(LastAccepted { t_echo: Micros::new(watched.t_echo), age }))
    }
}

impl Watched {
    fn set_at(&mut self, at: Instant) {
        self.at_and_echoes = (at.as_micros() & !ECHOES) | (self.at_and_echoes & ECHOES);
    }

    fn age(&self, now: Instant) -> Micros {
        let now = Instant::from_micros(now.as_micros() & !ECHOES);
        now.since(Instant::from_micros(self.at_and_echoes & !ECHOES))
    }
}
