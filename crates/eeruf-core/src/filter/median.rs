//! [`MedianFilter`]: the median of a sensor's last readings, a baseline.

use super::echoes::{NO_ECHO, SILENCE, echo_time, shift};
use crate::judging::{Age, Heard, Judge, Sounds};
use crate::reading::{ReadingKind, Verdict};
use crate::ring_error::RingError;
use crate::time::Micros;

/// Marker of a missing reading.
const NOTHING: Micros = NO_ECHO;

/// A judge that reports the median of a sensor's last three readings, or of another number up to `N`; silence counts as
/// farther than any echo. It is a baseline: it accepts foreign sound that repeats.
///
/// The echo time of a reading may be that of an earlier firing: see [`Judge::stands_for`].
///
/// ```
/// use eeruf_core::{Instant, Micros, ReadingKind, judge::{FiringContext, Heard, Judge, MedianFilter, NoSounds}, Phase};
/// let mut median = MedianFilter::<1>::new(3, Micros::ZERO)?;
/// let mut push = |echoes_us: &[u32]| {
///     let echoes: Vec<_> = echoes_us.iter().copied().map(Micros::new).collect();
///     let (fired, firing) = (Instant::from_micros(0), FiringContext::new(Phase::A));
///     let (since_before, t_delta) = (Micros::ZERO, Micros::ZERO);
///     let heard = Heard { sensor: 0, fired, since_before, echoes: &echoes, firing, t_delta };
///     let verdict = median.judge(&heard, &NoSounds);
///     (verdict.kind, verdict.t_echo.map(Micros::as_micros), median.stands_for(0))
/// };
/// assert_eq!(push(&[9_000]), (ReadingKind::First, Some(9_000), 0));
/// assert_eq!(push(&[]), (ReadingKind::NoEcho, None, 0));
/// assert_eq!(push(&[3_000]), (ReadingKind::Accepted, Some(9_000), 2));
/// assert_eq!(push(&[]), (ReadingKind::Clear, None, 0));
/// # Ok::<(), eeruf_core::RingError>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MedianFilter<const K: usize, const N: usize = 3> {
    of: u8,
    t_delta: Micros,
    sensors: [Last<N>; K],
}

/// A sensor's last readings.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Last<const N: usize> {
    /// Earliest echoes, [`SILENCE`] or [`NOTHING`].
    echoes: [Micros; N],
    /// Place of the next reading, which replaces the oldest.
    next: u8,
    stands_for: u8,
    is_clear: bool,
    age: Age,
}

impl<const K: usize, const N: usize> MedianFilter<K, N> {
    /// A judge without readings that reports the median of `of` readings; if `of` is even, the nearer of the two in the
    /// middle. `t_delta` is for the ring around it.
    ///
    /// # Errors
    /// [`RingError::Setting`] unless `of` is 1 to `N`.
    pub const fn new(of: u8, t_delta: Micros) -> Result<Self, RingError> {
        if of == 0 || of as usize > N {
            return Err(RingError::Setting { name: "of", value: of as u32, least: 1, most: N as u32 });
        }
        Ok(Self { of, t_delta, sensors: [Last::NOTHING; K] })
    }
}

impl<const N: usize> Last<N> {
    const NOTHING: Self = Self { echoes: [NOTHING; N], next: 0, stands_for: 0, is_clear: false, age: Age::NEVER };

    /// Stores a reading. Returns the echoes with their places.
    fn push(&mut self, echo: Micros, of: u8) -> [(Micros, u8); N] {
        if let Some(oldest) = self.echoes.get_mut(usize::from(self.next)) {
            *oldest = echo;
        }
        self.next = if self.next + 1 == of { 0 } else { self.next + 1 };
        // At most 255.
        core::array::from_fn(|place| (self.echoes.get(place).copied().unwrap_or(NOTHING), place as u8))
    }

    fn verdict(&mut self, kind: ReadingKind, t_echo: Option<Micros>, stands_for: u8) -> Verdict {
        (self.stands_for, self.is_clear) = (stands_for, kind == ReadingKind::Clear);
        Verdict { kind, t_echo, previous: None, age: self.age.count(kind), explained_by: None }
    }
}

impl<const K: usize, const N: usize> Judge for MedianFilter<K, N> {
    fn t_delta(&self) -> Micros {
        self.t_delta
    }

    fn judge(&mut self, heard: &Heard<'_>, _: &impl Sounds) -> Verdict {
        let of = self.of;
        let Some(last) = self.sensors.get_mut(usize::from(heard.sensor)) else { return heard.unjudged(None) };
        let mut all = last.push(heard.echoes.first().copied().unwrap_or(SILENCE), of);
        let all = all.get_mut(..usize::from(of)).unwrap_or_default();
        all.sort_unstable();
        let median = all.get(usize::from(of - 1) / 2).copied();
        let known = all.last().is_some_and(|latest| latest.0 != NOTHING);
        let Some((echo, place)) = median.filter(|_| known) else {
            let Verdict { kind, t_echo, .. } = heard.unjudged(None);
            return last.verdict(kind, t_echo, 0);
        };
        let (kind, t_echo) = match echo {
            SILENCE => (ReadingKind::Clear, None),
            _ => (ReadingKind::Accepted, echo_time(echo)),
        };
        let ago = last.next.checked_sub(place + 1).unwrap_or(last.next + (of - 1 - place));
        last.verdict(kind, t_echo, ago)
    }

    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict {
        let of = self.of;
        let Some(last) = self.sensors.get_mut(usize::from(heard.sensor)) else { return heard.unjudged(Some(kind)) };
        last.push(NOTHING, of);
        last.verdict(kind, heard.echoes.first().copied(), 0)
    }

    fn hold(&mut self, _: &Heard<'_>) {}

    fn age(&self, sensor: u8) -> Option<u16> {
        self.sensors.get(usize::from(sensor))?.age.get()
    }

    fn is_clear(&self, sensor: u8) -> bool {
        self.sensors.get(usize::from(sensor)).is_some_and(|last| last.is_clear)
    }

    fn stands_for(&self, sensor: u8) -> u8 {
        self.sensors.get(usize::from(sensor)).map_or(0, |last| last.stands_for)
    }

    fn forget(&mut self, sensor: u8) {
        if let Some(last) = self.sensors.get_mut(usize::from(sensor)) {
            *last = Last { age: last.age, ..Last::NOTHING };
        }
    }

    fn restart(&mut self) {
        for sensor in 0..K as u8 {
            Judge::forget(self, sensor);
        }
    }

    fn fired_later(&mut self, sensor: u8, later_us: i32) {
        let Some(last) = self.sensors.get_mut(usize::from(sensor)) else { return };
        let latest = usize::from(if last.next == 0 { self.of } else { last.next }) - 1;
        if let Some(echo) = last.echoes.get_mut(latest).filter(|echo| **echo < SILENCE) {
            shift(core::array::from_mut(echo), later_us);
        }
    }
}
