//! Arrivals at the receivers: the sound of a firing along its channels, with fading and jitter, and bursts from
//! outside.

use core::f32::consts::FRAC_PI_2;

use crate::acoustics::Transducer;
use crate::simulation::channels::Channel;
use crate::simulation::receiver::{Arrival, EXTERNAL, Envelope, NEVER, Receiver};
use crate::world::{FARTHEST, Noise, Normal, Random, World};

// Purposes of the streams of random numbers.
const ARRIVALS: u64 = 1;
const BURSTS: u64 = 2;
const FADING: u64 = 4;

/// Fading and jitter of sound on its way.
#[derive(Clone)]
pub(crate) struct Propagation {
    /// Random numbers drawn again for each firing.
    random: Random,
    /// Random processes in time, for fading.
    fading: Random,
    normal: &'static Normal,
    fading_db: f32,
    jitter_ns: f32,
    /// Greatest deviation of an arrival's time, in nanoseconds.
    slack: u64,
    /// The sounds that add, if sounds add.
    sum: Option<Envelope>,
    /// Length of each sensor's burst in nanoseconds, if sounds add.
    bursts: Vec<u64>,
    /// Interval between knots of the fading, in nanoseconds; 0 if each firing draws again.
    knot_ns: u64,
}

/// Share of the time between knots after which the correlation of [`Propagation::faded`] has fallen to 1/e.
const CORRELATED: f64 = 0.939;

impl Propagation {
    /// Makes propagation with the noise of a world, from this seed.
    pub(crate) fn new(world: &World, seed: Random) -> Self {
        let (noise, physics) = (world.noise(), world.physics());
        let jitter_ns = (noise.jitter_us_rms * 1000.0) as f32;
        let burst_ns = |transducer: Transducer| (transducer.burst_s() * 1e9).ceil() as u64;
        let bursts = || world.robots().iter().flat_map(|robot| robot.transducers().map(burst_ns));
        let longest = bursts().max().unwrap_or(0);
        let walk = match (physics.interference, physics.range_walk) {
            // A sum may cross the threshold until its last sound ends.
            (true, _) => 2 * longest,
            (false, true) => longest,
            (false, false) => 0,
        };
        Self {
            random: seed.of(ARRIVALS),
            fading: seed.of(FADING),
            normal: Normal::shared(),
            fading_db: noise.fading_db_rms as f32,
            jitter_ns,
            slack: (jitter_ns * FARTHEST).ceil() as u64 + walk,
            sum: physics.interference.then(Envelope::default),
            bursts: if physics.interference { bursts().collect() } else { Vec::new() },
            knot_ns: if physics.fades_slowly() { (physics.fading_time_s / CORRELATED * 1e9).ceil() as u64 } else { 0 },
        }
    }

    /// Returns true if random values depend on the paths' keys, and not on the order in which paths are found.
    pub(crate) fn is_keyed(&self) -> bool {
        self.knot_ns > 0
    }

    /// Returns the slack of an arrival whose own time is uncertain by `more`, in nanoseconds.
    pub(crate) fn slack(&self, more: u64) -> u64 {
        self.slack.saturating_add(more)
    }

    /// Sends the sound of the firing at `now`, identified by `emitter` and the number `firing`. Passes each arrival
    /// that may matter to its receiver to `arrive`, with the receiver's number; skips absent receivers.
    #[inline]
    pub(crate) fn send(
        &mut self,
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
            let [fades, shifts] = if self.knot_ns == 0 {
                self.normal.pair(random.of(channel.path.into()).bits())
            } else {
                self.faded(channel.key, now)
            };
            let level_over_threshold_db = channel.level_over_threshold_db + self.fading_db * fades;
            if level_over_threshold_db >= 0.0 || self.sum.is_some() {
                let onset = nominal.saturating_add_signed((self.jitter_ns * shifts) as i64).max(now + 1);
                let path = channel.path;
                let arrival = Arrival { onset, at: onset, sent: now, path, level_over_threshold_db, rise: None };
                match &mut self.sum {
                    None => arrive(number, receiver, arrival),
                    Some(sum) => sum.push(channel.wave(onset, level_over_threshold_db, self.bursts[number])),
                }
            }
        }
        if let Some(sum) = &mut self.sum {
            sum.rises(now, |number, arrival| arrive(number, &mut receivers[number], arrival));
        }
    }

    /// Returns the fading and shift of a path with this key at a time, both normally distributed. They depend only on
    /// the seed, the path and the time, so that the order of calls does not matter.
    ///
    /// Each path has independent normal numbers at knots in time, at times of its own. Between two knots the value
    /// follows a quarter of a circle, which keeps the variance: at the share `u` of the way it is
    /// `cos(u pi / 2) a + sin(u pi / 2) b`. At a distance of `s` knots, up to one, the correlation is
    /// `(1 - s / 2) cos(s pi / 2) + sin(s pi / 2) / pi`; beyond two knots it is 0.
    fn faded(&self, key: u64, now: u64) -> [f32; 2] {
        let path = self.fading.of(key);
        let since = now + path.of(0).bits() % self.knot_ns;
        let (knot, within) = (since / self.knot_ns, since % self.knot_ns);
        let at = |knot: u64| self.normal.pair(path.of(1).of(knot).bits())[0];
        let (sin, cos) = libm::sincosf(FRAC_PI_2 * (within as f32 / self.knot_ns as f32));
        let fades = (cos * at(knot) + sin * at(knot + 1)).clamp(-FARTHEST, FARTHEST);
        [fades, self.normal.pair(path.of(2).of(now).bits())[1]]
    }
}

