//! The filter, for readings that no board has filtered.

use eeruf_core::{EchoFilter, MAX_SENSORS, Micros, ReadingKind};

/// A raw reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Raw {
    /// The time from firing to the first echo.
    Echo(Micros),
    /// No echo.
    Nothing,
    /// An echo from closer than can be measured, which is compared with nothing.
    TooEarly,
}

pub(crate) struct RangeFilter(EchoFilter<MAX_SENSORS>);

impl RangeFilter {
    /// Two readings in a row within `t_delta`, as in the paper.
    pub(crate) fn new(t_delta: Micros) -> Result<Self, String> {
        EchoFilter::new(t_delta, 2).map(Self).map_err(|error| error.to_string())
    }

    /// Outcome of a reading of a sensor, which must be less than 64.
    pub(crate) fn push(&mut self, sensor: u8, raw: Raw) -> Result<ReadingKind, String> {
        let kind = match raw {
            Raw::Echo(t_echo) => self.0.push(sensor, Some(t_echo)).map(|verdict| verdict.kind),
            Raw::Nothing => self.0.push(sensor, None).map(|verdict| verdict.kind),
            Raw::TooEarly => self.0.forget(sensor).map(|()| ReadingKind::TooEarly),
        };
        kind.map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // A reading is compared with the one before of its sensor and with nothing too close.
    #[test]
    fn reading_is_compared_with_the_one_before() {
        let mut filter = RangeFilter::new(Micros::new(500)).unwrap();
        let echo = |us| Raw::Echo(Micros::new(us));
        let mut kinds = |sensor, raws: &[Raw]| {
            raws.iter().map(|&raw| filter.push(sensor, raw).unwrap().as_str()).collect::<Vec<_>>()
        };
        assert_eq!(kinds(0, &[echo(9_000), echo(9_500), echo(11_000)]), ["first", "accepted", "rejected"]);
        assert_eq!(kinds(1, &[echo(11_000), Raw::TooEarly, echo(11_000)]), ["first", "too_early", "first"]);
        assert_eq!(kinds(0, &[Raw::Nothing, Raw::Nothing]), ["no_echo", "clear"]);
        assert!(filter.push(64, Raw::Nothing).is_err());
    }
}
