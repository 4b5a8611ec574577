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

use crate::reading::{ReadingKind, Verdict};
use crate::time::Micros;

/// Stands for "no echo" inside this crate: longer than any listening window.
pub(crate) const NO_ECHO: u32 = u32::MAX;
const NEVER: u16 = u16::MAX;

/// Compares the consecutive readings of up to `K` sensors, each with up to `E` echoes a firing.
///
/// ```
/// use eeruf_core::{EchoFilter, ReadingKind, Micros};
/// let mut filter = EchoFilter::<2>::new(Micros::new(500), 2)?;
/// let mut push = |echo_us: u32| filter.push(1, Some(Micros::new(echo_us))).map(|verdict| verdict.kind);
/// assert_eq!(push(9_000)?, ReadingKind::First);
/// assert_eq!(push(9_500)?, ReadingKind::Accepted); // just within t_delta
/// assert_eq!(push(10_001)?, ReadingKind::Rejected); // just beyond
/// assert_eq!(push(10_001)?, ReadingKind::Accepted); // the new value was the one to compare with
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
        match Agreement::new(consecutive, 0) {
            Ok(agreement) => Ok(Self { tracks: [Track::new(0); K], rule: Rule { t_delta, agreement } }),
            Err(error) => Err(error),
        }
    }

    /// A filter that does not give up an accepted echo at once when it is missing, as a faint echo is that fades now and
    /// then. As long as it is waited for, no later echo is accepted in its place, and when it comes back it is accepted again.
    ///
    /// Each echo has a credit: one more for each firing that it is in, at most `patience` (or `consecutive`, if that is more),
    /// one less for each that it is missing from. It is accepted from when its credit has reached `consecutive` until it is used
    /// up. With a patience of 0, as in the paper, a missing echo is forgotten.
    ///
    /// This is for schedules of two phases, and for sensors that report several echoes; with `E` = 1 it changes nothing. The
    /// price is that an object that has gone is still waited for.
    ///
    /// # Errors
    /// [`FilterError::Patience`] for more than 15.
    ///
    /// ```
    /// use eeruf_core::{EchoFilter, ReadingKind, Micros};
    /// let mut filter = EchoFilter::<1, 8>::new(Micros::new(100), 2)?.with_patience(4)?;
    /// let mut push = |echoes: &[u32]| {
    ///     let echoes: Vec<_> = echoes.iter().map(|&us| Micros::new(us)).collect();
    ///     filter.push_echoes(0, &echoes, 0).map(|verdict| verdict.kind)
    /// };
    /// push(&[9_000, 14_000])?;
    /// assert_eq!(push(&[9_000, 14_000])?, ReadingKind::Accepted);
    /// assert_eq!(push(&[14_000])?, ReadingKind::Rejected); // the wall behind is not believed at once
    /// assert_eq!(push(&[9_000, 14_000])?, ReadingKind::Accepted);
    /// # Ok::<(), eeruf_core::FilterError>(())
    /// ```
    pub const fn with_patience(self, patience: u8) -> Result<Self, FilterError> {
        match Agreement::new(self.rule.agreement.consecutive(), patience) {
            Ok(agreement) => Ok(Self { rule: Rule { agreement, ..self.rule }, ..self }),
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
    pub(crate) agreement: Agreement,
}

impl Rule {
    /// Eq. (11), after taking off the change that is expected.
    fn near_identical(self, echo: u32, previous: u32, expected_change_us: i32) -> bool {
        if echo == NO_ECHO || previous == NO_ECHO {
            return echo == previous;
        }
        let change = i64::from(echo) - i64::from(previous) - i64::from(expected_change_us);
        change.unsigned_abs() <= u64::from(self.t_delta.as_micros())
    }
}

/// How often an echo must be seen to be believed, and for how long it is then waited for, in one byte.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Agreement(u8);

impl Agreement {
    pub(crate) const fn new(consecutive: u8, patience: u8) -> Result<Self, FilterError> {
        if consecutive < 2 || consecutive > 8 {
            return Err(FilterError::Consecutive { consecutive });
        }
        if patience > Standing::CREDIT {
            return Err(FilterError::Patience { patience });
        }
        Ok(Self(consecutive | patience << 4))
    }

    const fn consecutive(self) -> u8 {
        self.0 & 15
    }

    const fn patience(self) -> u8 {
        self.0 >> 4
    }
}

/// What is known of an echo besides its time, in one byte: whether it is believed, and its credit, which grows by one with
/// each firing that it is in and shrinks by one with each that it is missing from. The higher of two is the better.
///
/// What is not believed is forgotten when it is missing once. So a belief always begins with firings running, of which
/// one phase alone, where crosstalk repeats, makes no more than one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Standing(u8);

impl Standing {
    const NONE: Self = Self(0);
    const CREDIT: u8 = 0b1111;
    const BELIEVED: u8 = 1 << 4;
    /// In its first firing.
    const NEW: Self = Self(1);

    const fn credit(self) -> u8 {
        self.0 & Self::CREDIT
    }

    const fn is_believed(self) -> bool {
        self.0 & Self::BELIEVED != 0
    }

    /// One firing later, which it is in.
    fn seen(self, agreement: Agreement) -> Self {
        let most = agreement.consecutive().max(agreement.patience());
        let credit = (self.credit() + 1).min(most);
        let believed = if credit >= agreement.consecutive() { Self::BELIEVED } else { self.0 & Self::BELIEVED };
        Self(credit | believed)
    }

    /// One firing later, which it is missing from.
    const fn missed(self) -> Self {
        if self.credit() > 1 { Self(self.0 - 1) } else { Self::NONE }
    }
}

/// What is remembered of one sensor: eight bytes where it reports one echo.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Track<const E: usize> {
    /// The echoes to compare with, earliest first: those of the firing before, and believed ones that are missing.
    /// [`NO_ECHO`] stands for silence where it has a standing.
    known: [u32; E],
    standings: [Standing; E],
    /// For the owner: the ring keeps its flags in this byte, which would otherwise be padding.
    pub(crate) flags: u8,
    /// Firings since the last accepted reading.
    age: u16,
}

