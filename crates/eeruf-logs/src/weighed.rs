//! [`Weighed`]: how the tracker of a hopping ring weighed a reading, and how logs have it.

use eeruf_core::ReadingKind;
use serde_json::Value;

/// The tracker's weighing of a reading in a hopping ring, beside its phase and echo time: what
/// [`replay`](crate::replay()) needs to do the same again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Weighed {
    /// Its place in the order in which the ring gave its readings: an early echo comes before the late one of a sensor
    /// that fired sooner. Of a log without the column, its place among the rows.
    pub given: u64,
    /// The ring's verdict, if the log names the kind.
    pub kind: Option<ReadingKind>,
    /// True if no other sensor's sound could be heard.
    pub solo: bool,
    /// True if firings were so punctual that crosstalk moved as the schedule says.
    pub steady: bool,
    /// Number of times that firing times had changed against each other otherwise than by the phase, modulo 256, as
    /// `HoppingRing::changes` counts.
    pub changes: u8,
    /// Expected change of the reading since the sensor's firing before, in microseconds; 0 in a log without the column.
    pub expected_change_us: i32,
}

impl Weighed {
    /// As the end of a row: see [`Columns::HEADER`].
    pub(crate) fn fields(&self) -> String {
        let Self { given, solo, steady, changes, expected_change_us, .. } = self;
        format!(",{given},{},{},{changes},{expected_change_us}", u8::from(*solo), u8::from(*steady))
    }

    /// Of a message, the firing with this number: nothing if it has none of the fields that are needed; no answer if
    /// one is missing or no such value.
    #[expect(clippy::option_option, reason = "no value, and a bad one, are two things")]
    pub(crate) fn of_message(message: &Value, number: u64) -> Option<Option<Self>> {
        let field = |name| message.get(name).filter(|value| !value.is_null());
        if ["solo", "steady", "changes"].into_iter().all(|name| field(name).is_none()) {
            return Some(None);
        }
        let flag = |name| {
            let value = field(name)?;
            value.as_bool().or_else(|| Some(value.as_u64().filter(|&flag| flag < 2)? == 1))
        };
        let or = |name, value: i64| field(name).map_or(Some(value), Value::as_i64);
        Some(Some(Self {
            given: u64::try_from(or("given", number.cast_signed())?).ok()?,
            kind: message.get("reading").and_then(Value::as_str).and_then(kind_named),
            solo: flag("solo")?,
            steady: flag("steady")?,
            changes: u8::try_from(field("changes")?.as_u64()?).ok()?,
            expected_change_us: i32::try_from(or("expected_us", 0)?).ok()?,
        }))
    }
}

pub(crate) fn kind_named(name: &str) -> Option<ReadingKind> {
    ReadingKind::ALL.into_iter().find(|kind| kind.as_str() == name)
}

/// Where the columns stand in a log.
pub(crate) struct Columns {
    given: Option<usize>,
    solo: usize,
    steady: usize,
    changes: usize,
    expected: Option<usize>,
}

impl Columns {
    /// Their names, after the others.
    pub(crate) const HEADER: &str = ",given,solo,steady,changes,expected_us";
    /// A row without them.
    pub(crate) const EMPTY: &str = ",,,,,";

    /// Nothing if the log has none of those that are needed; what is missing, if it has some of them.
    pub(crate) fn of(header: &[String]) -> Result<Option<Self>, String> {
        let column = |name: &str| header.iter().position(|column| column == name);
        let needed = ["solo", "steady", "changes"];
        match needed.map(column) {
            [Some(solo), Some(steady), Some(changes)] => {
                Ok(Some(Self { given: column("given"), solo, steady, changes, expected: column("expected_us") }))
            }
            [None, None, None] => Ok(None),
            found => {
                let missing = needed.into_iter().zip(found).find(|(_, found)| found.is_none());
                let missing = missing.map_or("", |(name, _)| name);
                Err(format!("no column `{missing}`; expected all of {}, or none", needed.join(", ")))
            }
        }
    }

    /// Of the row with this number, which the ring `made` that of; a column with a value that it cannot have, and what
    /// is expected.
    pub(crate) fn read(
        &self,
        row: &[String],
        made: &str,
        number: u64,
    ) -> Result<Option<Weighed>, (usize, &'static str)> {
        let text = |column: usize| row.get(column).map_or("", String::as_str);
        let Self { given, solo, steady, changes, expected } = *self;
        if [solo, steady, changes].into_iter().all(|column| text(column).is_empty()) {
            return Ok(None);
        }
        let flag = |column: usize| match text(column) {
            "0" => Ok(false),
            "1" => Ok(true),
            _ => Err((column, "0 or 1")),
        };
        let filled = |column: &usize| !text(*column).is_empty();
        Ok(Some(Weighed {
            given: match given.filter(filled) {
                Some(given) => text(given).parse().map_err(|_| (given, "a number from 0"))?,
                None => number,
            },
            kind: kind_named(made),
            solo: flag(solo)?,
            steady: flag(steady)?,
            changes: text(changes).parse().map_err(|_| (changes, "0 to 255"))?,
            expected_change_us: match expected.filter(filled) {
                Some(expected) => text(expected).parse().map_err(|_| (expected, "microseconds, whole"))?,
                None => 0,
            },
        }))
    }
}
