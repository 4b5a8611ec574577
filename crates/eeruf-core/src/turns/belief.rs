//! [`Belief`]: what readings of a ring that fires in turn are worth.

use super::motion::{Motion, Rate};
use super::settings::BeliefSettings;
use crate::filter::NO_ECHO;
use crate::judging::{Heard, Judge, Quiet, Sounds};
use crate::reading::{Explanation, ReadingKind, Verdict};
use crate::ring_error::RingError;
use crate::time::{Instant, Micros};

/// A belief that has missed readings ends where a good one may have changed by more than this.
const TOO_FAR: Micros = Micros::from_millis(1);
/// Nothing was ever accepted, or so long ago.
const NEVER: u16 = u16::MAX;

/// An echo time, or silence ([`NO_ECHO`]), of a firing.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Echo {
    fired: Instant,
    time: Micros,
    /// The greatest rate since.
    rate: Rate,
}

const SILENCE: Echo = Echo { fired: Instant::from_micros(0), time: NO_ECHO, rate: Rate::STANDING };

/// A sensor's state.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Known {
    last: Echo,
    believed: Echo,
    /// Firings since the belief was last confirmed; stops at 255, as it begins.
    missed: u8,
    /// Contradictions that the belief outlasts while the robot stands.
    conf: u8,
    /// The last firing was silent, with a witness.
    silent: bool,
    /// There is a belief, however old.
    believes: bool,
    quiet: Quiet,
    /// Firings since the last accepted reading.
    age: u16,
}

/// A judge that believes what fits its belief, and what two readings in a row say that nothing foreign explains.
///
/// Standing, what is farther than the belief, or silence, must outlast it. Moving, each tolerance grows with the time
/// between two readings, P too.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Belief<const K: usize> {
    settings: BeliefSettings,
    motion: Motion,
    /// The robot moved at the last reading.
    moved: bool,
    known: [Known; K],
}

impl<const K: usize> Belief<K> {
    const NOTHING: Known = Known {
        last: SILENCE,
        believed: SILENCE,
        missed: u8::MAX,
        conf: 0,
        silent: false,
        believes: false,
        quiet: Quiet::Same,
        age: NEVER,
    };

    /// A judge that knows nothing yet.
    ///
    /// # Errors
    /// [`RingError::Setting`] for a setting out of its range.
    pub const fn new(settings: BeliefSettings) -> Result<Self, RingError> {
        match settings.check() {
            Ok(()) => {
                let motion = Motion::new(settings.top_speed_mm_s);
                Ok(Self { settings, motion, moved: false, known: [Self::NOTHING; K] })
            }
            Err(error) => Err(error),
        }
    }

    /// Takes in the rate that holds at a firing; `true` if the robot stands.
    fn stands(&mut self, sensor: u8, fired: Instant) -> bool {
        let rate = self.motion.rate(fired);
        if self.moved != rate.moves() {
            self.moved = rate.moves();
            for known in &mut self.known {
                known.conf = known.conf.min(1);
            }
        }
        if let Some(known) = self.known.get_mut(usize::from(sensor)) {
            known.last.rate = known.last.rate.max(rate);
            known.believed.rate = known.believed.rate.max(rate);
        }
        !rate.moves()
    }
}

impl Known {
    /// The change that a good reading may show since an earlier one.
    fn grow(&self, since: &Echo, fired: Instant) -> Micros {
        since.rate.grow(fired.since(since.fired))
    }

    fn miss(&mut self) {
        self.missed = self.missed.saturating_add(1);
        self.age = if self.age == NEVER { NEVER } else { self.age.saturating_add(1).min(NEVER - 1) };
    }

    fn verdict(&self, kind: ReadingKind, t_echo: Option<Micros>, explained_by: Option<Explanation>) -> Verdict {
        let previous = (self.last.time != NO_ECHO).then_some(self.last.time);
        Verdict { kind, t_echo, previous, age: (self.age != NEVER).then_some(self.age), explained_by }
    }

    /// Returns true if a reading fits the belief, which must not be too old.
    fn fits(&self, time: Micros, fired: Instant, settings: &BeliefSettings) -> bool {
        if !self.believes || self.missed > settings.memory {
            return false;
        }
        let grown = self.grow(&self.believed, fired);
        if self.missed > 0 && grown > TOO_FAR {
            return false;
        }
        match (time, self.believed.time) {
            (NO_ECHO, NO_ECHO) => true,
            (NO_ECHO, _) | (_, NO_ECHO) => false,
            (time, believed) => time.abs_diff(believed) <= settings.near.saturating_add(grown),
        }
    }

