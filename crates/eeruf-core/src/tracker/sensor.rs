//! [`SensorTracks`]: the tracks of one sensor, and what a reading does to them.

use super::settings::TrackerSettings;
use super::track::{LATEST, SILENCE, Track, bit};
use crate::judging::Firing;
use crate::reading::{ReadingKind, Verdict};
use crate::schedule::Phase;
use crate::time::Micros;

/// No track is confirmed: later than [`SILENCE`], and no reading is near it.
pub(super) const NOTHING: u32 = u32::MAX;

/// The age of a sensor none of whose readings was ever accepted.
const NEVER: u16 = u16::MAX;

/// Properties of one firing of a sensor beside the echo time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Heard {
    pub(super) t_echo: u32,
    pub(super) phase: u8,
    pub(super) solo: bool,
    pub(super) steady: bool,
    pub(super) change_us: i32,
}

impl Heard {
    #[inline(always)]
    pub(super) fn new(t_echo: Option<Micros>, firing: Firing) -> Self {
        let Firing { phase: Phase(phase), solo, steady, expected_change_us } = firing;
        let t_echo = t_echo.map_or(SILENCE, |t_echo| t_echo.as_micros().min(LATEST));
        Self { t_echo, phase, solo, steady, change_us: expected_change_us }
    }
}

/// The hypotheses about one sensor.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct SensorTracks<const H: usize> {
    pub(super) tracks: [Track; H],
    /// Firings since the last accepted reading.
    age: u16,
    /// The excess over the expected change, in 1/64 of it, that consecutive readings showed so far:
    /// a wall that it sees at a slant comes nearer more slowly than one straight ahead, or faster.
    surplus: i8,
    /// The surplus that two consecutive readings showed last, or [`UNKNOWN`].
    observed: i8,
    /// Its last reading; [`SILENCE`] also if that said nothing.
    last: u32,
}

/// As much more as is expected: a surplus is between none at all and twice as much.
const WHOLE: u32 = 64;

/// Two readings that show a surplus beyond this, of either sign, are not of one echo.
const MOST_SURPLUS: u32 = WHOLE + WHOLE / 4;

/// Readings that show no surplus.
const UNKNOWN: i8 = i8::MIN;

/// A smaller change, in microseconds, tells nothing of how much of it there is, and no robot makes a larger one.
const LEAST_CHANGE_US: u32 = 40;
const MOST_CHANGE_US: u32 = i16::MAX as u32;

impl<const H: usize> SensorTracks<H> {
    pub(super) const NEW: Self =
        Self { tracks: [Track::NONE; H], age: NEVER, surplus: 0, observed: UNKNOWN, last: SILENCE };

    pub(super) fn forget(&mut self) {
        *self = Self { age: self.age, ..Self::NEW };
    }

    pub(super) fn firing_changed(&mut self) {
        for track in &mut self.tracks {
            track.firing_changed();
        }
    }

    /// All tracks move with the robot, by the expected change and what there is more of it.
    #[inline(always)]
    pub(super) fn shift(&mut self, expected_us: i32) {
        if expected_us != 0 {
            self.shift_tracks(expected_us);
        }
    }

    #[inline(never)]
    fn shift_tracks(&mut self, expected_us: i32) {
        let most = if expected_us < 0 { i16::MIN } else { i16::MAX };
        let expected_us = i32::from(i16::try_from(expected_us).unwrap_or(most));
        let change_us = expected_us + expected_us * i32::from(self.surplus) / WHOLE as i32;
        for track in &mut self.tracks {
            track.shift(change_us);
        }
    }

    /// Two pairs of consecutive readings that change alike tell how much of the expected change there really is,
    /// whatever they support: with a wrong share the second would not support what the first did. Crosstalk changes
    /// otherwise from each phase to the next, by more than `t_delta`, where the code is Welch's.
    pub(super) fn learn(&mut self, t_echo: u32, expected_us: i32, t_delta: Micros) {
        let last = core::mem::replace(&mut self.last, t_echo);
        let observed = Self::surplus_of(last, t_echo, expected_us);
        if observed == UNKNOWN {
            return;
        }
        let before = core::mem::replace(&mut self.observed, observed);
        if before == UNKNOWN {
            return;
        }
        let differs = u32::from(observed.abs_diff(before));
        if differs * expected_us.unsigned_abs() <= WHOLE * t_delta.as_micros() {
            let surplus = i32::from(self.surplus);
            let learned = surplus + (i32::from(observed) - surplus) / 2;
            self.surplus = learned.clamp(-(WHOLE as i32), WHOLE as i32) as i8;
        }
    }

