//! [`Recorder`]: makes frames from the events of a ring.

use eeruf_core::{Instant, MAX_SENSORS, Micros, RingEvent};

use crate::encode::{Encoder, Frame};
use crate::firing::FiringMessage;

/// Number of firings between two greetings.
const GREET_EVERY: u8 = 128;

/// Follows the events of a ring of up to `K` sensors and makes a frame of each reading and each period's end. It takes
/// eight bytes per sensor. `K` is 1 to 64, or [`new`](Self::new) does not compile.
///
/// ```compile_fail
/// let recorder = eeruf_serial::Recorder::<65>::new("a timer");
/// ```
#[derive(Clone, Debug)]
pub struct Recorder<const K: usize> {
    encoder: Encoder,
    clock: &'static str,
    fired: [(Instant, Micros); K],
    firings: u8,
}

impl<const K: usize> Recorder<K> {
    /// Makes a recorder for a board whose clock has this name (ASCII, cut to 16 bytes).
    pub const fn new(clock: &'static str) -> Self {
        const { assert!(K >= 1 && K <= MAX_SENSORS, "a Recorder has room for 1 to 64 sensors") };
        Self { encoder: Encoder::new(), clock, fired: [(Instant::from_micros(0), Micros::ZERO); K], firings: 0 }
    }

    /// Returns the frame of an event, if it has one. Pass every event, with the `now` of its poll. `health` gives a
    /// sensor's `eeruf_hc_sr04::Health as u8` (0 for well; all 0 if unknown), and `edges_lost` is the number of edges
    /// lost to a full queue; both are used only at a period's end.
    pub fn event(
        &mut self,
        event: &RingEvent,
        now: Instant,
        health: impl Fn(u8) -> u8,
        edges_lost: u8,
    ) -> Option<Frame> {
        match *event {
            RingEvent::Fire { sensor, due, .. } => {
                self.fired(sensor, now, now.since(due));
                let greet = self.firings == 0;
                self.firings = (self.firings + 1) % GREET_EVERY;
                greet.then(|| self.encoder.hello(K as u8, self.clock))
            }
            RingEvent::Reading(reading) => {
                let &(fired, late) = self.fired.get(usize::from(reading.sensor))?;
                Some(self.encoder.firing(&FiringMessage::of(&reading, fired, late, now)))
            }
            RingEvent::PeriodEnded(ref stats) => {
                Some(self.encoder.period(stats.period, stats.max_late, edges_lost, (0..K as u8).map(health)))
            }
        }
    }

    /// Reports that a sensor fired at the instant `at`, `late` after it was due, if a timer measured that better than
    /// the poll, as for [`Ring::fired`](eeruf_core::Ring::fired).
    pub fn fired(&mut self, sensor: u8, at: Instant, late: Micros) {
        if let Some(place) = self.fired.get_mut(usize::from(sensor)) {
            *place = (at, late);
        }
    }
}