/// Bursts from outside, one after the other.
#[derive(Clone)]
pub(crate) struct Bursts {
    random: Random,
    normal: &'static Normal,
    noise: Noise,
    /// Time of the next burst, or [`NEVER`].
    pub(crate) next: u64,
}

impl Bursts {
    /// Makes the bursts of a world, from its seed.
    pub(crate) fn new(noise: &Noise, seed: Random) -> Self {
        let mut bursts = Self { random: seed.of(BURSTS), normal: Normal::shared(), noise: *noise, next: 0 };
        bursts.advance();
        bursts
    }

    /// Advances to the next burst.
    pub(crate) fn advance(&mut self) {
        let rate = self.noise.bursts_per_s;
        self.next = if rate > 0.0 {
            // In a Poisson process the time to the next event follows from a share above 0 and up to 1.
            let share = ((self.random.bits() >> 11) + 1) as f64 / (1u64 << 53) as f64;
            // Advance by at least a nanosecond, so that time passes.
            self.next.saturating_add(1 + (-libm::log(share) / rate * 1e9) as u64)
        } else {
            NEVER
        };
    }

    /// Returns the arrival of a burst at `now` at one receiver; `None` if it is too faint there.
    pub(crate) fn arrival(&mut self, now: u64) -> Option<Arrival> {
        let [fades, _] = self.normal.pair(self.random.bits());
        let level_over_threshold_db = self.noise.burst_db as f32 + self.noise.fading_db_rms as f32 * fades;
        (level_over_threshold_db >= 0.0).then_some(Arrival {
            onset: now,
            at: now,
            sent: now,
            path: EXTERNAL,
            level_over_threshold_db,
            rise: None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{acoustics::Physics, scene::*, world::*};

    fn propagation(fading_time_s: f64) -> Propagation {
        let scene = Scene::new(vec![], vec![], Air::default()).unwrap();
        let robot = Robot::ring(crate::Pose::identity(), 1, 0.1, 0.1, Transducer::POLAROID_6500);
        let physics = Physics { fading_time_s, ..Physics::DEFAULT };
        let world = World::new(scene, vec![robot], Noise::default()).and_then(|world| world.with_physics(physics));
        Propagation::new(&world.unwrap(), Random::new(7))
    }

    #[test]
    fn fading_has_mean_zero_deviation_one_and_its_time_constant() {
        let propagation = propagation(0.5);
        let n = 40_000;
        let mut sums = [0.0; 5];
        for key in 0..n {
            let at = |ms: u64| f64::from(propagation.faded(key, ms * 1_000_000)[0]);
            let now = at(3000);
            for (sum, term) in sums.iter_mut().zip([now, now * now, now * at(3050), now * at(3500), now * at(4500)]) {
                *sum += term / n as f64;
            }
        }
        let [mean, square, after_50_ms, after_its_time, much_later] = sums;
        assert!(mean.abs() < 0.02 && (square - 1.0).abs() < 0.03, "{sums:?}");
        assert!((after_50_ms - 0.98).abs() < 0.02, "{after_50_ms}");
        assert!((after_its_time - libm::exp(-1.0)).abs() < 0.02, "{after_its_time}");
        assert!(much_later.abs() < 0.02, "{much_later}");
    }

    #[test]
    fn bursts_come_as_often_as_asked() {
        let noise = Noise { bursts_per_s: 20.0, ..Noise::NONE };
        let mut bursts = Bursts::new(&noise, Random::new(9));
        (1..50_000).for_each(|_| bursts.advance());
        assert!((bursts.next as f64 / 1e9 / 50_000.0 - 0.05).abs() < 0.001);
    }

    #[test]
    fn jitter_is_drawn_anew_at_every_instant() {
        let propagation = propagation(1.0);
        let shift = |now: u64| f64::from(propagation.faded(1, now)[1]);
        let n = 40_000u64;
        let together = (0..n).map(|k| shift(1000 * k) * shift(1000 * k + 1)).sum::<f64>() / n as f64;
        assert!(together.abs() < 0.02, "{together}");
        assert_eq!(shift(5), shift(5));
    }
}