    /// The surplus that two consecutive readings of one echo show, or [`UNKNOWN`].
    fn surplus_of(last: u32, t_echo: u32, expected_us: i32) -> i8 {
        let expected = expected_us.unsigned_abs();
        if !(LEAST_CHANGE_US..=MOST_CHANGE_US).contains(&expected) || t_echo == SILENCE || last == SILENCE {
            return UNKNOWN;
        }
        // Times have 24 bits, the products 30.
        let mut rest = WHOLE * t_echo.abs_diff(last);
        if rest >= (WHOLE + MOST_SURPLUS + 1) * expected {
            return UNKNOWN;
        }
        // By shifts: small processors take a hundred instructions to divide.
        let (mut share, mut bit) = (0, 128);
        while bit > 0 {
            if rest >= bit * expected {
                rest -= bit * expected;
                share += bit as i32;
            }
            bit /= 2;
        }
        let share = if (t_echo < last) == (expected_us < 0) { share } else { -share };
        let surplus = share - WHOLE as i32;
        if surplus < -(MOST_SURPLUS as i32) { UNKNOWN } else { surplus as i8 }
    }

    /// Takes in a firing with its echoes, earliest first, of a sensor that reports up to `E`.
    #[inline(always)]
    pub(super) fn push_all<const E: usize>(
        &mut self,
        echoes: &[Micros],
        firing: Firing,
        t_delta: Micros,
        settings: &TrackerSettings,
    ) -> Verdict {
        if E == 1 {
            self.push(Heard::new(echoes.first().copied(), firing), t_delta, settings)
        } else {
            self.push_several::<E>(echoes, firing, t_delta, settings)
        }
    }

    /// Takes in the one reading of a firing, which supports tracks within `t_delta`.
    fn push(&mut self, heard: Heard, t_delta: Micros, settings: &TrackerSettings) -> Verdict {
        let Heard { t_echo, phase, solo, steady, change_us } = heard;
        let phase = bit(phase);
        self.learn(t_echo, change_us, t_delta);
        self.shift(change_us);
        let (mut confirmed, nearest) = self.confirmed_and_nearest(t_echo, t_delta.as_micros());
        let near = settings.near.as_micros();
        let is_near = confirmed.abs_diff(t_echo) <= near;
        let previous = self.tracks.get(nearest).map_or(confirmed, Track::t_echo);
        let reports_tentative = settings.tentative_votes != 0;
        let moving = change_us != 0;
        let settings = &settings.for_motion(moving);
        let tentative_votes = settings.tentative_votes_if(moving);
        let mut tentative = false;
        if steady {
            let before = core::mem::replace(&mut confirmed, NOTHING);
            let weights = settings.contradictions(solo);
            for (place, track) in self.tracks.iter_mut().enumerate() {
                if !track.exists() {
                    continue;
                }
                let at = track.t_echo();
                if place == nearest {
                    track.support(t_echo, phase, solo, settings);
                    let earlier = track.t_echo() < before.min(SILENCE);
                    let enough = solo || track.close_votes() >= tentative_votes;
                    tentative = earlier && reports_tentative && enough;
                } else if is_near && at == before {
                    track.grow_older();
                    track.catch_up(t_echo);
                } else if t_echo > at {
                    track.contradict(phase, weights, settings);
                } else {
                    track.mask(phase, settings);
                }
                confirmed = confirmed.min(track.confirmed());
            }
            if nearest == H && !is_near {
                if self.begin(t_echo, phase, solo).is_confirmed() {
                    confirmed = self.confirmed();
                }
                tentative = solo && reports_tentative && t_echo != SILENCE;
            }
        }
        let is_confirmed = confirmed.abs_diff(t_echo) <= near;
        let kind = kind_of(t_echo, is_confirmed, tentative, previous);
        self.verdict(kind, duration(t_echo), duration(previous))
    }

