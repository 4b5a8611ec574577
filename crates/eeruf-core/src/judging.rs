//! [`Judge`]: what a ring asks of whatever decides what a reading is worth.

use crate::reading::{Explanation, ReadingKind, Verdict};
use crate::schedule::Phase;
use crate::time::{Instant, Micros};

/// A firing as a plan tells it to a judge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Firing {
    /// The phase of the schedule in which the sensor fired.
    pub phase: Phase,
    /// True if no other sensor's sound could be heard.
    pub solo: bool,
    /// True if firings were punctual enough that crosstalk moved as the schedule says. An echo of a firing that was not
    /// supports nothing.
    pub steady: bool,
    /// Expected change of a good reading since this sensor's firing before, in microseconds, if it comes from straight
    /// ahead: `-2 d / c` for a sensor carried forward by `d`. What part of it there really is the tracker learns for
    /// each sensor, from none to twice: walls seen at a slant change otherwise.
    pub expected_change_us: i32,
}

impl Firing {
    /// An ordinary, punctual firing in this phase, of a robot that stands.
    pub const fn new(phase: Phase) -> Self {
        Self { phase, solo: false, steady: true, expected_change_us: 0 }
    }
}

/// The outcome of one firing, as a ring hands it to its judge.
#[derive(Clone, Copy, Debug)]
pub struct Heard<'r> {
    /// The sensor, from 0.
    pub sensor: u8,
    /// When it fired.
    pub fired: Instant,
    /// The echo times, earliest first; none for silence.
    pub echoes: &'r [Micros],
    /// Properties of the firing, by the plan, and the change that odometry expects.
    pub firing: Firing,
    /// `T_delta` of this sensor now: the ring's, or less where the plan allows the sensor less.
    pub t_delta: Micros,
}

impl Heard<'_> {
    /// The verdict of a judge that knows nothing of the sensor.
    pub(crate) fn unjudged(&self, kind: Option<ReadingKind>) -> Verdict {
        let t_echo = self.echoes.first().copied();
        let kind = kind.unwrap_or(if t_echo.is_some() { ReadingKind::First } else { ReadingKind::NoEcho });
        Verdict { kind, t_echo, previous: None, age: None, explained_by: None }
    }
}

/// The answer to what explains readings that agree. No `Option`, so that what is not known cannot pass for "nothing".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Explained {
    /// No firing explains them.
    ByNothing,
    /// This firing explains them, or a forgotten one may.
    By(Explanation),
}

impl Explained {
    /// The reason why they are [`Ambiguous`](ReadingKind::Ambiguous), if they are.
    pub const fn reason(self) -> Option<Explanation> {
        match self {
            Self::ByNothing => None,
            Self::By(explanation) => Some(explanation),
        }
    }
}

/// A ring's knowledge of the sounds that a sensor may have heard. A judge that asks is not compiled in a ring that
/// remembers fewer firings of each sensor than it asks about.
pub trait Sounds {
    /// The firing whose sound could be both the echo that the sensor heard `first` after the firing before its last one
    /// and the one that it heard `second` after its last, by a path that changes by no more than P in between.
    fn explain(&self, first: Micros, second: Micros) -> Explained;
    /// The same of the echoes of its last three firings, earliest first, by a path that changes at a constant rate: its
    /// length in the second is within P of the line between the others.
    fn explain_line(&self, echoes: [Micros; 3]) -> Explained;
    /// As [`explain`](Self::explain), by a path that changes by up to `more` than P.
    fn explain_moving(&self, first: Micros, second: Micros, more: Micros) -> Explained;
    /// Returns true if sound of any firing but the sensor's last could be the echo that it heard after that one.
    fn is_masked(&self, t_echo: Micros) -> bool;
}

/// The quiet that a sensor needs, by a judge's word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Quiet {
    /// Its last reading was believed: less will do.
    Less,
    /// As before.
    Same,
    /// Its last reading may be another firing's sound.
    More,
}

/// No sound explains anything.
pub(crate) struct NoSounds;

impl Sounds for NoSounds {
    fn explain(&self, _first: Micros, _second: Micros) -> Explained {
        Explained::ByNothing
    }

