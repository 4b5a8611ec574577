//! [`RateFilter`]: three consecutive readings on a line, for a robot that moves and has no odometry.

use crate::judging::{Age, Heard, Judge, NoSounds, Sounds};
use crate::reading::{Explanation, ReadingKind, Verdict};
use crate::ring_error::RingError;
use crate::sensor_error::SensorError;
use crate::time::{Instant, Micros};

/// Accepts the third of three consecutive readings if the second one lies within `t_delta` of the line between the
/// first and the third, over the times at which the sensor really fired. So an echo may change at any constant rate,
/// up to a limit, without odometry; crosstalk that the schedule moves by more than `t_delta` between two readings is as
/// far from the line as it moves: `docs/explanation/theory.md` section 2.2.
///
/// It is for readings of two phases, as the judge of a [`Ring`](crate::Ring), which should remember five firings of
/// each sensor then, or alone: hand in the echo time of each reading with the instant of its firing. It takes 20 bytes
/// a sensor.
///
/// ```
/// use eeruf_core::{Instant, Micros, ReadingKind, judge::RateFilter};
/// // Echoes change by up to 2 v / c: 5,828 us/s for each m/s at 343.2 m/s.
/// let mut filter = RateFilter::<1>::new(Micros::new(500), 2 * 5_828)?;
/// let mut push = |fired_us, echo_us| {
///     let verdict = filter.push(0, Instant::from_micros(fired_us), Some(Micros::new(echo_us)));
///     verdict.map(|verdict| verdict.kind)
/// };
/// // At 1.5 m/s towards a wall, and firings 76 and 124 ms apart: no two readings are within t_delta.
/// push(0, 12_000)?;
/// assert_eq!(push(76_000, 11_336)?, ReadingKind::Repeated);
/// assert_eq!(push(200_000, 10_252)?, ReadingKind::Accepted);
/// assert_eq!(push(276_000, 9_588)?, ReadingKind::Accepted);
/// assert_eq!(push(400_000, 12_000)?, ReadingKind::Rejected);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RateFilter<const K: usize> {
    sensors: [Line; K],
    t_delta: Micros,
    us_per_s: u32,
}

/// State of one sensor's line.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Line {
    /// The last two firings, the later one first.
    fired: [Instant; 2],
    echoes: [u32; 2],
    /// Number of those that had an echo, or that the last one or the last two had none.
    known: Known,
    age: Age,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Known {
    Nothing,
    Silence,
    Clear,
    One,
    Two,
}

/// Firings further apart, 16.7 s, are no longer compared; nor are later echoes. Products of the two fit into 64 bits.
const LONGEST: u32 = (1 << 24) - 1;

impl Line {
    const NEW: Self =
        Self { fired: [Instant::from_micros(0); 2], echoes: [0; 2], known: Known::Nothing, age: Age::NEVER };
}

impl<const K: usize> RateFilter<K> {
    /// The fastest that an echo may change: a robot at 69 m/s.
    const MOST_US_PER_S: u32 = 400_000;

    /// A filter that knows no readings yet. `us_per_s` is by how much an echo may change at most in a second, `2 v / c`
    /// for a robot that drives at up to v: what is faster is no echo, which makes accidents rarer.
    ///
    /// # Errors
    /// [`RingError::Rate`] for more than 400,000 us/s.
    pub const fn new(t_delta: Micros, us_per_s: u32) -> Result<Self, RingError> {
        if us_per_s > Self::MOST_US_PER_S {
            return Err(RingError::Rate { us_per_s });
        }
        Ok(Self { sensors: [Line::NEW; K], t_delta, us_per_s })
    }

    /// Takes in one firing of a sensor (from 0): when it fired, and the time of its echo, or `None` without echo.
    /// Echoes after 16.7 s count as none. The verdict is [`Accepted`](ReadingKind::Accepted) for the third reading on a
    /// line, [`Repeated`](ReadingKind::Repeated) for one that may be the second, [`First`](ReadingKind::First),
    /// [`Rejected`](ReadingKind::Rejected), [`NoEcho`](ReadingKind::NoEcho), or [`Clear`](ReadingKind::Clear) for the
    /// second silence in a row. Nothing is asked about what was fired: no promise about foreign sound holds here.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn push(&mut self, sensor: u8, fired: Instant, t_echo: Option<Micros>) -> Result<Verdict, SensorError> {
        let limits = Limits { t_delta: self.t_delta, us_per_s: self.us_per_s };
        let line = self.sensors.get_mut(usize::from(sensor)).ok_or(SensorError::new(sensor, K))?;
        Ok(line.push(fired, t_echo, limits, &NoSounds))
    }

    /// Forgets the readings of a sensor, so that its next one is compared with nothing. The age goes on.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn forget(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.sensors.get_mut(usize::from(sensor)).ok_or(SensorError::new(sensor, K))?.known = Known::Nothing;
        Ok(())
    }
}

