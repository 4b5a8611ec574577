//! A line of the atlas.

use core::fmt;
use core::str::FromStr;

use eeruf_core::Micros;
use eeruf_files::AnySchedule;

use super::rings::Ring;

/// The atlas's entry for a ring. Times are in ticks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// The ring.
    pub ring: Ring,
    /// The shortest period, or the shortest found.
    pub period: u32,
    /// Proven bound of the period; equal to the period if that is proven shortest.
    pub bound: u32,
    /// Bound that a certificate proves.
    pub certified: u32,
    /// The first 32 digits of the certificate's SHA-256; empty if this part of the atlas omits them.
    pub hash: String,
    /// True if it is proven that no schedule of this period has a larger `t_delta`, a larger interval at that
    /// `t_delta`, or a longer refire time at both.
    pub preferred: [bool; 3],
    /// Firing times of each sensor in phases a and b.
    pub fire: [Vec<u32>; 2],
}

/// The digits of firing times, two for each, the higher digit first.
const DIGITS: &[u8; 64] = b"0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz-_";
/// Number of digits of the hash.
const HASH: usize = 32;

/// The complete rows of a text; a process may have been stopped while it wrote one.
pub fn rows(text: &str) -> impl Iterator<Item = Row> + '_ {
    text.split_inclusive('\n').filter_map(|line| line.strip_suffix('\n')?.parse().ok())
}

impl Row {
    /// Returns the schedule with ticks of this length. `None` if the times make no schedule.
    #[must_use]
    pub fn schedule(&self, tick: Micros) -> Option<AnySchedule> {
        let time = |ticks: u32| Some(Micros::new(ticks.checked_mul(tick.as_micros())?));
        let times = |list: &[u32]| list.iter().map(|&ticks| time(ticks)).collect::<Option<Vec<_>>>();
        let lags = vec![Micros::ZERO; usize::from(self.ring.sensors)];
        let [a, b] = &self.fire;
        AnySchedule::from_slices(time(self.period)?, &lags, [&times(a)?, &times(b)?]).ok()
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { ring, period, bound, certified, hash, preferred, fire } = self;
        let hash = if hash.is_empty() { "-" } else { hash };
        let preferred = preferred.map(|is_proven| if is_proven { 'y' } else { 'n' });
        write!(f, "{ring} {period} {bound} {certified} {} {hash} ", preferred.iter().collect::<String>())?;
        for &time in fire.iter().flatten() {
            let digit = |of: u32| char::from(DIGITS[(of % 64) as usize]);
            write!(f, "{}{}", digit(time / 64), digit(time))?;
        }
        Ok(())
    }
}

impl FromStr for Row {
    type Err = String;

    fn from_str(line: &str) -> Result<Self, String> {
        let bad = |what: &str| format!("{line:?}: {what}");
        let words: Vec<&str> = line.split(' ').collect();
        let [.., period, bound, certified, preferred, hash, times] = words[..] else {
            return Err(bad("expected twelve words"));
        };
        let ring: Ring = words[..words.len() - 6].join(" ").parse()?;
        let number = |word: &str| word.parse::<u32>().map_err(|_| bad("expected a number"));
        let proven: Vec<bool> = preferred.chars().map(|letter| letter == 'y').collect();
        let preferred = proven.try_into().map_err(|_| bad("expected three letters y or n"))?;
        let hash = hash.strip_prefix('-').unwrap_or(hash);
        if !hash.is_empty() && hash.len() != HASH || !hash.bytes().all(|digit| digit.is_ascii_hexdigit()) {
            return Err(bad("expected 32 digits of a hash"));
        }
        let value = |digit: &u8| DIGITS.iter().position(|other| other == digit).map(|value| value as u32);
        let time = |digits: &[u8]| Some(64 * value(digits.first()?)? + value(digits.get(1)?)?);
        let times: Option<Vec<u32>> = times.as_bytes().chunks(2).map(time).collect();
        let sensors = usize::from(ring.sensors);
        let times =
            times.filter(|times| times.len() == 2 * sensors).ok_or_else(|| bad("expected two times a sensor"))?;
        let (a, b) = times.split_at(sensors);
        Ok(Self {
            ring,
            period: number(period)?,
            bound: number(bound)?,
            certified: number(certified)?,
            hash: hash.to_owned(),
            preferred,
            fire: [a.to_vec(), b.to_vec()],
        })
    }
}
