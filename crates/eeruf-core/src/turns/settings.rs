//! [`TurnSettings`] and [`BeliefSettings`]: what a ring that fires in turn is set up with.

use crate::ring_error::RingError;
use crate::time::Micros;

/// The longest quiet, and the longest time between two firings of a sensor.
const LONGEST_QUIET: Micros = Micros::from_millis(250);
const LONGEST_REST: Micros = Micros::from_millis(4_000);

/// Returns the setting if it is within its range.
const fn within(name: &'static str, value: Micros, least: Micros, most: Micros) -> Result<(), RingError> {
    if value.as_micros() < least.as_micros() || value.as_micros() > most.as_micros() {
        let [value, least, most] = [value.as_micros(), least.as_micros(), most.as_micros()];
        return Err(RingError::Setting { name, value, least, most });
    }
    Ok(())
}

/// When sensors fire that fire in turn. The least and the most quiet being equal, each has the same gap around it: one
/// by one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TurnSettings {
    /// The least time from a firing to the next.
    pub least: Micros,
    /// R: the most, and how long sound is heard, its tail included. At most 250 ms.
    pub most: Micros,
    /// The least time between two firings of a sensor, for which its module rests. At most 4 s.
    pub rest: Micros,
    /// Random time in every gap, from 0 to this while the robot stands, and to twice this while it moves. At least
    /// eight ticks of the clock, or readings that agree are explained by chance.
    pub dice: Micros,
    /// The seed of the dice, not 0: another one for each robot, as its chip's number.
    pub seed: u32,
}

impl TurnSettings {
    /// For HC-SR04 modules and others that hear no further than 4 m, with this seed.
    pub const fn new(seed: u32) -> Self {
        let (most, rest) = (Micros::new(33_500), Micros::from_millis(60));
        Self { least: Micros::new(6_000), most, rest, dice: Micros::from_millis(2), seed }
    }

    pub(super) const fn check(&self) -> Result<(), RingError> {
        let tick = Micros::new(1);
        if let Err(error) = within("most", self.most, tick, LONGEST_QUIET) {
            return Err(error);
        }
        if let Err(error) = within("least", self.least, tick, self.most) {
            return Err(error);
        }
        if let Err(error) = within("rest", self.rest, tick, LONGEST_REST) {
            return Err(error);
        }
        if let Err(error) = within("dice", self.dice, Micros::ZERO, LONGEST_QUIET) {
            return Err(error);
        }
        within("seed", Micros::new(self.seed), tick, Micros::MAX)
    }

    /// Quiet that a believed reading takes away.
    pub(super) fn down(&self) -> Micros {
        Micros::new(self.most.saturating_sub(self.least).as_micros() / 10)
    }

    /// Quiet that a masked reading adds.
    pub(super) fn up(&self) -> Micros {
        Micros::new(self.most.saturating_sub(self.least).as_micros() / 4)
    }

    /// Quiet to begin with.
    pub(super) fn first(&self) -> Micros {
        self.least.saturating_add(Micros::new(self.most.saturating_sub(self.least).as_micros() / 5))
    }
}

/// Belief of a ring that fires in turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BeliefSettings {
    /// `T_delta`: by how much two readings in a row may differ that agree, of a robot that stands.
    pub t_delta: Micros,
    /// H: by how much a reading may differ from what is believed, of a robot that stands.
    pub near: Micros,
    /// P: by how much the path of foreign sound may change between two readings, of a robot that stands.
    pub path_change: Micros,
    /// Firings without belief after which a belief keeps nothing alive.
    pub memory: u8,
    /// Readings that confirm a belief so far that as many contradictions must come before what is farther, or silence,
    /// is believed; of a robot that stands.
    pub hold: u8,
    /// The speed that holds where the robot says none, in mm/s.
    pub top_speed_mm_s: u16,
}

impl BeliefSettings {
    /// For every robot that stands unless it says otherwise.
    pub const DEFAULT: Self = Self {
        t_delta: Micros::new(80),
        near: Micros::new(150),
        path_change: Micros::new(150),
        memory: 8,
        hold: 4,
        top_speed_mm_s: 0,
    };

    pub(super) const fn check(&self) -> Result<(), RingError> {
        let most = Micros::from_millis(10);
        if let Err(error) = within("near", self.near, Micros::ZERO, most) {
            return Err(error);
        }
        within("hold", Micros::new(self.hold as u32), Micros::new(1), Micros::new(100))
    }
}

impl Default for BeliefSettings {
    fn default() -> Self {
        Self::DEFAULT
    }
}