impl Line {
    fn previous(&self) -> Option<Micros> {
        matches!(self.known, Known::One | Known::Two).then_some(Micros::new(self.echoes[0]))
    }

    fn push(&mut self, fired: Instant, t_echo: Option<Micros>, limits: Limits, sounds: &impl Sounds) -> Verdict {
        let Limits { t_delta, us_per_s } = limits;
        let t_delta = t_delta.as_micros();
        let Some(echo) = t_echo.map(Micros::as_micros).filter(|&echo| echo <= LONGEST) else {
            let previous = self.previous();
            let again = matches!(self.known, Known::Silence | Known::Clear);
            self.known = if again { Known::Clear } else { Known::Silence };
            let kind = if again { ReadingKind::Clear } else { ReadingKind::NoEcho };
            return self.verdict(kind, None, previous, None);
        };
        let [since, before] = [fired.since(self.fired[0]), self.fired[0].since(self.fired[1])].map(Micros::as_micros);
        if self.known != Known::Nothing && !(1..=LONGEST).contains(&since) {
            // A gap, or a clock that went back.
            self.known = Known::Nothing;
        }
        let previous = self.previous();
        let [last, first] = self.echoes;
        let may_change = |echo: u32, from: u32, within: u32| {
            let most = u64::from(within) * u64::from(us_per_s) / 1_000_000 + u64::from(t_delta);
            u64::from(echo.abs_diff(from)) <= most
        };
        let mut explained_by = None;
        let kind = match self.known {
            Known::Nothing | Known::Silence | Known::Clear => ReadingKind::First,
            Known::Two
                if is_on_line([first, last, echo], [before, since], t_delta)
                    && may_change(echo, first, before + since) =>
            {
                explained_by = sounds.explain_line([first, last, echo].map(Micros::new)).reason();
                if explained_by.is_some() { ReadingKind::Ambiguous } else { ReadingKind::Accepted }
            }
            _ if may_change(echo, last, since) => ReadingKind::Repeated,
            _ => ReadingKind::Rejected,
        };
        self.known = match self.known {
            Known::Nothing | Known::Silence | Known::Clear => Known::One,
            Known::One | Known::Two => Known::Two,
        };
        (self.fired, self.echoes) = ([fired, self.fired[0]], [echo, last]);
        self.verdict(kind, t_echo, previous, explained_by)
    }

    fn verdict(
        &mut self,
        kind: ReadingKind,
        t_echo: Option<Micros>,
        previous: Option<Micros>,
        explained_by: Option<Explanation>,
    ) -> Verdict {
        Verdict { kind, t_echo, previous, age: self.age.count(kind), explained_by }
    }
}

/// The most that echoes may be off the line, and the fastest that they may change.
#[derive(Clone, Copy)]
struct Limits {
    t_delta: Micros,
    us_per_s: u32,
}

impl<const K: usize> Judge for RateFilter<K> {
    fn t_delta(&self) -> Micros {
        self.t_delta
    }

    fn judge(&mut self, heard: &Heard<'_>, sounds: &impl Sounds) -> Verdict {
        let limits = Limits { t_delta: heard.t_delta, us_per_s: self.us_per_s };
        match self.sensors.get_mut(usize::from(heard.sensor)) {
            Some(line) => line.push(heard.fired, heard.echoes.first().copied(), limits, sounds),
            None => heard.unjudged(None),
        }
    }

    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict {
        let Some(line) = self.sensors.get_mut(usize::from(heard.sensor)) else { return heard.unjudged(Some(kind)) };
        line.known = Known::Nothing;
        line.verdict(kind, heard.echoes.first().copied(), None, None)
    }

    fn hold(&mut self, heard: &Heard<'_>) {
        if let Some(line) = self.sensors.get_mut(usize::from(heard.sensor)).filter(|line| line.previous().is_some()) {
            line.known = Known::Nothing;
        }
    }

    fn age(&self, sensor: u8) -> Option<u16> {
        self.sensors.get(usize::from(sensor))?.age.get()
    }

    fn is_clear(&self, sensor: u8) -> bool {
        self.sensors.get(usize::from(sensor)).is_some_and(|line| line.known == Known::Clear)
    }

    fn forget(&mut self, sensor: u8) {
        if let Some(line) = self.sensors.get_mut(usize::from(sensor)) {
            line.known = Known::Nothing;
        }
    }

    fn restart(&mut self) {
        for line in &mut self.sensors {
            line.known = Known::Nothing;
        }
    }

    fn fired_later(&mut self, sensor: u8, _later_us: i32) {
        // Rare, and three readings later all is as before.
        Judge::forget(self, sensor);
    }
}

