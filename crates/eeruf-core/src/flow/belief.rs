//! [`Belief`]: the judge of a ring that fires in turn.

use super::motion::{Motion, Rate};
use super::settings::BeliefSettings;
use crate::filter::{NO_ECHO, SILENCE, shift};
use crate::judging::{Explained, Heard, Judge, Pace, Quiet, Sounds};
use crate::reading::{Explanation, ReadingKind, Verdict};
use crate::ring_error::RingError;
use crate::time::{Instant, Micros};

/// Limit, in us, on the change since the last confirmation: beyond it a belief is dropped.
const TOO_FAR: u16 = 1_000;
/// Age of a belief that does not exist or is too old.
const NEVER: u16 = u16::MAX;
/// Marker of a missing reading or belief. Like [`SILENCE`], it is later than any echo.
const NOTHING: Micros = NO_ECHO;

/// A sensor's state: 16 bytes, and four more for each further echo.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Known<const E: usize> {
    /// The last reading, earliest echo first; or [`SILENCE`].
    last: [Micros; E],
    /// The echo that is believed, or was believed last.
    believed: Micros,
    /// The change in microseconds that a good reading may show since the belief was last confirmed.
    grown: u16,
    /// The greatest rate of change since the sensor's last firing.
    rate: Rate,
    /// Firings since the last accepted reading.
    age: u16,
    /// Firings since the belief was last confirmed; stops at 255.
    missed: u8,
    /// Number of contradictions that the belief outlasts while the robot stands still.
    conf: u8,
}

/// A judge that accepts readings that fit its belief, and two consecutive readings that agree and that nothing foreign
/// explains.
///
/// While the robot stands still, farther echoes and silence must outlast the belief. While it moves, each tolerance, P
/// included, grows with the time between two readings.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Belief<const K: usize, const E: usize = 1> {
    settings: BeliefSettings,
    motion: Motion,
    /// True if the robot moved at the last reading or, according to the last report, moves now.
    moves: bool,
    /// The quiet that the last reading calls for.
    quiet: Quiet,
    known: [Known<E>; K],
}

impl<const K: usize, const E: usize> Belief<K, E> {
    /// A judge without beliefs.
    ///
    /// # Errors
    /// [`RingError::Setting`] for a setting out of its range.
    pub const fn new(settings: BeliefSettings) -> Result<Self, RingError> {
        match settings.check() {
            Ok(()) => {
                let (motion, moves) = (Motion::new(settings.top_speed_mm_s), settings.top_speed_mm_s > 0);
                Ok(Self { settings, motion, moves, quiet: Quiet::Same, known: [Known::NOTHING; K] })
            }
            Err(error) => Err(error),
        }
    }

    pub(super) const fn pace_now(&self) -> Pace {
        Pace { moves: self.moves, every_echo: self.settings.every_echo(self.moves) }
    }

    // Rarely needed, and called from two places.
    #[inline(never)]
    fn set_moves(&mut self, moves: bool) {
        if self.moves != moves {
            self.moves = moves;
            for known in &mut self.known {
                known.conf = known.conf.min(1);
            }
        }
    }

    /// Returns how much a good reading may have changed, and adds it to the change since the belief was confirmed.
    fn grow(&mut self, heard: &Heard<'_>) -> Micros {
        let (rate, recent) = (self.motion.rate(heard.fired), self.motion.recent(heard.fired));
        self.set_moves(rate.moves());
        let Some(known) = self.known_mut(heard.sensor) else { return Micros::ZERO };
        // Sound is heard some time after it was sent, so the rate of that time counts too.
        let span = core::mem::replace(&mut known.rate, recent).max(recent).grow(heard.since_before);
        known.grown = known.grown.saturating_add(u16::try_from(span.as_micros()).unwrap_or(u16::MAX));
        span
    }

    fn known_mut(&mut self, sensor: u8) -> Option<&mut Known<E>> {
        self.known.get_mut(usize::from(sensor))
    }

    fn known(&self, sensor: u8) -> Option<&Known<E>> {
        self.known.get(usize::from(sensor))
    }
}

impl<const E: usize> Known<E> {
    const NOTHING: Self =
        Self { last: [NOTHING; E], believed: NOTHING, grown: 0, rate: Rate::STANDING, age: NEVER, missed: 0, conf: 0 };