    /// Judges an echo, or silence with a witness.
    fn judge(&mut self, heard: &Heard<'_>, stands: bool, settings: &BeliefSettings, sounds: &impl Sounds) -> Verdict {
        let (fired, time) = (heard.fired, heard.echoes.first().copied().unwrap_or(NO_ECHO));
        let is_echo = time != NO_ECHO;
        let fits = self.fits(time, fired, settings);
        let mut explained_by = None;
        let mut ok = fits || !is_echo;
        if !ok && self.last.time != NO_ECHO {
            let grown = self.grow(&self.last, fired);
            if time.abs_diff(self.last.time) <= heard.t_delta.saturating_add(grown) {
                explained_by = sounds.explain_moving(self.last.time, time, grown).reason();
                ok = explained_by.is_none();
            }
        }
        let far = self.believes && !fits && (!is_echo || (self.believed.time != NO_ECHO && time > self.believed.time));
        let mut held_back = false;
        if stands && self.believes {
            if fits {
                self.conf = self.conf.saturating_add(1).min(settings.hold);
            } else if far {
                self.conf = self.conf.saturating_sub(1);
                held_back = ok && self.conf > 0;
                ok &= self.conf == 0;
            }
        }
        // The first silence in a row leaves an obstacle standing.
        let stays = !is_echo && self.believes && self.believed.time != NO_ECHO && !self.silent;
        let kind = match (ok, is_echo) {
            (true, true) => ReadingKind::Accepted,
            (true, false) if self.silent => ReadingKind::Clear,
            (_, false) => ReadingKind::NoEcho,
            _ if explained_by.is_some() => ReadingKind::Ambiguous,
            // An echo that the belief outlasts.
            _ if held_back => ReadingKind::Repeated,
            _ if self.last.time == NO_ECHO && !self.believes => ReadingKind::First,
            _ => ReadingKind::Rejected,
        };
        if kind == ReadingKind::Accepted {
            self.age = 0;
        }
        let verdict = self.verdict(kind, is_echo.then_some(time), explained_by);
        if ok {
            self.quiet = Quiet::Less;
            if !stays {
                if !fits {
                    self.conf = 1;
                }
                self.believed = Echo { fired, time, rate: Rate::STANDING };
                (self.believes, self.missed) = (true, 0);
            }
        } else {
            self.miss();
            self.quiet = if is_echo && !far && sounds.is_masked(time) { Quiet::More } else { Quiet::Same };
        }
        self.last = Echo { fired, time, rate: Rate::STANDING };
        self.silent = !is_echo;
        verdict
    }
}

impl<const K: usize> Judge for Belief<K> {
    fn t_delta(&self) -> Micros {
        self.settings.t_delta
    }

    fn judge(&mut self, heard: &Heard<'_>, sounds: &impl Sounds) -> Verdict {
        let (stands, settings) = (self.stands(heard.sensor, heard.fired), self.settings);
        match self.known.get_mut(usize::from(heard.sensor)) {
            Some(known) => known.judge(heard, stands, &settings, sounds),
            None => heard.unjudged(None),
        }
    }

    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict {
        match self.known.get_mut(usize::from(heard.sensor)) {
            Some(known) => {
                let verdict = known.verdict(kind, heard.echoes.first().copied(), None);
                known.miss();
                (known.last, known.silent, known.quiet) = (SILENCE, false, Quiet::Same);
                verdict
            }
            None => heard.unjudged(Some(kind)),
        }
    }

    fn age(&self, sensor: u8) -> Option<u16> {
        self.known.get(usize::from(sensor)).map(|known| known.age).filter(|&age| age != NEVER)
    }

    fn is_clear(&self, sensor: u8) -> bool {
        let known = self.known.get(usize::from(sensor));
        known.is_some_and(|known| known.believes && known.believed.time == NO_ECHO && known.missed == 0)
    }

    fn believed(&self, sensor: u8) -> Option<Micros> {
        let known = self.known.get(usize::from(sensor))?;
        let holds = known.believes && known.missed <= self.settings.memory && known.believed.time != NO_ECHO;
        holds.then_some(known.believed.time)
    }

    fn moving(&mut self, speed_mm_s: u32, turn_mrad_s: u32, now: Instant) -> bool {
        self.motion.set(speed_mm_s, turn_mrad_s, now);
        let rate = self.motion.rate(now);
        for known in &mut self.known {
            known.last.rate = known.last.rate.max(rate);
            known.believed.rate = known.believed.rate.max(rate);
        }
        rate.moves()
    }

    fn quiet(&self, sensor: u8) -> Quiet {
        self.known.get(usize::from(sensor)).map_or(Quiet::Same, |known| known.quiet)
    }

    fn forget(&mut self, sensor: u8) {
        if let Some(known) = self.known.get_mut(usize::from(sensor)) {
            *known = Known { age: known.age, ..Self::NOTHING };
        }
    }

    fn restart(&mut self) {
        for known in &mut self.known {
            *known = Known { age: known.age, ..Self::NOTHING };
        }
    }

    fn fired_later(&mut self, sensor: u8, later_us: i32) {
        if let Some(known) = self.known.get_mut(usize::from(sensor)) {
            let fired = known.last.fired;
            for echo in [&mut known.last, &mut known.believed] {
                if echo.time != NO_ECHO && echo.fired == fired {
                    let time = i64::from(echo.time.as_micros()) - i64::from(later_us);
                    echo.time = Micros::new(time.clamp(0, i64::from(NO_ECHO.as_micros() - 1)) as u32);
                    echo.fired = Instant::from_micros(fired.as_micros().wrapping_add_signed(later_us));
                }
            }
        }
    }
}
