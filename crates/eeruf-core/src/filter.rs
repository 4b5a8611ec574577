//! The filter: a reading counts only if it is near-identical to the one before (Eq. 11).
//!
//! ```text
//! |T_i - T_(i-1)| <= T_delta      (11)
//! ```
//!
//! A true echo does not depend on the waits and passes; crosstalk moves by more than `T_delta` whenever the schedule
//! meets (13a), (13b), and is rejected. Sensors that report several echoes of one firing hand in all of them, and the
//! earliest that repeats is accepted: crosstalk that arrives before the true echo then no longer hides it.

use core::fmt;

use crate::reading::{Kind, Verdict};
use crate::time::Micros;

/// Stands for "no echo" inside this crate: longer than any listening window.
pub(crate) const NO_ECHO: u32 = u32::MAX;
const NEVER: u16 = u16::MAX;

/// Compares the consecutive readings of up to `K` sensors, each with up to `E` echoes a firing.
///
/// ```
/// use eeruf_core::{EchoFilter, Kind, Micros};
/// let mut filter = EchoFilter::<2>::new(Micros::new(500), 2)?;
/// let mut push = |echo_us: u32| filter.push(1, Some(Micros::new(echo_us))).map(|verdict| verdict.kind);
/// assert_eq!(push(9_000)?, Kind::First);
/// assert_eq!(push(9_500)?, Kind::Accepted); // just within t_delta
/// assert_eq!(push(10_001)?, Kind::Rejected); // just beyond
/// assert_eq!(push(10_001)?, Kind::Accepted); // the new value was the one to compare with
/// # Ok::<(), eeruf_core::FilterError>(())
/// ```
#[derive(Clone, Debug)]
pub struct EchoFilter<const K: usize, const E: usize = 1> {
    tracks: [Track<E>; K],
    rule: Rule,
}

impl<const K: usize, const E: usize> EchoFilter<K, E> {
    /// A filter that accepts a reading when `consecutive` readings running (2 in the paper) are each within `t_delta` of
    /// the one before.
    ///
    /// # Errors
    /// [`FilterError::Consecutive`] unless 2 to 8 readings are compared.
    pub const fn new(t_delta: Micros, consecutive: u8) -> Result<Self, FilterError> {
        match Rule::new(t_delta, consecutive) {
            Ok(rule) => Ok(Self { tracks: [Track::new(0); K], rule }),
            Err(error) => Err(error),
        }
    }

    /// Takes in one firing of a sensor (from 0): the time of its echo, or `None` without echo.
    ///
    /// # Errors
    /// [`FilterError::Sensor`] for a sensor that is not there.
    pub fn push(&mut self, sensor: usize, t_echo: Option<Micros>) -> Result<Verdict, FilterError> {
        self.push_echoes(sensor, t_echo.as_slice(), 0)
    }

    /// As [`push`](Self::push), with all echoes of the firing in any order (the earliest `E` count) and the change in
    /// microseconds that a good reading is expected to show since the firing before: `-2 v dt / c` for an object
    /// approached at `v`, where `dt` is the time between the two firings (see
    /// [`Schedule::refire_after`](crate::Schedule::refire_after)).
    ///
    /// # Errors
    /// [`FilterError::Sensor`] for a sensor that is not there.
    pub fn push_echoes(
        &mut self,
        sensor: usize,
        echoes: &[Micros],
        expected_change_us: i32,
    ) -> Result<Verdict, FilterError> {
        let Some(track) = self.tracks.get_mut(sensor) else {
            return Err(FilterError::Sensor { sensor, sensors: K });
        };
        let mut earliest = [NO_ECHO; E];
        for echo in echoes {
            insert(&mut earliest, echo.as_micros());
        }
        Ok(track.push(self.rule, &earliest, expected_change_us))
    }

    /// Forgets the readings of a sensor, so that its next one is compared with nothing. The age goes on.
    pub fn forget(&mut self, sensor: usize) {
        if let Some(track) = self.tracks.get_mut(sensor) {
            track.forget();
        }
    }
}

/// Puts one more echo into a sorted array, dropping the latest if it is full. What is no echo sorts last.
pub(crate) fn insert<const E: usize>(echoes: &mut [u32; E], mut echo: u32) {
    for held in echoes {
        if echo < *held {
            core::mem::swap(held, &mut echo);
        }
    }
}

/// When readings agree, and how often they must.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rule {
    pub(crate) t_delta: Micros,
    pub(crate) consecutive: u8,
}

impl Rule {
    pub(crate) const fn new(t_delta: Micros, consecutive: u8) -> Result<Self, FilterError> {
        if consecutive < 2 || consecutive > 8 {
            return Err(FilterError::Consecutive { consecutive });
        }
        Ok(Self { t_delta, consecutive })
    }

