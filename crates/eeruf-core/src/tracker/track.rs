//! [`Track`]: one echo time that a sensor may have, and how sure the tracker is of it.

use super::settings::TrackerSettings;
use crate::filter::NO_ECHO;

/// One hypothesis about a sensor: that its own echo comes at this time.
///
/// It is *tentative* until enough phases support it, then *confirmed*; while nothing supports it, it *coasts*.
#[derive(Clone, Copy, Debug)]
pub(super) struct Track {
    /// In microseconds; [`NO_ECHO`] is the hypothesis that nothing is in range.
    pub(super) t_echo: u32,
    /// The phases, modulo 16, in which it was supported when the sensor last heard something that could tell. Phases
    /// that share a bit count once, so a cycle longer than 16 phases only makes the rule stricter.
    phases: u16,
    /// Votes that came from solo periods beyond their phases' own.
    solo_votes: u8,
    /// 0: there is no track.
    score: u8,
    /// Phases that supported it closely.
    close: u8,
    flags: u8,
    /// Firings since it was last supported.
    pub(super) age: u8,
}

const CONFIRMED: u8 = 1;
const CONTRADICTED: u8 = 2;

const fn bit(phase: u8) -> u16 {
    1 << (phase & 15)
}

impl Track {
    pub(super) const NONE: Self =
        Self { t_echo: NO_ECHO, phases: 0, solo_votes: 0, score: 0, close: 0, flags: 0, age: u8::MAX };

    /// After the first reading at this time.
    pub(super) const fn new(t_echo: u32, phase: u8, solo: bool) -> Self {
        let score = if solo { 2 } else { 1 };
        Self { t_echo, phases: bit(phase), solo_votes: score - 1, score, close: 1, flags: 0, age: 0 }
    }

    pub(super) const fn exists(&self) -> bool {
        self.score != 0
    }

    pub(super) const fn is_silence(&self) -> bool {
        self.t_echo == NO_ECHO
    }

    pub(super) const fn is_confirmed(&self) -> bool {
        self.flags & CONFIRMED != 0
    }

    /// How many phases supported it closely, unless it was ever contradicted.
    pub(super) const fn close_votes(&self) -> u8 {
        if self.flags & CONTRADICTED == 0 { self.close } else { 0 }
    }

    /// What is replaced first: the less, the sooner.
    pub(super) fn rank(&self) -> (bool, u8, u8) {
        (self.is_confirmed(), self.score, u8::MAX - self.age)
    }

    /// How far a reading is from it.
    pub(super) const fn distance(&self, t_echo: u32) -> u32 {
        self.t_echo.abs_diff(t_echo)
    }

    /// Moves with the robot, by this many microseconds.
    pub(super) fn shift(&mut self, change_us: i32) {
        if !self.is_silence() {
            self.t_echo = self.t_echo.saturating_add_signed(change_us).min(NO_ECHO - 1);
        }
    }

    /// A reading within `t_delta` of it.
    pub(super) fn support(&mut self, t_echo: u32, phase: u8, solo: bool, settings: &TrackerSettings) {
        let new = self.phases & bit(phase) == 0;
        let is_close = self.distance(t_echo) <= settings.tentative_within.as_micros();
        self.close = self.close.saturating_add(u8::from(new && is_close));
        self.phases |= bit(phase);
        self.solo_votes = (self.solo_votes + u8::from(solo)).min(settings.votes);
        // A path repeats itself in its own phase for ever, so that says nothing new of a track yet to be confirmed.
        if new || solo || self.is_confirmed() {
            self.score = (self.score + 1 + u8::from(solo)).min(settings.score_limit);
        }
        self.age = 0;
        if !self.is_silence() {
            // A quarter of the way, so that one early or late edge does not move it far.
            self.t_echo = self.t_echo.wrapping_add_signed(self.to(t_echo) / 4);
        }
        if self.votes() >= settings.votes && self.score >= settings.votes {
            self.flags |= CONFIRMED;
        }
    }

    /// It cannot be compared with what comes unless it is confirmed.
    pub(super) fn firing_changed(&mut self) {
        if !self.is_confirmed() {
            (self.phases, self.close, self.score) = (0, 0, self.score.min(1));
        }
    }

    /// A later reading, or silence: its echo would have come first.
    pub(super) fn contradict(&mut self, phase: u8, solo: bool, settings: &TrackerSettings) {
        let weight = match (solo, self.is_confirmed()) {
            (true, _) => settings.solo_contradiction,
            (false, true) => settings.contradiction,
            (false, false) => 1,
        };
        self.score = self.score.saturating_sub(weight);
        self.flags |= CONTRADICTED;
        self.solo_votes = 0;
        self.grow_older();
        self.miss(phase);
    }

    /// An earlier reading hides whether its echo came.
    pub(super) fn mask(&mut self, phase: u8) {
        self.grow_older();
        if self.is_confirmed() {
            self.miss(phase);
        }
    }

    /// The last firing in this phase did not support it. One phase alone, in which a path repeats itself, keeps no
    /// track confirmed.
    fn miss(&mut self, phase: u8) {
        self.phases &= !bit(phase);
        if self.votes() < 2 {
            self.flags &= !CONFIRMED;
        }
    }

    pub(super) fn grow_older(&mut self) {
        self.age = self.age.saturating_add(1);
    }

    /// Follows an echo that moves faster than its support: three tenths of the way.
    pub(super) fn follow(&mut self, t_echo: u32) {
        self.t_echo = self.t_echo.wrapping_add_signed(self.to(t_echo) * 3 / 10);
    }

    /// How much later a reading is, which is at most 65,535 us: it supports the track, or is near it. In 32 bits, since
    /// small processors take a thousand instructions to divide longer numbers.
    const fn to(&self, t_echo: u32) -> i32 {
        t_echo.wrapping_sub(self.t_echo) as i32
    }

    const fn votes(&self) -> u8 {
        self.phases.count_ones() as u8 + self.solo_votes
    }
}