    fn explain_line(&self, _echoes: [Micros; 3]) -> Explained {
        Explained::ByNothing
    }

    fn explain_moving(&self, _first: Micros, _second: Micros, _more: Micros) -> Explained {
        Explained::ByNothing
    }

    fn is_masked(&self, _t_echo: Micros) -> bool {
        false
    }
}

/// Decides what the readings of a [`Ring`](crate::Ring) are worth: [`EchoFilter`](crate::EchoFilter),
/// [`EchoTracker`](crate::judge::EchoTracker), [`RateFilter`](crate::judge::RateFilter), [`Agreement`], or one of the
/// caller's own.
///
/// The ring hands in sensors that it has room for. A judge that has room for fewer accepts nothing of the others.
pub trait Judge {
    /// `T_delta`: what counts as near-identical.
    fn t_delta(&self) -> Micros;
    /// Judges a firing. `sounds` say what explains readings that agree: a judge that accepts them all the same accepts
    /// crosstalk.
    fn judge(&mut self, heard: &Heard<'_>, sounds: &impl Sounds) -> Verdict;
    /// Takes in a firing that says nothing about the echo time: stuck, too early, or silence without a witness.
    /// `echoes` holds the early edge, if there was one.
    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict;
    /// Firings of a sensor since its last accepted reading; `None` if none ever was.
    fn age(&self, sensor: u8) -> Option<u16>;
    /// Returns true if it believes now that nothing is in a sensor's range: what its last reading heard is none of its
    /// own.
    fn is_clear(&self, sensor: u8) -> bool;
    /// The echo time that it believes of a sensor now; `None` if it believes none, or that nothing is in range.
    fn believed(&self, _sensor: u8) -> Option<Micros> {
        None
    }
    /// Returns true if an echo comes before what it believes of a sensor now, silence too: it is none of its own.
    fn comes_before_belief(&self, sensor: u8, t_echo: Micros) -> bool {
        self.believed(sensor).map_or_else(|| self.is_clear(sensor), |believed| t_echo < believed)
    }
    /// The robot moves at this speed and turns at this rate from `now` on. Returns true if readings may change by it.
    fn moving(&mut self, _speed_mm_s: u32, _turn_mrad_s: u32, _now: Instant) -> bool {
        false
    }
    /// The quiet that a sensor needs after its last reading, for plans that give quiet by it.
    fn quiet(&self, _sensor: u8) -> Quiet {
        Quiet::Same
    }
    /// Forgets the readings of a sensor, so that its next one is compared with nothing. The age goes on.
    fn forget(&mut self, sensor: u8);
    /// The ring starts over: sound from before may still be heard, and what a sensor hears next is compared with
    /// nothing. Ages go on.
    fn restart(&mut self);
    /// A sensor's last firing, which is judged already, was this much later than it seemed; negative for earlier.
    fn fired_later(&mut self, _sensor: u8, _later_us: i32) {}
    /// Firing times have changed against each other otherwise than by the phase: see
    /// [`EchoTracker::firing_changed`](crate::judge::EchoTracker::firing_changed).
    fn firing_changed(&mut self) {}
}

/// A judge that does not ask what explains a reading: agreement alone, for baselines. Where crosstalk repeats, as with
/// constant waits, it is accepted.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Agreement<J>(pub J);

impl<J: Judge> Judge for Agreement<J> {
    fn t_delta(&self) -> Micros {
        self.0.t_delta()
    }

    fn judge(&mut self, heard: &Heard<'_>, _: &impl Sounds) -> Verdict {
        self.0.judge(heard, &NoSounds)
    }

    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict {
        self.0.skip(heard, kind)
    }

    fn age(&self, sensor: u8) -> Option<u16> {
        self.0.age(sensor)
    }

    fn is_clear(&self, sensor: u8) -> bool {
        self.0.is_clear(sensor)
    }

    fn forget(&mut self, sensor: u8) {
        self.0.forget(sensor);
    }

    fn restart(&mut self) {
        self.0.restart();
    }

    fn fired_later(&mut self, sensor: u8, later_us: i32) {
        self.0.fired_later(sensor, later_us);
    }

    fn firing_changed(&mut self) {
        self.0.firing_changed();
    }
}
