//! [`Track`]: one echo time that a sensor may have, and how sure the tracker is of it.

use super::settings::TrackerSettings;

/// The hypothesis that nothing is in range: later than all echoes, and further from each of them than any setting
/// allows two readings to be apart.
pub(super) const SILENCE: u32 = (1 << ECHO_BITS) - 1;
/// The latest echo: 16.7 s. All later ones count as this.
pub(super) const LATEST: u32 = SILENCE - (1 << 16);

/// One hypothesis about a sensor: that its own echo comes at this time.
///
/// It is *tentative* until enough phases support it, then *confirmed*; while nothing supports it, it *coasts*.
///
/// Eight bytes, since a ring keeps four of them for each sensor.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Track {
    /// The echo time in microseconds, or [`SILENCE`]; in the lowest byte the age: firings since it was last supported.
    echo_and_age: u32,
    /// The phases, modulo 16, in which it was supported when the sensor last heard something that could tell. Phases
    /// that share a bit count once, so a cycle longer than 16 phases only makes the rule stricter.
    phases: u16,
    /// The score, 0 for no track; above it the votes that came from solo periods beyond their phases' own.
    score_and_solo: u8,
    /// Number of phases that supported it closely, and the flags.
    close_and_flags: u8,
}

const ECHO_BITS: u32 = 24;
const ECHO_AT: u32 = 32 - ECHO_BITS;
const AGE: u32 = 0xff;
/// Scores and votes are at most 15.
const SCORE: u8 = 0x0f;
const SOLO_VOTE: u8 = 0x10;
const CONFIRMED: u8 = 1;
const CONTRADICTED: u8 = 2;
/// It was confirmed, and is again once it is supported.
const REMEMBERED: u8 = 4;
/// The least score of a track that is confirmed again.
const REGAINED: u8 = 2;
const CLOSE_VOTE: u8 = 8;
const MOST_CLOSE: u8 = !(CONFIRMED | CONTRADICTED | REMEMBERED);

/// The bit of a phase.
pub(super) const fn bit(phase: u8) -> u16 {
    1 << (phase & 15)
}

impl Track {
    pub(super) const NONE: Self =
        Self { echo_and_age: (SILENCE << 8) | AGE, phases: 0, score_and_solo: 0, close_and_flags: 0 };

    /// After the first reading at this time.
    pub(super) const fn new(t_echo: u32, bit: u16, solo: bool) -> Self {
        let score_and_solo = if solo { 2 + SOLO_VOTE } else { 1 };
        Self { echo_and_age: t_echo << 8, phases: bit, score_and_solo, close_and_flags: CLOSE_VOTE }
    }

    #[inline(always)]
    pub(super) const fn exists(&self) -> bool {
        self.score_and_solo & SCORE != 0
    }

    /// In microseconds; [`SILENCE`] is the hypothesis that nothing is in range.
    #[inline(always)]
    pub(super) const fn t_echo(&self) -> u32 {
        self.echo_and_age >> 8
    }

    /// Its time if it is confirmed; else later than all.
    #[inline(always)]
    pub(super) const fn confirmed(&self) -> u32 {
        if self.is_confirmed() { self.t_echo() } else { u32::MAX }
    }

    #[inline(always)]
    pub(super) const fn is_confirmed(&self) -> bool {
        self.close_and_flags & CONFIRMED != 0
    }

    /// Number of phases that supported it closely, unless it was ever contradicted.
    pub(super) const fn close_votes(&self) -> u8 {
        if self.close_and_flags & CONTRADICTED == 0 { self.close_and_flags / CLOSE_VOTE } else { 0 }
    }

    /// Firings since it was last supported, 255 at most.
    const fn age(&self) -> u8 {
        (self.echo_and_age & AGE) as u8
    }

    /// Order of replacement: the less, the sooner. First what is not confirmed, then by score, then by age.
    pub(super) const fn rank(&self) -> u32 {
        let (flags, score) = (self.close_and_flags as u32, (self.score_and_solo & SCORE) as u32);
        // Confirmed, then remembered; below them four bits of the score and eight of the age.
        let known = (flags & CONFIRMED as u32) << 13 | (flags & REMEMBERED as u32) << 10;
        known | (score << 8) | (AGE - (self.echo_and_age & AGE))
    }

    /// Distance of a reading from it.
    #[inline(always)]
    pub(super) const fn distance(&self, t_echo: u32) -> u32 {
        self.t_echo().abs_diff(t_echo)
    }

    /// Moves with the robot, by at most 65,536 us, unless that were later than the latest echo or before the firing.
    #[inline(always)]
    pub(super) const fn shift(&mut self, change_us: i32) {
        // What is before the firing wraps, to what is later than the latest.
        let moved = self.echo_and_age.wrapping_add_signed(change_us << ECHO_AT);
        if self.echo_and_age < SILENCE << ECHO_AT && moved < (LATEST + 1) << ECHO_AT {
            self.echo_and_age = moved;
        }
    }