    /// Eq. (11), after taking off the change that is expected.
    fn near_identical(self, echo: u32, previous: u32, expected_change_us: i32) -> bool {
        let change = i64::from(echo) - i64::from(previous) - i64::from(expected_change_us);
        change.unsigned_abs() <= u64::from(self.t_delta.as_micros())
    }
}

/// What is remembered of one sensor: eight bytes where it reports one echo.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Track<const E: usize> {
    /// The echoes of the firing before, earliest first, [`NO_ECHO`] in the places left.
    previous: [u32; E],
    /// How many firings running each of them has been seen; without echo, how many running had none (0 at the start).
    runs: [u8; E],
    /// For the owner: the ring keeps its flags in this byte, which would otherwise be padding.
    pub(crate) flags: u8,
    /// Firings since the last accepted reading.
    age: u16,
}

impl<const E: usize> Track<E> {
    pub(crate) const fn new(flags: u8) -> Self {
        Self { previous: [NO_ECHO; E], runs: [0; E], flags, age: NEVER }
    }

    pub(crate) fn forget(&mut self) {
        self.previous = [NO_ECHO; E];
        self.runs = [0; E];
    }

    /// A firing that says nothing about the echo time: forgets, and only grows older.
    pub(crate) fn skip(&mut self, kind: Kind, t_echo: Option<Micros>) -> Verdict {
        self.forget();
        self.verdict(kind, t_echo, None)
    }

    /// Compares the echoes of one firing, earliest first, with those of the firing before.
    pub(crate) fn push(&mut self, rule: Rule, echoes: &[u32; E], expected_change_us: i32) -> Verdict {
        let before = core::mem::replace(&mut self.previous, *echoes);
        let runs_before = core::mem::replace(&mut self.runs, [1; E]);
        let earliest_before = before.first().copied().and_then(echo_time);
        let Some(earliest) = echoes.first().copied().and_then(echo_time) else {
            // Without echo twice running, the first count is of silent firings.
            let silent_before = if earliest_before.is_none() { runs_before.first().copied().unwrap_or(0) } else { 0 };
            let silent = silent_before.saturating_add(1);
            self.runs = [silent; E];
            let kind = if silent >= rule.consecutive { Kind::Clear } else { Kind::NoEcho };
            return self.verdict(kind, None, earliest_before);
        };
        if earliest_before.is_none() {
            return self.verdict(Kind::First, Some(earliest), None);
        }
        let mut best = (Kind::Rejected, earliest, earliest_before);
        for (&echo, run) in echoes.iter().zip(&mut self.runs) {
            let Some(t_echo) = echo_time(echo) else { break };
            for (&previous, &run_before) in before.iter().zip(&runs_before) {
                let Some(t_previous) = echo_time(previous) else { break };
                if !rule.near_identical(echo, previous, expected_change_us) {
                    continue;
                }
                *run = (*run).max(run_before.saturating_add(1));
                let kind = if *run >= rule.consecutive { Kind::Accepted } else { Kind::Repeated };
                if better(kind, best.0) {
                    best = (kind, t_echo, Some(t_previous));
                }
            }
        }
        self.verdict(best.0, Some(best.1), best.2)
    }

    fn verdict(&mut self, kind: Kind, t_echo: Option<Micros>, previous: Option<Micros>) -> Verdict {
        self.age = match kind {
            Kind::Accepted => 0,
            _ if self.age >= NEVER - 1 => self.age,
            _ => self.age + 1,
        };
        Verdict { kind, t_echo, previous, age: self.age() }
    }

    pub(crate) fn age(&self) -> Option<u16> {
        (self.age != NEVER).then_some(self.age)
    }
}

fn echo_time(echo: u32) -> Option<Micros> {
    (echo != NO_ECHO).then_some(Micros::new(echo))
}

/// Whether a later echo of this kind replaces an earlier one of the other.
fn better(kind: Kind, than: Kind) -> bool {
    match than {
        Kind::Rejected => true,
        Kind::Repeated => kind == Kind::Accepted,
        _ => false,
    }
}

/// Why a filter cannot do what is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FilterError {
    /// Too few or too many consecutive readings.
    Consecutive {
        /// How many were asked for.
        consecutive: u8,
    },
    /// A sensor that is not there.
    Sensor {
        /// The sensor, from 0.
        sensor: usize,
        /// How many there are.
        sensors: usize,
    },
}

impl fmt::Display for FilterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Consecutive { consecutive } => write!(f, "{consecutive} consecutive readings; expected 2 to 8"),
            Self::Sensor { sensor, sensors } => {
                write!(f, "sensor {}; expected 1 to {sensors}", sensor.saturating_add(1))
            }
        }
    }
}

