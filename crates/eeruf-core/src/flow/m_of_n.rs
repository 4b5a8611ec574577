//! [`MOfN`]: accepts a reading if m of the sensor's last n agree.

use super::motion::{Motion, Rate};
use crate::filter::{NO_ECHO, SILENCE, shift};
use crate::judging::{Age, Explained, Heard, Judge, Pace, Quiet, Sounds};
use crate::reading::{ReadingKind, Verdict};
use crate::ring_error::RingError;
use crate::time::{Instant, Micros};

/// No reading to compare with.
const NOTHING: Micros = NO_ECHO;

/// A reading, and the expected change since then.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Vote {
    /// The earliest echo, [`SILENCE`] or [`NOTHING`].
    echo: Micros,
    /// The change that odometry expects, in microseconds.
    expected_us: i32,
    /// The further change that the robot's motion allows, in microseconds.
    grown: u16,
}

impl Vote {
    const NOTHING: Self = Self { echo: NOTHING, expected_us: 0, grown: 0 };

    fn agrees(&self, echo: Micros, t_delta: Micros) -> bool {
        if self.echo >= SILENCE || echo >= SILENCE {
            return self.echo == echo;
        }
        let [then, now] = [self.echo, echo].map(|echo| i64::from(echo.as_micros()));
        (now - then - i64::from(self.expected_us)).unsigned_abs()
            <= u64::from(t_delta.as_micros()) + u64::from(self.grown)
    }
}

/// A sensor's state: 12 bytes per reading, plus six.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Known<const N: usize> {
    /// The last readings, the latest first.
    last: [Vote; N],
    /// The greatest rate of change since the sensor's last firing.
    rate: Rate,
    age: Age,
    is_clear: bool,
    /// True if the sensor of the last reading still holds its line.
    is_held: bool,
}

impl<const N: usize> Known<N> {
    const NOTHING: Self =
        Self { last: [Vote::NOTHING; N], rate: Rate::STANDING, age: Age::NEVER, is_clear: false, is_held: false };

    fn push(&mut self, echo: Micros) {
        self.last.rotate_right(1);
        if let Some(last) = self.last.first_mut() {
            *last = Vote { echo, ..Vote::NOTHING };
        }
    }

    fn verdict(&mut self, kind: ReadingKind, heard: &Heard<'_>) -> Verdict {
        self.is_clear = kind == ReadingKind::Clear;
        let previous = self.last.first().map(|last| last.echo).filter(|&echo| echo < SILENCE);
        let t_echo = heard.echoes.first().copied();
        Verdict { kind, t_echo, previous, age: self.age.count(kind), explained_by: None }
    }
}

/// A judge that accepts a reading if `m` of its sensor's last `n` readings, itself included, agree with it, and nothing
/// foreign explains any pair of them. Use 3 of 4 for stops and maps, 2 of 2 or 2 of 3 for less delay. `N` is the
/// capacity, at most five.
///
/// Two readings agree if, after the change that odometry expects, they differ by at most `T_delta` plus the change that
/// the robot's motion allows; P grows by as much. Silence agrees with silence. A single reading never suffices: an
/// accepted reading has `m` witnesses, which one path of foreign sound never has if `m` is 2 or more. The ring should
/// remember `n + 2` firings of each sensor, or readings are [`Ambiguous`](ReadingKind::Ambiguous) because of forgotten
/// ones.
///
/// It suits rings whose waits differ from firing to firing, such as flow rings: under a table of two phases every
/// second reading has the same crosstalk. Wrapped in [`Agreement`](crate::judge::Agreement), it is a voting baseline;
/// with 1 of 1 it accepts every echo.
///
/// ```
/// use eeruf_core::{Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, judge::MOfN};
/// use eeruf_core::flow::{InTurn, TurnSettings};
/// let (window, turns) = (Micros::from_millis(25), TurnSettings::new(0x1234_5678));
/// let plan = InTurn::<6>::new(6, turns, window, Instant::from_micros(0))?;
/// let judge = MOfN::<6, 4>::new(3, 4, Micros::new(80))?;
/// let config = RingConfig::new().with_window(window).with_path_change(Micros::new(150));
/// let mut ring = Ring::<_, _, 6, 1, 6>::judged_by(plan, judge, config, Instant::from_micros(0))?;
/// let (mut readings, mut accepted) = (0, 0);
/// while readings < 100 {
///     let now = ring.next_deadline();
///     while let Some(event) = ring.poll(now) {
///         match event {
///             RingEvent::Fire { sensor, .. } => ring.echo(sensor, now + Micros::from_millis(12))?,
///             RingEvent::Reading(reading) => {
///                 readings += 1;
///                 accepted += u32::from(reading.kind == ReadingKind::Accepted);
///             }
///             _ => {}
///         }
///     }
/// }
/// assert!(accepted > 75, "{accepted}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MOfN<const K: usize, const N: usize> {
    m: u8,
    n: u8,
    t_delta: Micros,
    motion: Motion,
    /// True if the robot moved at the last reading or, according to the last report, moves now.
    moves: bool,
    /// The quiet that the last reading calls for.
    quiet: Quiet,
    known: [Known<N>; K],
}

impl<const K: usize, const N: usize> MOfN<K, N> {
    /// A judge without readings, for a robot that stands still until it reports a speed.
    ///
    /// # Errors
    /// [`RingError::Setting`] unless `m` is 1 to `n`, and `n` 1 to `N`.
    pub const fn new(m: u8, n: u8, t_delta: Micros) -> Result<Self, RingError> {
        const { assert!(N >= 1 && N <= 5, "votes of the last N readings; expected 1 to 5") };
        if n == 0 || n as usize > N {
            return Err(RingError::Setting { name: "n", value: n as u32, least: 1, most: N as u32 });
        }
        if m == 0 || m > n {
            return Err(RingError::Setting { name: "m", value: m as u32, least: 1, most: n as u32 });
        }
        let (motion, quiet, known) = (Motion::new(0), Quiet::Same, [Known::NOTHING; K]);
        Ok(Self { m, n, t_delta, motion, moves: false, quiet, known })
    }

