//! [`Tracker`]: compares the echoes of a sensor's firing with those it knows, and says what the reading is worth.

use super::echoes::{NO_ECHO, echo_time};
use super::rule::Rule;
use super::state::TrackState;
use crate::reading::{ReadingKind, Verdict};
use crate::time::Micros;

/// The age of a sensor none of whose readings was ever accepted.
const NEVER: u16 = u16::MAX;

/// The tracks of one sensor's echoes: eight bytes where it reports one echo.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Tracker<const E: usize> {
    /// The echoes to compare with, earliest first: those of the firing before, and those whose tracks coast.
    /// [`NO_ECHO`] stands for silence where it has a track.
    known: [u32; E],
    states: [TrackState; E],
    /// For the owner: the ring keeps its flags in this byte, which would otherwise be padding.
    pub(crate) flags: u8,
    /// Firings since the last accepted reading.
    age: u16,
}

impl<const E: usize> Tracker<E> {
    pub(crate) const fn new(flags: u8) -> Self {
        Self { known: [NO_ECHO; E], states: [TrackState::NONE; E], flags, age: NEVER }
    }

    pub(crate) fn forget(&mut self) {
        self.known = [NO_ECHO; E];
        self.states = [TrackState::NONE; E];
    }

    /// A firing that says nothing about the echo time: all tracks end, and the age grows.
    pub(crate) fn skip(&mut self, kind: ReadingKind, t_echo: Option<Micros>) -> Verdict {
        self.forget();
        self.verdict(kind, t_echo, None)
    }

    /// Compares the echoes of one firing, earliest first, with those that are known.
    pub(crate) fn push(&mut self, rule: Rule, echoes: &[u32; E], expected_change_us: i32) -> Verdict {
        let before = core::mem::replace(&mut self.known, *echoes);
        let states = core::mem::replace(&mut self.states, [TrackState::NONE; E]);
        let known = || before.iter().copied().zip(states).take_while(|(_, state)| *state != TrackState::NONE);
        let earliest = echoes.first().copied().unwrap_or(NO_ECHO);
        let earliest_before = before.first().copied().and_then(echo_time);

        // Silence counts as an echo of its own, later than all others.
        let silent = earliest == NO_ECHO;
        let heard = echoes.iter().copied().enumerate().take_while(|&(place, echo)| echo != NO_ECHO || place == 0);
        // The earliest with a confirmed track, or else the earliest that repeats.
        let mut best = (TrackState::NEW, earliest, earliest_before);
        for ((_, echo), now) in heard.clone().zip(&mut self.states) {
            *now = TrackState::NEW;
            for (previous, state) in known() {
                if rule.near_identical(echo, previous, expected_change_us) {
                    *now = (*now).max(state.seen(rule.agreement));
                    if best.0 == TrackState::NEW || (now.is_confirmed() && !best.0.is_confirmed()) {
                        best = (*now, echo, echo_time(previous));
                    }
                }
            }
        }
        if E > 1 && rule.agreement.patience() > 0 {
            for (previous, state) in known() {
                let missing = state.missed();
                let is_it = |(_, echo)| rule.near_identical(echo, previous, expected_change_us);
                if !missing.is_confirmed() || heard.clone().any(is_it) {
                    continue;
                }
                let expected = match previous {
                    NO_ECHO => NO_ECHO,
                    previous => previous.saturating_add_signed(expected_change_us).min(NO_ECHO - 1),
                };
                if best.0.is_confirmed() && expected < best.1 {
                    best = (TrackState::NEW, earliest, echo_time(previous));
                }
                self.coast(expected, missing);
            }
        }
        let kind = match best.0 {
            state if state.is_confirmed() => {
                if silent {
                    ReadingKind::Clear
                } else {
                    ReadingKind::Accepted
                }
            }
            _ if silent => ReadingKind::NoEcho,
            _ if earliest_before.is_none() => ReadingKind::First,
            TrackState::NEW => ReadingKind::Rejected,
            _ => ReadingKind::Repeated,
        };
        self.verdict(kind, echo_time(best.1), best.2)
    }

    /// Lets the track of a missing echo coast, unless earlier echoes fill all places.
    fn coast(&mut self, echo: u32, state: TrackState) {
        let free = |(&known, &state): (&u32, &TrackState)| echo < known || state == TrackState::NONE;
        let Some(place) = self.known.iter().zip(&self.states).position(free) else { return };
        if let (Some(known), Some(states)) = (self.known.get_mut(place..), self.states.get_mut(place..)) {
            known.rotate_right(1);
            states.rotate_right(1);
            if let (Some(known), Some(held)) = (known.first_mut(), states.first_mut()) {
                (*known, *held) = (echo, state);
            }
        }
    }

    fn verdict(&mut self, kind: ReadingKind, t_echo: Option<Micros>, previous: Option<Micros>) -> Verdict {
        self.age = match kind {
            ReadingKind::Accepted => 0,
            _ if self.age >= NEVER - 1 => self.age,
            _ => self.age + 1,
        };
        Verdict { kind, t_echo, previous, age: self.age() }
    }

    pub(crate) fn age(&self) -> Option<u16> {
        (self.age != NEVER).then_some(self.age)
    }
}
