//! [`Judge`]: what a ring asks of whatever decides what a reading is worth.

use crate::reading::{Explanation, ReadingKind, Verdict};
use crate::schedule::Phase;
use crate::time::{Instant, Micros};

/// A firing as a plan tells it to a judge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FiringContext {
    /// The phase of the schedule in which the sensor fired.
    pub phase: Phase,
    /// Expected change of a good reading since this sensor's firing before, in microseconds, if it comes from straight
    /// ahead: `-2 d / c` for a sensor carried forward by `d`.
    pub expected_change_us: i32,
}

impl FiringContext {
    /// A firing in this phase, of a robot that stands.
    pub const fn new(phase: Phase) -> Self {
        Self { phase, expected_change_us: 0 }
    }
}

/// The outcome of one firing, as a ring hands it to its judge.
#[derive(Clone, Copy, Debug)]
pub struct Heard<'r> {
    /// The sensor, from 0.
    pub sensor: u8,
    /// Time when it fired.
    pub fired: Instant,
    /// Time since its firing before; of no account where that was forgotten.
    pub since_before: Micros,
    /// The echo times, earliest first; none for silence.
    pub echoes: &'r [Micros],
    /// Properties of the firing, by the plan, and the change that odometry expects.
    pub firing: FiringContext,
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

/// Firings of a sensor since its last accepted reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Age(u16);

impl Age {
    /// None was ever accepted.
    pub(crate) const NEVER: Self = Self(u16::MAX);

    pub(crate) fn get(self) -> Option<u16> {
        (self != Self::NEVER).then_some(self.0)
    }

    /// Counts a reading.
    pub(crate) fn count(&mut self, kind: ReadingKind) -> Option<u16> {
        self.0 = match kind {
            ReadingKind::Accepted => 0,
            _ if self.0 >= Self::NEVER.0 - 1 => self.0,
            _ => self.0 + 1,
        };
        self.get()
    }
}

/// The answer to what explains readings that agree. No `Option`, so that what is not known cannot pass for "nothing".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Explained {
    /// Readings that no firing explains.
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
    /// Asks like [`explain`](Self::explain), for paths that change by up to `more` than P.
    fn explain_moving(&self, first: Micros, second: Micros, more: Micros) -> Explained {
        self.explain_after(1, first, second, more)
    }
    /// Asks like [`explain_moving`](Self::explain_moving), with the `first` echo after the firing that came `ago`
    /// firings before the sensor's last one.
    fn explain_after(&self, ago: u8, first: Micros, second: Micros, more: Micros) -> Explained;
    /// Returns true if sound of any firing but the sensor's last could be the echo that it heard after that one.
    fn is_masked(&self, t_echo: Micros) -> bool;
}

/// The quiet that a sensor needs, by a judge's word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Quiet {
    /// The last reading was believed: less will do.
    Less,
    /// Quiet as before.
    Same,
    /// The last reading may be another firing's sound.
    More,
}

/// The robot's motion, for the gaps of a plan that gives quiet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pace {
    /// Readings may change, since the robot moves.
    pub moves: bool,
    /// Every echo is reported, so that each needs more quiet.
    pub every_echo: bool,
}

impl Pace {
    /// The motion of a robot that stands.
    pub const STANDING: Self = Self { moves: false, every_echo: false };
}

/// A source of no sound, for readings that no ring has fired.
#[derive(Clone, Copy, Debug)]
pub struct NoSounds;

impl Sounds for NoSounds {
    fn explain(&self, _first: Micros, _second: Micros) -> Explained {
        Explained::ByNothing
    }

    fn explain_after(&self, _ago: u8, _first: Micros, _second: Micros, _more: Micros) -> Explained {
        Explained::ByNothing
    }

    fn is_masked(&self, _t_echo: Micros) -> bool {
        false
    }
}

/// Decides what the readings of a [`Ring`](crate::Ring) are worth: [`EchoFilter`](crate::EchoFilter),
/// [`Belief`](crate::flow::Belief), [`MOfN`](crate::judge::MOfN), [`Agreement`],
/// [`MedianFilter`](crate::judge::MedianFilter), or one of the caller's own.
///
/// The ring hands in sensors that it has room for. A judge that has room for fewer accepts nothing of the others.
pub trait Judge {
    /// `T_delta`: what counts as near-identical.
    fn t_delta(&self) -> Micros;
    /// Judges a firing. `sounds` say what explains readings that agree: a judge that accepts them all the same accepts
    /// crosstalk.
    fn judge(&mut self, heard: &Heard<'_>, sounds: &impl Sounds) -> Verdict;
    /// Takes in a firing that says nothing about the echo time: stuck, too early, late, or silence without a witness.
    /// `echoes` holds the early edge, if there was one.
    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict;
    /// Takes in a firing whose sensor still holds its line as one without an echo that is no silence yet. A run of
    /// silences goes on, and what it hears next is compared with no echo. By default the run ends.
    fn hold(&mut self, heard: &Heard<'_>) {
        self.skip(heard, ReadingKind::NoEcho);
    }
    /// Firings of a sensor since its last accepted reading; `None` if none ever was.
    fn age(&self, sensor: u8) -> Option<u16>;
    /// Returns true if it believes now that nothing is in a sensor's range: what its last reading heard is none of its
    /// own.
    fn is_clear(&self, sensor: u8) -> bool;
    /// The echo time that it believes of a sensor now; `None` if it believes none, or that nothing is in range.
    fn believed(&self, _sensor: u8) -> Option<Micros> {
        None
    }
    /// The firing of a sensor that the echo time of its last verdict stands for: 0 for the last one, 1 for the one
    /// before, and so on.
    fn stands_for(&self, _sensor: u8) -> u8 {
        0
    }
    /// The robot moves at this speed and turns at this rate from `now` on.
    fn moving(&mut self, _speed_mm_s: u32, _turn_mrad_s: u32, _now: Instant) {}
    /// The robot's motion as of the last reading, or word of it.
    fn pace(&self) -> Pace {
        Pace::STANDING
    }
    /// The quiet that a sensor needs after its reading, which was the last of all, for plans that give quiet by it.
    fn quiet(&self) -> Quiet {
        Quiet::Same
    }
    /// Forgets the readings of a sensor, so that its next one is compared with nothing. The age goes on.
    fn forget(&mut self, sensor: u8);
    /// The ring goes on after a pause, and with it a sensor: its next reading is compared with no other.
    fn resume(&mut self, sensor: u8) {
        self.forget(sensor);
    }
    /// The ring starts over: sound from before may still be heard, and what a sensor hears next is compared with
    /// nothing. Ages go on.
    fn restart(&mut self);
    /// A sensor's last firing, which is judged already, was this much later than it seemed; negative for earlier.
    fn fired_later(&mut self, _sensor: u8, _later_us: i32) {}
}

/// A judge that does not ask what explains a reading: agreement alone, for baselines, without any promise about foreign
/// sound. Where crosstalk repeats, as with constant waits, it is accepted.
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

    fn hold(&mut self, heard: &Heard<'_>) {
        self.0.hold(heard);
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
}
