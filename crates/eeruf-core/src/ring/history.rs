//! [`Pair`]: whether one path of sound explains two consecutive readings of a sensor.
//!
//! Eqs. (11) and (13), applied to actual instead of planned firings. A receiver fired at `f1` and `f2` and heard
//! something at `h1 = f1 + e1` and `h2 = f2 + e2`. Sensor x explains both readings if it fired at `a` and `b`, and
//!
//! ```text
//! 0 <= h1 - a <= R,   0 <= h2 - b <= R,   |(h2 - b) - (h1 - a)| <= P
//! ```
//!
//! `h - a` is the length, in time, that a path from x would have; R is how long sound is audible, and P is the most
//! that a path may change between the two readings. For the receiver itself `a = f1` and `b = f2` do not count: these
//! are the echoes that it is meant to hear. A single path of sound that changes by at most P is among those tried,
//! whenever and for whatever reason its emitter fired: `docs/explanation/theory.md` section 2.1.

use crate::time::{Instant, Micros};

/// A time longer than any sound is audible: about 18 minutes.
const LONG_AGO: Micros = Micros::new(1 << 30);
/// The largest step back of a clock that is not taken for a wrap: about one second.
pub(crate) const STEP_BACK: Micros = Micros::new(1 << 20);

/// The last `H` firings of one sensor, the latest first. What came before them is forgotten.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(transparent)]
pub(super) struct Firings<const H: usize>([Instant; H]);

impl<const H: usize> Firings<H> {
    /// A history without audible firings: all are long before `now`.
    pub(super) const fn none_before(now: Instant) -> Self {
        const { assert!(H > 0, "a ring remembers at least the last firing of each sensor") };
        Self([long_before(now); H])
    }

    #[inline]
    pub(super) const fn last(&self) -> Instant {
        // There is one: `none_before` asserts it.
        self.0[0]
    }

    #[inline]
    pub(super) fn push(&mut self, now: Instant) {
        // Unrolled: a third of the instructions of a loop.
        match self.0.as_mut_slice() {
            [last, a, b, c] => (*last, *a, *b, *c) = (now, *last, *a, *b),
            [last, a, b] => (*last, *a, *b) = (now, *last, *a),
            others => {
                let mut at = now;
                for slot in others {
                    core::mem::swap(slot, &mut at);
                }
            }
        }
    }

    /// Corrects the instant of the last firing.
    #[inline]
    pub(super) fn correct(&mut self, at: Instant) {
        if let Some(last) = self.0.first_mut() {
            *last = at;
        }
    }

    /// The oldest remembered firing: all forgotten ones came before it.
    pub(super) const fn oldest(&self) -> Instant {
        self.0[H - 1]
    }

    /// The last firing and the one `ago` firings before it; `None` if that is forgotten.
    pub(super) fn last_and(&self, ago: u8) -> [Option<Instant>; 2] {
        const { assert!(H > 1, "a judge that asks what explains two readings; expected H >= 2, or an AgreementRing") };
        [Some(self.0[0]), self.0.get(usize::from(ago)).copied()]
    }

    /// The time from the second-to-last firing to the last.
    pub(super) fn since_before(&self) -> Micros {
        self.0.get(1).map_or(Micros::MAX, |&before| self.last().since(before))
    }

    /// Returns true if sound of any firing, except the latest `but` ones, is audible at an instant.
    pub(super) fn is_heard_at(&self, at: Instant, audible: Micros, but: usize) -> bool {
        for &fired in self.0.iter().skip(but) {
            if at.has_reached(fired) {
                // The latest firing until then decides: earlier ones are not heard for longer.
                return at.since(fired) <= audible;
            }
        }
        false
    }

    /// Returns true if an instant is later than the second-to-last firing, or if that is unknown.
    pub(super) fn may_correct(&self, at: Instant) -> bool {
        self.0.get(1).is_none_or(|&before| at != before && at.has_reached(before))
    }

    /// Forgets firings before the clock's wrap makes them look recent: call it at least every four minutes. Returns
    /// true if it forgot them.
    #[inline]
    pub(super) fn expire(&mut self, now: Instant) -> bool {
        let expired = is_long_ago(self.last(), now);
        if expired {
            self.0.fill(long_before(now));
        }
        expired
    }
}

/// Returns true if an instant is so long before `now` that no sound of it is audible.
#[inline]
pub(super) const fn is_long_ago(instant: Instant, now: Instant) -> bool {
    let age = now.since(instant).as_micros();
    age > LONG_AGO.as_micros() && !is_just_ahead(instant, now)
}

/// Returns true if an instant lies ahead of `now` by no more than a clock may step back.
#[inline]
pub(super) const fn is_just_ahead(instant: Instant, now: Instant) -> bool {
    let ahead = instant.since(now).as_micros();
    ahead > 0 && ahead <= STEP_BACK.as_micros()
}

pub(super) const fn long_before(now: Instant) -> Instant {
    Instant::from_micros(now.as_micros().wrapping_sub(LONG_AGO.as_micros()))
}

/// The instants at which a sensor heard two consecutive readings, and the limits of sound.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    /// Time when the first was heard, `h1`, and the second, `h2`.
    pub(super) heard: [Instant; 2],
    /// `R`: how long sound is audible.
    pub(super) audible: Micros,
    /// `P`: the largest change of a path from the first to the second.
    pub(super) path_change: Micros,
}

impl Pair {
    /// Returns true if sound of these firings explains both readings. `own` marks the receiver's own firings: its last
    /// firing does not count for the second reading, nor the firing with this index for the first.
    // Out of line, where it has all registers of a Cortex-M0 to itself.
    #[inline(never)]
    pub(super) fn explains<const H: usize>(&self, firings: &Firings<H>, own: Option<u8>) -> bool {
        let &Self { heard: [first, second], audible, path_change } = self;
        for earlier in 0..H {
            // The length that the path would have in the first reading. Before it was sent nothing is heard.
            let length_before = first.since(firings.0[earlier]);
            if length_before > audible {
                continue;
            }
            let latest = match own {
                None => 0,
                Some(place) if usize::from(place) == earlier => continue,
                Some(_) => 1,
            };
            // Both are below a minute, and the change below 66 ms: neither sum nor difference wraps twice.
            let shortest = length_before.as_micros().wrapping_sub(path_change.as_micros());
            // Later firings have lower indices; both may be the same one if the readings are that close.
            for later in latest..earlier + 1 {
                let length = second.since(firings.0[later]);
                let changed = length.as_micros().wrapping_sub(shortest);
                if changed <= 2 * path_change.as_micros() && length <= audible {
                    return true;
                }
            }
        }
        false
    }

    /// Widens the tolerances for echo times that may be off by `one` and `other`, and none by more than `most`: each
    /// length by `most` either way, the change by `one` plus `other`.
    pub(super) fn widened(self, one: Micros, other: Micros, most: Micros) -> Self {
        let change = self.path_change.saturating_add(one).saturating_add(other);
        let audible = self.audible.saturating_add(most).saturating_add(most);
        Self { heard: self.heard.map(|at| at + most), audible, path_change: change }
    }

    /// Returns true if sound from before this instant could be in the first reading.
    pub(super) fn is_audible_from(&self, instant: Instant) -> bool {
        let [first, _] = self.heard;
        // For an instant after the first reading, the age is negative and the answer true.
        (first.since(instant).as_micros() as i32) < self.audible.as_micros() as i32
    }
}