/// Returns true if the second of three echoes lies within `t_delta` of the line between the first and the third, where
/// firings came so long after one another. All are below 2^24.
fn is_on_line(echoes: [u32; 3], [before, since]: [u32; 2], t_delta: u32) -> bool {
    let [first, second, third] = echoes.map(i64::from);
    let [before, since] = [before, since].map(i64::from);
    // The deviation, times the time from the first firing to the third.
    let off = (second - first) * since - (third - second) * before;
    off.unsigned_abs() <= u64::from(t_delta) * (before + since).unsigned_abs()
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;
    use std::vec::Vec;

    fn kinds(readings: &[(u32, Option<u32>)]) -> Vec<ReadingKind> {
        let mut filter = RateFilter::<1>::new(Micros::new(500), 10_000).unwrap();
        let push = |&(fired, echo): &(u32, Option<u32>)| {
            filter.push(0, Instant::from_micros(fired), echo.map(Micros::new)).unwrap().kind
        };
        readings.iter().map(push).collect()
    }

    // A reading just within t delta of the line is accepted and one just beyond is not.
    #[test]
    fn reading_within_t_delta_of_line_is_accepted() {
        use ReadingKind::*;
        // Firings 100 and 300 us apart: the line is a quarter of the way up at the second.
        let at = |second| kinds(&[(0, Some(8_000)), (100, Some(second)), (400, Some(8_400))]);
        assert_eq!([at(8_600)[2], at(8_601)[2], at(7_600)[2], at(7_599)[2]], [Accepted, Repeated, Accepted, Rejected]);
    }

    // An echo that changes faster than any robot drives is rejected though on a line.
    #[test]
    fn echo_faster_than_any_robot_is_rejected() {
        use ReadingKind::*;
        let at =
            |slope: u32| kinds(&[(0, Some(8_000)), (100_000, Some(8_000 + slope)), (200_000, Some(8_000 + 2 * slope))]);
        // 2 ms in 200 ms, and t_delta.
        assert_eq!([at(1250)[2], at(1251)[2], at(1501)[2]], [Accepted, Repeated, Rejected]);
    }

    #[test]
    fn silence_a_gap_and_a_clock_that_goes_back_begin_anew() {
        use ReadingKind::*;
        let silent =
            [(0, Some(8_000)), (100, None), (200, None), (300, Some(8_000)), (400, Some(8_000)), (500, Some(8_000))];
        assert_eq!(kinds(&silent), [First, NoEcho, Clear, First, Repeated, Accepted]);
        let gap = [(0, Some(8_000)), (100, Some(8_000)), (20_000_000, Some(8_000)), (20_000_100, Some(8_000))];
        assert_eq!(kinds(&gap), [First, Repeated, First, Repeated]);
        assert_eq!(kinds(&[(100, Some(8_000)), (200, Some(8_000)), (150, Some(8_000))]), [First, Repeated, First]);
        assert_eq!(kinds(&[(100, Some(8_000)), (100, Some(8_000))]), [First, First]);
    }

    // The age counts readings since the last accepted one and is none before the first.
    #[test]
    fn age_counts_readings_since_last_accepted() {
        let mut filter = RateFilter::<1>::new(Micros::new(500), 0).unwrap();
        let age = |(number, echo): (u32, u32)| {
            filter.push(0, Instant::from_micros(100 * number), Some(Micros::new(echo))).unwrap().age
        };
        let readings = [8_000, 8_000, 8_000, 12_000, 8_000, 8_000, 8_000];
        let ages: Vec<_> = (0..).zip(readings).map(age).collect();
        assert_eq!(ages, [None, None, Some(0), Some(1), Some(2), Some(3), Some(0)]);
    }

    #[test]
    fn the_longest_times_are_compared_without_overflow() {
        use ReadingKind::*;
        let longest = Some(LONGEST);
        let far = [(0, longest), (LONGEST, Some(0)), (2 * LONGEST, longest), (3 * LONGEST, Some(LONGEST + 1))];
        assert_eq!(kinds(&far), [First, Rejected, Rejected, NoEcho]);
        assert_eq!(
            RateFilter::<1>::new(Micros::MAX, 400_000).unwrap().push(0, Instant::from_micros(0), None).unwrap().kind,
            NoEcho
        );
        assert_eq!(size_of::<Line>(), 20);
    }

    #[test]
    fn each_error_names_what_is_wrong_and_what_is_expected() {
        let error = RateFilter::<1>::new(Micros::new(500), 400_001).unwrap_err();
        assert_eq!(error.to_string(), "echoes that change by 400001 us/s; expected 0 to 400000 us/s");
        let mut filter = RateFilter::<1>::new(Micros::new(500), 0).unwrap();
        assert!(filter.push(1, Instant::from_micros(0), None).is_err() && filter.forget(1).is_err());
    }
}
