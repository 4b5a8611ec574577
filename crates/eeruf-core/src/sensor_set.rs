//! [`SensorSet`]: a set of up to 64 sensors in two words, since most targets have no 64-bit registers.

use crate::schedule::MAX_SENSORS;

const WORD: usize = u32::BITS as usize;

/// A set of sensors, counted from 0. Sensors beyond the 64th are never in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct SensorSet([u32; MAX_SENSORS / WORD]);

impl SensorSet {
    pub(crate) const NONE: Self = Self([0; MAX_SENSORS / WORD]);
    pub(crate) const ALL: Self = Self([u32::MAX; MAX_SENSORS / WORD]);

    pub(crate) fn contains(self, sensor: u8) -> bool {
        self.0.get(usize::from(sensor) / WORD).is_some_and(|word| word & bit(sensor) != 0)
    }

    pub(crate) fn set(&mut self, sensor: u8, member: bool) {
        if let Some(word) = self.0.get_mut(usize::from(sensor) / WORD) {
            *word = if member { *word | bit(sensor) } else { *word & !bit(sensor) };
        }
    }
}

const fn bit(sensor: u8) -> u32 {
    1 << (sensor as usize % WORD)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sensors_enter_and_leave_one_by_one() {
        let mut set = SensorSet::NONE;
        for sensor in 0..=u8::MAX {
            set.set(sensor, true);
            assert_eq!(set.contains(sensor), sensor < 64);
        }
        assert_eq!(set, SensorSet::ALL);
        set.set(33, false);
        assert!(!set.contains(33) && set.contains(32) && set.contains(1));
    }
}