impl<const E: usize> Track<E> {
    pub(crate) const fn new(flags: u8) -> Self {
        Self { known: [NO_ECHO; E], standings: [Standing::NONE; E], flags, age: NEVER }
    }

    pub(crate) fn forget(&mut self) {
        self.known = [NO_ECHO; E];
        self.standings = [Standing::NONE; E];
    }

    /// A firing that says nothing about the echo time: forgets, and only grows older.
    pub(crate) fn skip(&mut self, kind: ReadingKind, t_echo: Option<Micros>) -> Verdict {
        self.forget();
        self.verdict(kind, t_echo, None)
    }

    /// Compares the echoes of one firing, earliest first, with those that are known.
    pub(crate) fn push(&mut self, rule: Rule, echoes: &[u32; E], expected_change_us: i32) -> Verdict {
        let before = core::mem::replace(&mut self.known, *echoes);
        let standings = core::mem::replace(&mut self.standings, [Standing::NONE; E]);
        let known = || before.iter().copied().zip(standings).take_while(|(_, standing)| *standing != Standing::NONE);
        let earliest = echoes.first().copied().unwrap_or(NO_ECHO);
        let earliest_before = before.first().copied().and_then(echo_time);

        // Silence counts as an echo of its own, later than all others.
        let silent = earliest == NO_ECHO;
        let heard = echoes.iter().copied().enumerate().take_while(|&(place, echo)| echo != NO_ECHO || place == 0);
        // The earliest that is believed, or else the earliest that repeats.
        let mut best = (Standing::NEW, earliest, earliest_before);
        for ((_, echo), now) in heard.clone().zip(&mut self.standings) {
            *now = Standing::NEW;
            for (previous, standing) in known() {
                if rule.near_identical(echo, previous, expected_change_us) {
                    *now = (*now).max(standing.seen(rule.agreement));
                    if best.0 == Standing::NEW || (now.is_believed() && !best.0.is_believed()) {
                        best = (*now, echo, echo_time(previous));
                    }
                }
            }
        }
        if E > 1 && rule.agreement.patience() > 0 {
            for (previous, standing) in known() {
                let missing = standing.missed();
                let is_it = |(_, echo)| rule.near_identical(echo, previous, expected_change_us);
                if !missing.is_believed() || heard.clone().any(is_it) {
                    continue;
                }
                let expected = match previous {
                    NO_ECHO => NO_ECHO,
                    previous => previous.saturating_add_signed(expected_change_us).min(NO_ECHO - 1),
                };
                if best.0.is_believed() && expected < best.1 {
                    best = (Standing::NEW, earliest, echo_time(previous));
                }
                self.keep(expected, missing);
            }
        }
        let kind = match best.0 {
            standing if standing.is_believed() => {
                if silent {
                    ReadingKind::Clear
                } else {
                    ReadingKind::Accepted
                }
            }
            _ if silent => ReadingKind::NoEcho,
            _ if earliest_before.is_none() => ReadingKind::First,
            Standing::NEW => ReadingKind::Rejected,
            _ => ReadingKind::Repeated,
        };
        self.verdict(kind, echo_time(best.1), best.2)
    }