    /// A reading within `t_delta` of it.
    pub(super) fn support(&mut self, t_echo: u32, bit: u16, solo: bool, settings: &TrackerSettings) {
        let new = self.phases & bit == 0;
        let is_close = self.distance(t_echo) <= settings.tentative_within.as_micros();
        if new && is_close && self.close_and_flags < MOST_CLOSE {
            self.close_and_flags += CLOSE_VOTE;
        }
        self.phases |= bit;
        let (mut score, mut solo_votes) = (self.score_and_solo & SCORE, self.score_and_solo / SOLO_VOTE);
        if solo {
            solo_votes = (solo_votes + 1).min(settings.votes);
        }
        // A path repeats itself in its own phase for ever, so that says nothing new of a track yet to be confirmed.
        if new || solo || self.is_confirmed() {
            score = (score + 1 + u8::from(solo)).min(settings.score_limit);
        }
        let recalled = self.close_and_flags & REMEMBERED != 0 && self.age() <= settings.memory;
        if recalled {
            self.close_and_flags |= CONFIRMED;
            score = score.max(REGAINED);
        }
        self.close_and_flags &= !REMEMBERED;
        self.score_and_solo = score | (solo_votes * SOLO_VOTE);
        if self.t_echo() == SILENCE {
            self.echo_and_age &= !AGE;
        } else {
            // A quarter of the way, so that one early or late edge does not move it far.
            self.echo_and_age = self.t_echo().wrapping_add_signed(self.to(t_echo) / 4) << 8;
        }
        if score >= settings.votes && self.phases.count_ones() as u8 + solo_votes >= settings.votes {
            self.close_and_flags |= CONFIRMED;
        }
    }

    /// It cannot be compared with what comes unless it is confirmed.
    pub(super) fn firing_changed(&mut self) {
        if !self.is_confirmed() {
            let score = (self.score_and_solo & SCORE).min(1);
            self.phases = 0;
            self.score_and_solo = (self.score_and_solo & !SCORE) | score;
            self.close_and_flags &= CONTRADICTED;
        }
    }

    /// A later reading, or silence: its echo would have come first. It weighs the one if the track is not confirmed,
    /// the other if it is.
    pub(super) fn contradict(&mut self, bit: u16, weights: (u8, u8), settings: &TrackerSettings) {
        let weight = if self.is_confirmed() { weights.1 } else { weights.0 };
        let score = (self.score_and_solo & SCORE).saturating_sub(weight);
        if score == 0 {
            // Were it confirmed still, it would keep its place from all that come.
            self.lose(settings);
            return;
        }
        // Without its votes of solo periods.
        self.score_and_solo = score;
        self.close_and_flags |= CONTRADICTED;
        self.grow_older();
        self.miss(bit, settings);
    }

    /// Nothing speaks for it any more: it is gone, or remembered if it was confirmed.
    fn lose(&mut self, settings: &TrackerSettings) {
        if self.close_and_flags & (CONFIRMED | REMEMBERED) != 0 && self.age() < settings.memory {
            self.grow_older();
            self.phases = 0;
            self.score_and_solo = 1;
            self.close_and_flags = CONTRADICTED | REMEMBERED;
        } else {
            *self = Self::NONE;
        }
    }

    /// An earlier reading hides whether its echo came.
    pub(super) fn mask(&mut self, bit: u16, settings: &TrackerSettings) {
        self.grow_older();
        if self.is_confirmed() {
            self.miss(bit, settings);
        }
    }

    /// The last firing in this phase did not support it. One phase alone, in which a path repeats itself, keeps no
    /// track confirmed.
    #[inline(always)]
    fn miss(&mut self, bit: u16, settings: &TrackerSettings) {
        self.phases &= !bit;
        if self.is_confirmed() {
            let solo_votes = self.score_and_solo / SOLO_VOTE;
            let several_phases = self.phases & self.phases.wrapping_sub(1) != 0;
            let two_votes = several_phases || solo_votes + u8::from(self.phases != 0) >= 2;
            if !two_votes {
                self.close_and_flags &= !CONFIRMED;
                if settings.memory > 0 {
                    self.close_and_flags |= REMEMBERED;
                }
            }
        }
    }

    pub(super) fn grow_older(&mut self) {
        if self.echo_and_age & AGE != AGE {
            self.echo_and_age += 1;
        }
    }

    /// Catches up with an echo that moves faster than its support: three tenths of the way.
    pub(super) fn catch_up(&mut self, t_echo: u32) {
        let way = self.to(t_echo);
        let step = tenth(3 * way.unsigned_abs()) as i32;
        self.set_t_echo(self.t_echo().wrapping_add_signed(if way < 0 { -step } else { step }));
    }

    fn set_t_echo(&mut self, t_echo: u32) {
        self.echo_and_age = t_echo << 8 | (self.echo_and_age & AGE);
    }

    /// Delay of a reading against it, at most 65,535 us: the reading supports the track, or is near it.
    #[inline(always)]
    pub(super) const fn to(&self, t_echo: u32) -> i32 {
        t_echo.wrapping_sub(self.t_echo()) as i32
    }
}

/// A tenth, rounded down, by shifts: small processors take a hundred instructions to divide.
const fn tenth(number: u32) -> u32 {
    // Four fifths of a bit less than the number, to 32 binary places; then an eighth of that, at most one too small.
    let mut sum = (number >> 1) + (number >> 2);
    sum += sum >> 4;
    sum += sum >> 8;
    sum += sum >> 16;
    let tenth = sum >> 3;
    let rest = number - tenth * 10;
    if rest > 9 { tenth + 1 } else { tenth }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_track_takes_eight_bytes() {
        assert_eq!(size_of::<Track>(), 8);
    }

    #[test]
    fn a_tenth_by_shifts_is_a_tenth() {
        let near_powers = (0..32).flat_map(|bit| (0..200).map(move |more| (1_u32 << bit).wrapping_add(more)));
        for number in (0..400_000).chain(near_powers).chain(u32::MAX - 100_000..=u32::MAX) {
            assert_eq!(tenth(number), number / 10, "{number}");
        }
    }
}
