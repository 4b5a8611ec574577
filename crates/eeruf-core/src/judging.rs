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
    /// Expected change of a good reading since this sensor's previous firing, in microseconds, for an object straight
    /// ahead: `-2 d / c` for a sensor that moved forward by `d`.
    pub expected_change_us: i32,
}

impl FiringContext {
    /// The context of a firing in this phase, on a stationary robot.
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
    /// Time since the sensor's previous firing; meaningless if that firing was forgotten.
    pub since_before: Micros,
    /// The echo times, earliest first; empty for silence.
    pub echoes: &'r [Micros],
    /// The context of the firing, from the plan, with the change that odometry expects.
    pub firing: FiringContext,
    /// `T_delta` of this sensor now: the ring's, or less if the plan allows the sensor less.
    pub t_delta: Micros,
}

impl Heard<'_> {
    /// The verdict of a judge that knows nothing about the sensor.
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
    /// Age of a sensor that has never had a reading accepted.
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
    /// Finds a firing that explains two echoes: one heard `first` after the sensor's second-to-last firing, the other
    /// `second` after its last, along a path that changes by at most P in between.
    fn explain(&self, first: Micros, second: Micros) -> Explained;
    /// Explains like [`explain`](Self::explain), for paths that change by up to P plus `more`.
    fn explain_moving(&self, first: Micros, second: Micros, more: Micros) -> Explained {
        self.explain_after(1, first, second, more)
    }
    /// Explains like [`explain_moving`](Self::explain_moving), but takes `first` from the firing that was `ago` firings
    /// before the sensor's last one.
    fn explain_after(&self, ago: u8, first: Micros, second: Micros, more: Micros) -> Explained;
    /// Returns true if the echo that the sensor heard after its last firing could be the sound of any other firing.
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

/// The robot's motion, for plans that adapt their gaps to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pace {
    /// True if the robot moves, so that readings may change.
    pub moves: bool,
    /// True if every echo is reported, so that each needs more quiet.
    pub every_echo: bool,
}

impl Pace {
    /// The motion of a stationary robot.
    pub const STANDING: Self = Self { moves: false, every_echo: false };
}

/// Explains nothing, for readings that were not fired by a ring.
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
/// [`MedianFilter`](crate::judge::MedianFilter), or one of your own.
///
/// The ring hands over every sensor that it has room for. A judge with room for fewer sensors accepts nothing from the
/// others.
pub trait Judge {
    /// `T_delta`: the greatest difference between near-identical readings.
    fn t_delta(&self) -> Micros;
    /// Judges a firing. `sounds` tells which firings explain readings that agree: a judge that accepts explained
    /// readings accepts crosstalk.
    fn judge(&mut self, heard: &Heard<'_>, sounds: &impl Sounds) -> Verdict;
    /// Handles a firing without information about the echo time: stuck, too early, late, or silence without a witness.
    /// `echoes` holds the early edge, if there was one.
    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict;
    /// Handles a firing whose sensor still holds its line: there is no echo, but it does not count as silence yet. A
    /// run of silences goes on, and the next reading is compared with no echo. By default the run ends.
    fn hold(&mut self, heard: &Heard<'_>) {
        self.skip(heard, ReadingKind::NoEcho);
    }
    /// Number of firings of a sensor since its last accepted reading; `None` if none ever was.
    fn age(&self, sensor: u8) -> Option<u16>;
    /// Returns true if the judge believes that nothing is in a sensor's range, so that any echo in its last reading is
    /// foreign.
    fn is_clear(&self, sensor: u8) -> bool;
    /// The echo time that the judge believes of a sensor; `None` if it believes none, or believes that nothing is in
    /// range.
    fn believed(&self, _sensor: u8) -> Option<Micros> {
        None
    }
    /// The firing that the echo time of a sensor's last verdict belongs to: 0 for the last one, 1 for the one before
    /// it, and so on.
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
    /// Corrects a sensor's last firing after its reading was judged: it was this much later than assumed; negative for
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