    /// Sets the speed in mm/s that is assumed for a robot that reports none.
    #[must_use]
    pub const fn with_top_speed(self, speed_mm_s: u16) -> Self {
        Self { motion: Motion::new(speed_mm_s), moves: speed_mm_s > 0, ..self }
    }

    /// Adds the change up to this reading to the earlier readings.
    fn grow(&mut self, heard: &Heard<'_>) {
        let (rate, recent) = (self.motion.rate(heard.fired), self.motion.recent(heard.fired));
        self.moves = rate.moves();
        let Some(known) = self.known.get_mut(usize::from(heard.sensor)) else { return };
        let span = core::mem::replace(&mut known.rate, recent).max(recent).grow(heard.since_before);
        for vote in &mut known.last {
            vote.expected_us = vote.expected_us.saturating_add(heard.firing.expected_change_us);
            vote.grown = vote.grown.saturating_add(u16::try_from(span.as_micros()).unwrap_or(u16::MAX));
        }
    }
}

impl<const K: usize, const N: usize> Judge for MOfN<K, N> {
    fn t_delta(&self) -> Micros {
        self.t_delta
    }

    fn judge(&mut self, heard: &Heard<'_>, sounds: &impl Sounds) -> Verdict {
        self.grow(heard);
        let Some(known) = self.known.get_mut(usize::from(heard.sensor)) else { return heard.unjudged(None) };
        if core::mem::take(&mut known.is_held) && heard.since_before == Micros::ZERO {
            // This silence replaces the reading made while the line was held.
            known.last.rotate_left(1);
        }
        let echo = heard.echoes.first().copied().unwrap_or(SILENCE);
        let before = known.last.iter().take(usize::from(self.n) - 1);
        let (mut votes, mut explained_by, mut is_first) = (1, None, true);
        for (ago, vote) in (1..).zip(before) {
            is_first &= vote.echo == NOTHING;
            if !vote.agrees(echo, heard.t_delta) {
                continue;
            }
            if echo < SILENCE {
                let grown = Micros::new(vote.grown.into());
                if let Explained::By(by) = sounds.explain_after(ago, vote.echo, echo, grown) {
                    explained_by = explained_by.or(Some(by));
                    continue;
                }
            }
            votes += 1;
        }
        let kind = match (votes >= self.m, echo < SILENCE) {
            (true, true) => ReadingKind::Accepted,
            (true, false) => ReadingKind::Clear,
            (false, false) => ReadingKind::NoEcho,
            _ if explained_by.is_some() => ReadingKind::Ambiguous,
            _ if votes > 1 => ReadingKind::Repeated,
            _ if is_first => ReadingKind::First,
            _ => ReadingKind::Rejected,
        };
        self.quiet = match kind {
            ReadingKind::Accepted | ReadingKind::Clear => Quiet::Less,
            ReadingKind::NoEcho => Quiet::Same,
            _ if sounds.is_masked(echo) => Quiet::More,
            _ => Quiet::Same,
        };
        let verdict = known.verdict(kind, heard);
        known.push(echo);
        Verdict { explained_by: explained_by.filter(|_| kind == ReadingKind::Ambiguous), ..verdict }
    }

    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict {
        self.grow(heard);
        self.quiet = Quiet::Same;
        let Some(known) = self.known.get_mut(usize::from(heard.sensor)) else { return heard.unjudged(Some(kind)) };
        let verdict = known.verdict(kind, heard);
        known.push(NOTHING);
        verdict
    }

    fn hold(&mut self, heard: &Heard<'_>) {
        self.grow(heard);
        self.quiet = Quiet::Same;
        if let Some(known) = self.known.get_mut(usize::from(heard.sensor)) {
            known.is_held = true;
            known.push(NOTHING);
        }
    }

    fn age(&self, sensor: u8) -> Option<u16> {
        self.known.get(usize::from(sensor))?.age.get()
    }

    fn is_clear(&self, sensor: u8) -> bool {
        self.known.get(usize::from(sensor)).is_some_and(|known| known.is_clear)
    }

    fn moving(&mut self, speed_mm_s: u32, turn_mrad_s: u32, now: Instant) {
        let rate = self.motion.set(speed_mm_s, turn_mrad_s, now);
        for known in &mut self.known {
            known.rate = known.rate.max(rate);
        }
        self.moves = self.motion.rate(now).moves();
    }

    fn pace(&self) -> Pace {
        Pace { moves: self.moves, every_echo: self.m == 1 }
    }

    fn quiet(&self) -> Quiet {
        self.quiet
    }

    fn forget(&mut self, sensor: u8) {
        if let Some(known) = self.known.get_mut(usize::from(sensor)) {
            *known = Known { age: known.age, rate: known.rate, ..Known::NOTHING };
        }
    }

    fn restart(&mut self) {
        for sensor in 0..K as u8 {
            self.forget(sensor);
        }
    }

    fn fired_later(&mut self, sensor: u8, later_us: i32) {
        let last = self.known.get_mut(usize::from(sensor)).and_then(|known| known.last.first_mut());
        if let Some(last) = last.filter(|last| last.echo < SILENCE) {
            shift(core::array::from_mut(&mut last.echo), later_us);
        }
    }
}
