//! [`Motion`]: how much a good reading may change on a moving robot.

use crate::time::{Instant, Micros};

/// Greatest age of audible sound: see `LONGEST_QUIET`.
const AUDIBLE: Micros = Micros::from_millis(250);
/// Time without a report of speed after which the top speed is assumed.
const SILENCE: Micros = Micros::from_millis(500);
/// The longest time over which a change is computed; older beliefs are dropped.
const LONGEST: u32 = (1 << 20) - 1;
/// Assumed distance of a sensor from the robot's centre of rotation, as the divisor of a metre: 1/2 m.
const PART_OF_A_METRE: u32 = 2;

/// Change of an echo for a moving robot, in 1/16 us per 1,024 us.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Rate(u16);

impl Rate {
    pub(super) const STANDING: Self = Self(0);
    /// The rate at a speed `v` in mm/s, rounded up: `2 v / 331 * 1.024 * 16 * 1.06`, at most 4,095. Robots meet no
    /// sound slower than 331 m/s. The extra 6 % covers intervals between emissions, which at 3.6 m/s are longer by that
    /// much than intervals between receptions.
    const fn of(speed_mm_s: u32) -> Self {
        // A Cortex-M0 divides by a power of two without a call.
        let speed = if speed_mm_s > 39_000 { 39_000 } else { speed_mm_s };
        Self((speed * 6_881).div_ceil(1 << 16) as u16)
    }

    pub(super) fn moves(self) -> bool {
        self != Self::STANDING
    }

    /// The change within a time.
    pub(super) fn grow(self, time: Micros) -> Micros {
        // Below 2^32: twelve bits times twenty.
        Micros::new((u32::from(self.0) * time.as_micros().min(LONGEST)) >> 14)
    }
}

/// The known motion of the robot.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Motion {
    rate: Rate,
    top: Rate,
    /// Time when the caller last reported the speed; `None` if not within [`SILENCE`].
    told: Option<Instant>,
    /// The greatest rates before and after `since`, each over a span not much shorter than sound is audible.
    greatest: [Rate; 2],
    since: Instant,
}

impl Motion {
    pub(super) const fn new(top_speed_mm_s: u16) -> Self {
        let top = Rate::of(top_speed_mm_s as u32);
        Self { rate: top, top, told: None, greatest: [top; 2], since: Instant::from_micros(0) }
    }

    /// Stores how fast the robot moves from now on. Returns the greater of the rates before and after.
    pub(super) fn set(&mut self, speed_mm_s: u32, turn_mrad_s: u32, now: Instant) -> Rate {
        if !now.has_reached(self.since) {
            // The first report of a clock in its upper half, or a clock that has jumped.
            (self.since, self.greatest) = (now, [self.greatest[0].max(self.greatest[1]), Rate::STANDING]);
        }
        let before = self.recent(now);
        self.rate = Rate::of(speed_mm_s.saturating_add(turn_mrad_s / PART_OF_A_METRE));
        self.told = Some(now);
        self.greatest[1] = self.greatest[1].max(self.rate);
        before.max(self.rate)
    }

    /// The greatest rate during the time in which sound heard at `now` could have been sent; `now` is not long before
    /// the last report.
    pub(super) fn recent(&mut self, now: Instant) -> Rate {
        let rate = self.rate(now);
        if now.has_reached(self.since) && now.since(self.since) > AUDIBLE {
            (self.since, self.greatest) = (now, [self.greatest[1], rate]);
        }
        self.greatest[1] = self.greatest[1].max(rate);
        self.greatest[0].max(self.greatest[1])
    }

    /// The rate at an instant not long before the last report.
    pub(super) fn rate(&mut self, now: Instant) -> Rate {
        let is_silent = |told: Instant| now.has_reached(told) && now.since(told) > SILENCE;
        if self.told.is_some_and(is_silent) {
            (self.told, self.rate) = (None, self.top);
        }
        self.rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_change_by_6_4_us_a_millisecond_at_1_m_s() {
        for (speed, us) in [(0, 0), (200, 1_282), (1000, 6_408), (2000, 12_817), (60_000, 249_900)] {
            let grown = Rate::of(speed).grow(Micros::from_millis(1000)).as_micros();
            assert!(grown.abs_diff(us) <= us / 50 + 5, "{speed} mm/s: {grown}");
        }
        // Twice the speed over the speed of sound, and never less.
        assert!((1..3000).all(|speed| Rate::of(speed).grow(Micros::new(500_000)).as_micros() >= speed * 2 * 500 / 343));
    }

    #[test]
    fn top_speed_holds_half_a_second_after_the_last_word() {
        let mut motion = Motion::new(1000);
        let (begin, top) = (Instant::from_micros(u32::MAX - 5), Rate::of(1000));
        assert_eq!(motion.rate(begin), top);
        motion.set(0, 0, begin);
        assert_eq!(motion.rate(begin + Micros::from_millis(500)), Rate::STANDING);
        assert_eq!(motion.clone().rate(begin + Micros::new(500_001)), top);
        // The top speed applied until the next report.
        assert_eq!(motion.set(0, 500, begin + Micros::new(600_000)), top);
        assert_eq!(motion.rate(begin + Micros::new(600_001)), Rate::of(250));
    }

    #[test]
    fn rate_is_forgotten_wherever_the_clock_begins_or_jumps() {
        for start in (0..32_u32).map(|part| part << 27) {
            let mut motion = Motion::new(1000);
            for begin in [start, start.wrapping_sub(1 << 30), start.wrapping_add(1 << 31)] {
                motion.set(1000, 0, Instant::from_micros(begin));
                for ms in 1..800 {
                    let at = Instant::from_micros(begin) + Micros::from_millis(ms);
                    motion.set(0, 0, at);
                    let recent = motion.recent(at);
                    assert!(
                        if ms <= 250 { recent == Rate::of(1000) } else { ms < 600 || !recent.moves() },
                        "{start} {ms}"
                    );
                }
            }
        }
    }

    #[test]
    fn rate_is_recent_while_sound_is_heard_that_was_sent_then() {
        let mut motion = Motion::new(0);
        let at = |ms| Instant::from_micros(u32::MAX - 50_000) + Micros::from_millis(ms);
        motion.set(500, 0, at(0));
        for ms in (20..900).step_by(20) {
            let told = if ms == 100 { 1000 } else { 500 };
            motion.set(told, 0, at(ms));
            let recent = motion.recent(at(ms));
            assert!(if (100..=350).contains(&ms) { recent == Rate::of(1000) } else { recent >= Rate::of(500) }, "{ms}");
            assert!(ms < 700 || recent == Rate::of(500), "{ms}");
        }
    }
}
