//! [`Judge`]: the interface between a ring and the code that decides which readings to accept.

use crate::reading::{Explanation, ReadingKind, Verdict};
use crate::schedule::Phase;
use crate::time::{Instant, Micros};

/// The context of a firing that a plan gives to a judge.
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
    /// The context of a firing in this phase, for a robot that stands.
    pub const fn new(phase: Phase) -> Self {
        Self { phase, expected_change_us: 0 }
    }
}

/// The outcome of one firing, as a ring hands it to its judge.
#[derive(Clone, Copy, Debug)]
pub struct Heard<'r> {
    /// The sensor, from 0.
    pub sensor: u8,
    /// Time of the firing.
    pub fired: Instant,
    /// Time since the sensor's previous firing; meaningless if that was forgotten.
    pub since_before: Micros,
    /// The echo times, earliest first; empty for silence.
    pub echoes: &'r [Micros],
    /// The context of the firing, from the plan, with the change that odometry expects.
    pub firing: FiringContext,
    /// `T_delta` of this sensor now: the ring's, or less if the plan allows the sensor less.
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
    /// Age of a sensor none of whose readings was ever accepted.
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

/// The explanation of readings that agree. Not an `Option`, so that unknown history cannot pass for "nothing".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Explained {
    /// No firing explains the readings.
    ByNothing,
    /// This firing explains the readings, or a forgotten one may.
    By(Explanation),
}

impl Explained {
    /// The reason why the readings are [`Ambiguous`](ReadingKind::Ambiguous), if they are.
    pub const fn reason(self) -> Option<Explanation> {
        match self {
            Self::ByNothing => None,
            Self::By(explanation) => Some(explanation),
        }
    }
}

/// A ring's knowledge of the sounds that a sensor may have heard. If the ring remembers fewer firings than a judge asks
/// about, the program does not compile.
pub trait Sounds {
    /// The firing whose sound could be both the echo heard `first` after the sensor's last firing but one and the echo
    /// heard `second` after its last firing, along a path that changes by at most P in between.
    fn explain(&self, first: Micros, second: Micros) -> Explained;
    /// Returns the explanation like [`explain`](Self::explain), for paths that change by up to `more` than P.
    fn explain_moving(&self, first: Micros, second: Micros, more: Micros) -> Explained {
        self.explain_after(1, first, second, more)
    }
    /// Returns the explanation like [`explain_moving`](Self::explain_moving), with the `first` echo after the firing
    /// `ago` firings before the sensor's last one.
    fn explain_after(&self, ago: u8, first: Micros, second: Micros, more: Micros) -> Explained;
    /// Returns true if sound of any firing except the sensor's last could be the echo that it heard after that one.
    fn is_masked(&self, t_echo: Micros) -> bool;
}

/// A judge's demand for quiet around a sensor's firing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Quiet {
    /// The last reading was believed, so less quiet will do.
    Less,
    /// Quiet stays as before.
    Same,
    /// The last reading may be another firing's sound.
    More,
}

/// The robot's motion, for the gaps of a plan that gives quiet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pace {
    /// True if the robot moves, so that readings may change.
    pub moves: bool,
    /// True if every echo is reported, so that each needs more quiet.
    pub every_echo: bool,
}

impl Pace {
    /// The motion of a robot that stands.
    pub const STANDING: Self = Self { moves: false, every_echo: false };
}

/// A source of no sound, for readings that no ring fired.
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

/// Decides which readings of a [`Ring`](crate::Ring) to accept: [`EchoFilter`](crate::EchoFilter),
/// [`Belief`](crate::flow::Belief), [`MOfN`](crate::judge::MOfN), [`Agreement`],
/// [`MedianFilter`](crate::judge::MedianFilter), or one of the caller's own.
///
/// The ring passes every sensor that it has room for. A judge with room for fewer sensors accepts nothing from the
/// others.
pub trait Judge {
    /// `T_delta`: the greatest difference of near-identical readings.
    fn t_delta(&self) -> Micros;
    /// Judges a firing. `sounds` tells which firings explain readings that agree: a judge that accepts explained
    /// readings accepts crosstalk.
    fn judge(&mut self, heard: &Heard<'_>, sounds: &impl Sounds) -> Verdict;
    /// Handles a firing without information about the echo time: stuck, too early, late, or silence without a witness.
    /// `echoes` holds the early edge, if there was one.
    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict;
    /// Handles a firing whose sensor still holds its line: it has no echo, but is not silence yet. A run of silences
    /// goes on, and the next reading is compared with no echo. By default the run ends.
    fn hold(&mut self, heard: &Heard<'_>) {
        self.skip(heard, ReadingKind::NoEcho);
    }
    /// Number of firings of a sensor since its last accepted reading; `None` if none ever was.
    fn age(&self, sensor: u8) -> Option<u16>;
    /// Returns true if the judge believes that nothing is in a sensor's range, so that what its last reading heard is
    /// foreign.
    fn is_clear(&self, sensor: u8) -> bool;
    /// The echo time that the judge believes of a sensor; `None` if it believes none, or believes that nothing is in
    /// range.
    fn believed(&self, _sensor: u8) -> Option<Micros> {
        None
    }
    /// The firing of a sensor that the echo time of its last verdict stands for: 0 for the last one, 1 for the one
    /// before, and so on.
    fn stands_for(&self, _sensor: u8) -> u8 {
        0
    }
    /// Reports the robot's speed and rate of turn from `now` on.
    fn moving(&mut self, _speed_mm_s: u32, _turn_mrad_s: u32, _now: Instant) {}
    /// The robot's motion as of the last reading or report.
    fn pace(&self) -> Pace {
        Pace::STANDING
    }
    /// The quiet that the sensor of the latest reading needs, for plans that depend on it.
    fn quiet(&self) -> Quiet {
        Quiet::Same
    }
    /// Forgets the readings of a sensor, so that its next one is compared with nothing. The age keeps counting.
    fn forget(&mut self, sensor: u8);
    /// Resumes a sensor after a pause of the ring: its next reading is compared with no other.
    fn resume(&mut self, sensor: u8) {
        self.forget(sensor);
    }
    /// Restarts the judge with the ring: sound from before may still be heard, and each sensor's next reading is
    /// compared with nothing. Ages keep counting.
    fn restart(&mut self);
    /// Corrects a sensor's last firing, which is judged already: it was this much later than assumed; negative for
    /// earlier.
    fn fired_later(&mut self, _sensor: u8, _later_us: i32) {}
}

/// A judge that ignores explanations and accepts agreement alone, for baselines, without any promise about foreign
/// sound. It accepts crosstalk that repeats, as with constant waits.
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