    /// A firing that says nothing about the echo time.
    pub(super) fn skip(&mut self, kind: ReadingKind, t_echo: Option<Micros>, change_us: i32) -> Verdict {
        self.last = SILENCE;
        self.shift(change_us);
        self.verdict(kind, t_echo, None)
    }

    /// Returns true if it is confirmed that nothing is in range.
    pub(super) fn is_clear(&self) -> bool {
        self.confirmed() == SILENCE
    }

    /// Returns true if something is confirmed and an echo comes before it, silence too.
    pub(super) fn comes_before_belief(&self, t_echo: Micros) -> bool {
        let confirmed = self.confirmed();
        // No echo is as late as silence.
        confirmed != NOTHING && t_echo.as_micros().min(LATEST) < confirmed
    }

    /// The echo time that counts now; `None` if none is confirmed, and if it is confirmed that nothing is in range.
    pub(super) fn reference(&self) -> Option<Micros> {
        duration(self.confirmed())
    }

    /// The earliest confirmed track, [`SILENCE`] among them, or [`NOTHING`].
    pub(super) fn confirmed(&self) -> u32 {
        let mut earliest = NOTHING;
        for track in &self.tracks {
            if track.is_confirmed() {
                earliest = earliest.min(track.t_echo());
            }
        }
        earliest
    }

    /// The [confirmed](Self::confirmed) track, and the place of the track that is nearest to a reading and within
    /// `t_delta` of it, or `H`.
    #[inline(always)]
    pub(super) fn confirmed_and_nearest(&self, t_echo: u32, t_delta: u32) -> (u32, usize) {
        let (mut confirmed, mut nearest, mut within) = (NOTHING, H, t_delta + 1);
        for (place, track) in self.tracks.iter().enumerate() {
            if !track.exists() {
                continue;
            }
            if track.is_confirmed() {
                confirmed = confirmed.min(track.t_echo());
            }
            let distance = track.distance(t_echo);
            if distance < within {
                (nearest, within) = (place, distance);
            }
        }
        (confirmed, nearest)
    }

    /// Begins a track in the place of the weakest, which is returned.
    pub(super) fn begin(&mut self, t_echo: u32, phase: u16, solo: bool) -> Track {
        let weakest = self.tracks.iter_mut().min_by_key(|track| track.rank());
        weakest.map_or(Track::NONE, |weakest| core::mem::replace(weakest, Track::new(t_echo, phase, solo)))
    }

    pub(super) fn verdict(&mut self, kind: ReadingKind, t_echo: Option<Micros>, previous: Option<Micros>) -> Verdict {
        self.age = match kind {
            ReadingKind::Accepted | ReadingKind::Tentative => 0,
            _ if self.age >= NEVER - 1 => self.age,
            _ => self.age + 1,
        };
        Verdict { kind, t_echo, previous, age: self.age(), explained_by: None }
    }

    pub(super) fn age(&self) -> Option<u16> {
        (self.age != NEVER).then_some(self.age)
    }
}

/// The kind of a reading by whether it is confirmed or tentative, and by what it was compared with.
#[inline(always)]
pub(super) const fn kind_of(t_echo: u32, is_confirmed: bool, is_tentative: bool, previous: u32) -> ReadingKind {
    match (is_confirmed, t_echo == SILENCE) {
        (true, true) => ReadingKind::Clear,
        (true, false) => ReadingKind::Accepted,
        (false, true) => ReadingKind::NoEcho,
        (false, false) if is_tentative => ReadingKind::Tentative,
        (false, false) if previous == NOTHING => ReadingKind::First,
        (false, false) => ReadingKind::Rejected,
    }
}

/// A track's time, unless there is none or it is silence.
pub(super) fn duration(t_echo: u32) -> Option<Micros> {
    (t_echo < SILENCE).then_some(Micros::new(t_echo))
}