    /// Applies this rate from now on.
    fn moves_at(&mut self, rate: Rate) {
        self.rate = self.rate.max(rate);
    }

    fn first(&self) -> Micros {
        self.last.first().copied().unwrap_or(NOTHING)
    }

    fn believes(&self) -> bool {
        self.believed != NOTHING
    }

    fn miss(&mut self) {
        self.missed = self.missed.saturating_add(1);
        self.age = if self.age == NEVER { NEVER } else { self.age.saturating_add(1).min(NEVER - 1) };
    }

    fn forget(&mut self) {
        *self = Self { age: self.age, ..Self::NOTHING };
    }

    fn verdict(&self, kind: ReadingKind, t_echo: Option<Micros>, explained_by: Option<Explanation>) -> Verdict {
        let previous = Some(self.first()).filter(|&echo| echo < SILENCE);
        Verdict { kind, t_echo, previous, age: (self.age != NEVER).then_some(self.age), explained_by }
    }

    /// Returns true if a reading fits the belief, which must not be too old. Silence is far from every echo.
    fn fits(&self, time: Micros, settings: &BeliefSettings) -> bool {
        let is_kept = self.missed == 0 || (self.missed <= settings.memory && self.grown <= TOO_FAR);
        let most = settings.near.saturating_add(Micros::new(self.grown.into()));
        self.believes() && is_kept && time.abs_diff(self.believed) <= most
    }

    /// Returns the explanation of an echo that agrees with one of the previous reading; `None` if no echo agrees.
    fn twice(&self, time: Micros, span: Micros, t_delta: Micros, sounds: &impl Sounds) -> Option<Explained> {
        let (mut explained, most) = (None, t_delta.saturating_add(span));
        for &last in self.last.iter().filter(|&&last| last < SILENCE && time.abs_diff(last) <= most) {
            explained = Some(sounds.explain_moving(last, time, span));
            if explained == Some(Explained::ByNothing) {
                break;
            }
        }
        explained
    }

    /// Judges echoes, or silence with a witness, that may have changed by `span`. Also returns the quiet that they call
    /// for.
    fn judge(
        &mut self,
        heard: &Heard<'_>,
        span: Micros,
        stands: bool,
        of: &BeliefSettings,
        sounds: &impl Sounds,
    ) -> (Verdict, Quiet) {
        let is_echo = !heard.echoes.is_empty();
        // The first echo that is believed, or else the earliest.
        let mut time = heard.echoes.first().copied().unwrap_or(SILENCE);
        let (mut fits, mut ok, mut explained_by) = (!is_echo && self.fits(SILENCE, of), !is_echo, None);
        for &echo in heard.echoes {
            fits = self.fits(echo, of);
            let twice = if fits { None } else { self.twice(echo, span, heard.t_delta, sounds) };
            if fits || twice == Some(Explained::ByNothing) {
                (time, ok, explained_by) = (echo, true, None);
                break;
            }
            explained_by = explained_by.or(twice.and_then(Explained::reason));
        }
        // Silence counts as farther than any believed echo.
        let far = !fits && self.believed < if is_echo { time } else { NOTHING };
        let mut held_back = false;
        if stands && fits {
            self.conf = self.conf.saturating_add(1).min(of.hold);
        } else if stands && far {
            self.conf = self.conf.saturating_sub(1);
            held_back = ok && self.conf > 0;
            ok &= self.conf == 0;
        }
        let before = self.first();
        let (kind, quiet);
        if ok {
            // A first silence is not a belief yet, but a moving robot has left the old obstacle behind.
            let clears = is_echo || before == SILENCE || fits || !stands;
            if clears {
                if !fits {
                    self.conf = 1;
                }
                (self.believed, self.grown, self.missed) = (time, 0, 0);
            }
            kind = match (is_echo, clears) {
                (true, _) => ReadingKind::Accepted,
                (false, true) => ReadingKind::Clear,
                (false, false) => ReadingKind::NoEcho,
            };
            quiet = Quiet::Less;
        } else {
            kind = match () {
                () if !is_echo => ReadingKind::NoEcho,
                () if explained_by.is_some() => ReadingKind::Ambiguous,
                // An echo that the belief outlasts.
                () if held_back => ReadingKind::Repeated,
                () if before >= SILENCE && !self.believes() => ReadingKind::First,
                () => ReadingKind::Rejected,
            };
            // Readings of a moving robot differ anyway: quiet that did not help twice is dropped, then tried again.
            let lets_go = !stands && !of.every_echo(true) && self.missed & 2 != 0;
            quiet = match is_echo && !far {
                false => Quiet::Same,
                true if !lets_go && sounds.is_masked(time) => Quiet::More,
                // Quiet does not help against sound that the ring did not fire.
                true => Quiet::Less,
            };
        }
        if kind == ReadingKind::Accepted {
            self.age = 0;
        }
        let verdict = self.verdict(kind, is_echo.then_some(time), explained_by);
        if !ok {
            self.miss();
        }
        self.last = [NOTHING; E];
        for (last, &echo) in self.last.iter_mut().zip(if is_echo { heard.echoes } else { &[SILENCE] }) {
            *last = echo;
        }
        (verdict, quiet)
    }
}

