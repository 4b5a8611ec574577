//! What reaches the receivers: the sound of a firing along its channels, with fading and jitter, and bursts from
//! outside.

use crate::simulation::channels::Channel;
use crate::simulation::receiver::{Arrival, EXTERNAL, NEVER, Receiver};
use crate::world::{FARTHEST, Noise, Normal, Random};

// What the streams of random numbers are for.
const ARRIVALS: u64 = 1;
const BURSTS: u64 = 2;

/// How sound fades and jitters on its way.
pub(crate) struct Propagation {
    random: Random,
    normal: &'static Normal,
    fading_db: f32,
    jitter_ns: f32,
    /// No arrival is earlier or later by more, in nanoseconds.
    slack: u64,
}

impl Propagation {
    /// The noise of a world, from its seed.
    pub(crate) fn new(noise: &Noise, seed: Random) -> Self {
        let jitter_ns = (noise.jitter_us_rms * 1000.0) as f32;
        Self {
            random: seed.of(ARRIVALS),
            normal: Normal::shared(),
            fading_db: noise.fading_db_rms as f32,
            jitter_ns,
            slack: (jitter_ns * FARTHEST).ceil() as u64,
        }
    }

    /// Sends out the sound of a firing at `now`; `emitter` and the number of its `firing` say which. Each arrival that
    /// may matter to its receiver is handed to `arrive` with the receiver's number; receivers that are not there are
    /// left out.
    #[inline]
    pub(crate) fn send(
        &self,
        [emitter, firing]: [u64; 2],
        now: u64,
        channels: &[Channel],
        receivers: &mut [Receiver],
        mut arrive: impl FnMut(usize, &mut Receiver, Arrival),
    ) {
        let random = self.random.of(emitter).of(firing);
        for channel in channels {
            let number = channel.receiver as usize;
            let Some(receiver) = receivers.get_mut(number) else { continue };
            let nominal = now + channel.delay;
            if !receiver.cares(nominal, self.slack) {
                continue;
            }
            let [fades, shifts] = self.normal.pair(random.of(channel.path.into()).bits());
            let level_over_threshold_db = channel.level_over_threshold_db + self.fading_db * fades;
            if level_over_threshold_db >= 0.0 {
                let at = nominal.saturating_add_signed((self.jitter_ns * shifts) as i64).max(now + 1);
                arrive(number, receiver, Arrival { at, sent: now, path: channel.path, level_over_threshold_db });
            }
        }
    }
}

/// Bursts from outside, one after the other.
pub(crate) struct Bursts {
    random: Random,
    normal: &'static Normal,
    noise: Noise,
    /// When the next one comes, or [`NEVER`].
    pub(crate) next: u64,
}

impl Bursts {
    /// The bursts of a world, from its seed.
    pub(crate) fn new(noise: &Noise, seed: Random) -> Self {
        let mut bursts = Self { random: seed.of(BURSTS), normal: Normal::shared(), noise: *noise, next: 0 };
        bursts.advance();
        bursts
    }

    /// Goes on to the next burst.
    pub(crate) fn advance(&mut self) {
        let rate = self.noise.bursts_per_s;
        self.next = if rate > 0.0 {
            // At least a nanosecond on, so that time passes.
            self.next.saturating_add(1 + (self.random.until_next(rate) * 1e9) as u64)
        } else {
            NEVER
        };
    }

    /// How a burst at `now` reaches one receiver, if it is loud enough there.
    pub(crate) fn arrival(&mut self, now: u64) -> Option<Arrival> {
        let [fades, _] = self.normal.pair(self.random.bits());
        let level_over_threshold_db = self.noise.burst_db as f32 + self.noise.fading_db_rms as f32 * fades;
        (level_over_threshold_db >= 0.0).then_some(Arrival {
            at: now,
            sent: now,
            path: EXTERNAL,
            level_over_threshold_db,
        })
    }
}
