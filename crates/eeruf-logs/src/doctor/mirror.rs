//! Two sensors that read each other's sound: the path is the same both ways, so their readings differ by twice the lag
//! between their firings, however the robot moves.

use super::series::Series;

/// Agreement of two sensors' readings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Mirrored {
    /// Firings in which both have an echo.
    pub(crate) both: u32,
    /// Number of readings that agree with mutual crosstalk.
    pub(crate) agree: u32,
    /// Number of readings that nearly agree: a difference that only passes by this value gives three times as many,
    /// since the band is three times as wide.
    pub(crate) nearly: u32,
    /// Number of readings far from agreement: two sensors that fire together at one wall would have none.
    pub(crate) far: u32,
    /// The range in microseconds of the readings that agree.
    pub(crate) spread_us: f64,
    /// Difference in microseconds below which echo times are equal.
    pub(crate) same_us: f64,
}

/// Least difference of echo times from different walls.
const FAR_US: f64 = 1000.0;
/// Limits of "nearly equal", in units of the tolerance: the band is three times as wide.
const NEARLY: [f64; 2] = [1.5, 4.5];

/// Compares two sensors that fire within half a period of each other.
pub(crate) fn mirrored(x: &Series, y: &Series, period_us: f64) -> Mirrored {
    let same_us = x.scatter().same_us(y.scatter());
    let (mut next, mut differences, mut agreeing) = (0, vec![], vec![]);
    for (&at, &echo) in x.at_us.iter().zip(&x.echo_us) {
        while next + 1 < y.at_us.len() && (y.at_us[next + 1] - at).abs() <= (y.at_us[next] - at).abs() {
            next += 1;
        }
        let (Some(&fired), Some(&other)) = (y.at_us.get(next), y.echo_us.get(next)) else { break };
        let lag = at - fired;
        if lag.abs() > 0.5 * period_us || echo.is_nan() || other.is_nan() {
            continue;
        }
        let difference = echo - other + 2.0 * lag;
        if difference.abs() <= same_us {
            agreeing.push(echo);
        }
        differences.push(difference);
    }
    let nearly = differences.iter().filter(|us| (NEARLY[0]..NEARLY[1]).contains(&(us.abs() / same_us))).count() as u32;
    let far = differences.iter().filter(|us| us.abs() >= FAR_US.max(5.0 * same_us)).count() as u32;
    agreeing.sort_by(f64::total_cmp);
    let part = |share: usize| agreeing.get(agreeing.len() * share / 20).copied().unwrap_or(0.0);
    Mirrored {
        both: differences.len() as u32,
        agree: agreeing.len() as u32,
        nearly,
        far,
        spread_us: part(19) - part(1),
        same_us,
    }
}

impl Mirrored {
    /// Returns true if the two read each other's sound, and neither chance nor a common wall explains it.
    pub(crate) fn is_mutual(&self) -> bool {
        self.agree >= 24
            && self.agree >= self.nearly
            && 10 * self.far >= self.both
            && self.spread_us >= 2.0 * self.same_us
    }
}