impl core::error::Error for FilterError {}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;
    use std::vec::Vec;

    fn filter<const E: usize>(t_delta: u32, consecutive: u8) -> EchoFilter<1, E> {
        EchoFilter::new(Micros::new(t_delta), consecutive).unwrap()
    }

    fn kinds<const E: usize>(filter: &mut EchoFilter<1, E>, firings: &[&[u32]]) -> Vec<Kind> {
        firings
            .iter()
            .map(|echoes| {
                let echoes: Vec<_> = echoes.iter().map(|&us| Micros::new(us)).collect();
                filter.push_echoes(0, &echoes, 0).unwrap().kind
            })
            .collect()
    }

    #[test]
    fn two_readings_are_compared_as_the_paper_says() {
        use Kind::*;
        let seen = kinds(&mut filter::<1>(100, 2), &[&[], &[], &[5000], &[5100], &[5201], &[], &[5201], &[5201], &[]]);
        assert_eq!(seen, [NoEcho, Clear, First, Accepted, Rejected, NoEcho, First, Accepted, NoEcho]);
    }

    #[test]
    fn three_readings_must_each_agree_with_the_one_before() {
        use Kind::*;
        let seen =
            kinds(&mut filter::<1>(100, 3), &[&[5000], &[5100], &[5200], &[5300], &[5401], &[5401], &[], &[], &[]]);
        assert_eq!(seen, [First, Repeated, Accepted, Accepted, Rejected, Repeated, NoEcho, NoEcho, Clear]);
    }

    #[test]
    fn the_earliest_echo_that_repeats_is_accepted_whatever_comes_before_it() {
        let mut filter = filter::<4>(100, 2);
        let us = |echoes: &[u32]| echoes.iter().map(|&us| Micros::new(us)).collect::<Vec<_>>();
        filter.push_echoes(0, &us(&[9000, 3000, 12000]), 0).unwrap();
        let verdict = filter.push_echoes(0, &us(&[12040, 9050, 5000]), 0).unwrap();
        assert_eq!(
            verdict,
            Verdict {
                kind: Kind::Accepted,
                t_echo: Some(Micros::new(9050)),
                previous: Some(Micros::new(9000)),
                age: Some(0)
            }
        );
    }

    #[test]
    fn more_echoes_than_fit_leave_the_earliest() {
        let mut held = [NO_ECHO; 3];
        for echo in [7, 3, 9, 1, 8] {
            insert(&mut held, echo);
        }
        assert_eq!(held, [1, 3, 7]);
    }

    #[test]
    fn the_expected_change_is_taken_off_before_comparing() {
        let mut filter = filter::<1>(50, 2);
        let mut push = |us, change| filter.push_echoes(0, &[Micros::new(us)], change).unwrap().kind;
        push(10_000, 0);
        assert_eq!(push(9_000, -1_000), Kind::Accepted);
        assert_eq!(push(8_051, -1_000), Kind::Rejected);
        assert_eq!(push(u32::MAX - 1, i32::MAX), Kind::Rejected);
    }

    #[test]
    fn the_age_counts_firings_since_the_last_accepted_reading() {
        let mut filter = filter::<1>(50, 2);
        let mut age = |echo: Option<u32>| filter.push(0, echo.map(Micros::new)).unwrap().age;
        assert_eq!([age(Some(1000)), age(Some(1000)), age(None), age(None)], [None, Some(0), Some(1), Some(2)]);
        for _ in 0..70_000 {
            age(None);
        }
        assert_eq!(age(None), Some(65_534));
    }

    #[test]
    fn a_forgotten_sensor_starts_again_but_does_not_grow_younger() {
        let mut filter = filter::<1>(50, 2);
        for _ in 0..2 {
            filter.push(0, Some(Micros::new(1000))).unwrap();
        }
        filter.forget(0);
        let verdict = filter.push(0, Some(Micros::new(1000))).unwrap();
        assert_eq!((verdict.kind, verdict.age), (Kind::First, Some(1)));
    }

    #[test]
    fn errors_say_what_is_expected() {
        let error = EchoFilter::<1>::new(Micros::new(1), 9).unwrap_err();
        assert_eq!(error.to_string(), "9 consecutive readings; expected 2 to 8");
        let error = filter::<1>(1, 2).push(1, None).unwrap_err();
        assert_eq!(error.to_string(), "sensor 2; expected 1 to 1");
    }

    #[test]
    fn a_sensor_with_one_echo_is_remembered_in_eight_bytes() {
        assert_eq!(size_of::<Track<1>>(), 8);
    }
}