    /// Goes on knowing an echo that is missing, unless all places hold earlier ones.
    fn keep(&mut self, echo: u32, standing: Standing) {
        let free = |(&known, &standing): (&u32, &Standing)| echo < known || standing == Standing::NONE;
        let Some(place) = self.known.iter().zip(&self.standings).position(free) else { return };
        if let (Some(known), Some(standings)) = (self.known.get_mut(place..), self.standings.get_mut(place..)) {
            known.rotate_right(1);
            standings.rotate_right(1);
            if let (Some(known), Some(held)) = (known.first_mut(), standings.first_mut()) {
                (*known, *held) = (echo, standing);
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

fn echo_time(echo: u32) -> Option<Micros> {
    (echo != NO_ECHO).then_some(Micros::new(echo))
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
    /// Too much patience.
    Patience {
        /// How much was asked for.
        patience: u8,
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
            Self::Patience { patience } => write!(f, "a patience of {patience} firings; expected 0 to 15"),
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

    fn kinds<const E: usize>(filter: &mut EchoFilter<1, E>, firings: &[&[u32]]) -> Vec<ReadingKind> {
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
        use ReadingKind::*;
        let seen = kinds(&mut filter::<1>(100, 2), &[&[], &[], &[5000], &[5100], &[5201], &[], &[5201], &[5201], &[]]);
        assert_eq!(seen, [NoEcho, Clear, First, Accepted, Rejected, NoEcho, First, Accepted, NoEcho]);
    }

    #[test]
    fn three_readings_must_each_agree_with_the_one_before() {
        use ReadingKind::*;
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
                kind: ReadingKind::Accepted,
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
        assert_eq!(push(9_000, -1_000), ReadingKind::Accepted);
        assert_eq!(push(8_051, -1_000), ReadingKind::Rejected);
        assert_eq!(push(u32::MAX - 1, i32::MAX), ReadingKind::Rejected);
    }

    #[test]
    fn an_accepted_echo_that_fades_is_waited_for_before_a_later_one_is_believed() {
        use ReadingKind::*;
        let mut filter = filter::<4>(100, 2).with_patience(3).unwrap();
        let mut seen = |firings: &[&[u32]]| kinds(&mut filter, firings);
        assert_eq!(seen(&[&[5000, 9000], &[5000, 9000], &[5000, 9000]]), [First, Accepted, Accepted]);
        assert_eq!(seen(&[&[9000], &[5050, 9000], &[9000], &[9000]]), [Rejected, Accepted, Rejected, Rejected]);
        assert_eq!(seen(&[&[9000], &[9000], &[5000, 9000], &[5000, 9000]]), [Accepted; 4]);
    }

    #[test]
    fn silence_is_not_believed_while_an_echo_is_waited_for() {
        use ReadingKind::*;
        let firings: [&[u32]; 9] = [&[], &[], &[5000], &[5000], &[], &[], &[], &[5000], &[]];
        let mut patient = filter::<2>(100, 2).with_patience(2).unwrap();
        let seen = kinds(&mut patient, &firings);
        assert_eq!(seen, [NoEcho, Clear, First, Accepted, NoEcho, Clear, Clear, First, Clear]);
        let seen = kinds(&mut filter::<2>(100, 2), &firings);
        assert_eq!(seen, [NoEcho, Clear, First, Accepted, NoEcho, Clear, Clear, First, NoEcho]);
    }

    #[test]
    fn an_echo_heard_in_one_phase_only_is_never_accepted_however_patient_the_filter() {
        for patience in 0..=15 {
            let mut filter = filter::<8>(100, 2).with_patience(patience).unwrap();
            let firings = [[3000, 9000], [7000, 12_000]].into_iter().cycle().take(60).collect::<Vec<_>>();
            let firings: Vec<&[u32]> = firings.iter().map(|echoes| &echoes[..]).collect();
            assert!(!kinds(&mut filter, &firings).contains(&ReadingKind::Accepted));
        }
    }

    #[test]
    fn an_echo_that_is_waited_for_moves_as_expected() {
        let mut filter = filter::<2>(50, 2).with_patience(4).unwrap();
        let mut push = |us: &[u32]| {
            let echoes: Vec<_> = us.iter().map(|&us| Micros::new(us)).collect();
            filter.push_echoes(0, &echoes, -1_000).unwrap().kind
        };
        for t_echo in [10_000, 9_000, 8_000] {
            push(&[t_echo]);
        }
        push(&[]);
        assert_eq!(push(&[6_000]), ReadingKind::Accepted);
        for _ in 0..20 {
            push(&[]);
        }
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
        assert_eq!((verdict.kind, verdict.age), (ReadingKind::First, Some(1)));
    }

    #[test]
    fn errors_say_what_is_expected() {
        let error = EchoFilter::<1>::new(Micros::new(1), 9).unwrap_err();
        assert_eq!(error.to_string(), "9 consecutive readings; expected 2 to 8");
        let error = filter::<1>(1, 2).with_patience(16).unwrap_err();
        assert_eq!(error.to_string(), "a patience of 16 firings; expected 0 to 15");
        let error = filter::<1>(1, 2).push(1, None).unwrap_err();
        assert_eq!(error.to_string(), "sensor 2; expected 1 to 1");
    }

    #[test]
    fn a_sensor_with_one_echo_is_remembered_in_eight_bytes() {
        assert_eq!(size_of::<Track<1>>(), 8);
    }
}