impl<const K: usize, const E: usize> Judge for Belief<K, E> {
    fn t_delta(&self) -> Micros {
        self.settings.t_delta
    }

    fn judge(&mut self, heard: &Heard<'_>, sounds: &impl Sounds) -> Verdict {
        let span = self.grow(heard);
        let (stands, settings) = (!self.moves, self.settings);
        let Some(known) = self.known_mut(heard.sensor) else { return heard.unjudged(None) };
        let (verdict, quiet) = known.judge(heard, span, stands, &settings, sounds);
        let every_echo = verdict.t_echo.is_some() && settings.every_echo(!stands);
        if every_echo {
            known.age = 0;
        }
        self.quiet = quiet;
        if every_echo {
            return Verdict { kind: ReadingKind::Accepted, age: Some(0), explained_by: None, ..verdict };
        }
        verdict
    }

    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict {
        self.grow(heard);
        self.quiet = Quiet::Same;
        let Some(known) = self.known_mut(heard.sensor) else { return heard.unjudged(Some(kind)) };
        let verdict = known.verdict(kind, heard.echoes.first().copied(), None);
        known.miss();
        known.last = [NOTHING; E];
        verdict
    }

    fn hold(&mut self, heard: &Heard<'_>) {
        self.grow(heard);
        self.quiet = Quiet::Same;
        if let Some(known) = self.known_mut(heard.sensor).filter(|known| known.first() != SILENCE) {
            known.last = [NOTHING; E];
        }
    }

    fn age(&self, sensor: u8) -> Option<u16> {
        self.known(sensor).map(|known| known.age).filter(|&age| age != NEVER)
    }

    fn is_clear(&self, sensor: u8) -> bool {
        self.known(sensor).is_some_and(|known| known.believed == SILENCE && known.missed == 0)
    }

    fn believed(&self, sensor: u8) -> Option<Micros> {
        let known = self.known(sensor).filter(|known| known.missed <= self.settings.memory)?;
        Some(known.believed).filter(|&believed| believed < SILENCE)
    }

    fn moving(&mut self, speed_mm_s: u32, turn_mrad_s: u32, now: Instant) {
        let rate = self.motion.set(speed_mm_s, turn_mrad_s, now);
        for known in &mut self.known {
            known.moves_at(rate);
        }
        let now = self.motion.rate(now);
        self.set_moves(now.moves());
    }

    fn pace(&self) -> Pace {
        self.pace_now()
    }

    fn quiet(&self) -> Quiet {
        self.quiet
    }

    fn forget(&mut self, sensor: u8) {
        if let Some(known) = self.known_mut(sensor) {
            known.forget();
        }
    }

    fn resume(&mut self, sensor: u8) {
        if let Some(known) = self.known_mut(sensor) {
            (known.last, known.missed) = ([NOTHING; E], known.missed.max(1));
        }
    }

    fn restart(&mut self) {
        for known in &mut self.known {
            known.forget();
        }
    }

    fn fired_later(&mut self, sensor: u8, later_us: i32) {
        let Some(known) = self.known_mut(sensor).filter(|known| known.first() < SILENCE) else { return };
        shift(&mut known.last, later_us);
        if known.missed == 0 {
            // The believed echo is one of that firing.
            shift(core::array::from_mut(&mut known.believed), later_us);
        }
    }
}
