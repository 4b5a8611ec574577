//! `[firing]` of a world file: today's ways of firing its robots.

use eeruf_core::{Micros, Phase};
use eeruf_files::{FileError, ScheduleFile, explain};
use serde::{Deserialize, Serialize};
use toml::{Spanned, Table, Value};

use super::source::Source;
use crate::world::sketch::{FiringTable, Sketch};

#[derive(Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SketchFile {
    timeout_us: Option<Micros>,
    pause_us: Option<Micros>,
    turn_us: Option<Micros>,
    rest_us: Option<Micros>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    arrays: Vec<Vec<u8>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    groups: Vec<Vec<u8>>,
    consecutive: Option<u8>,
    drift_ppm: Option<f64>,
    schedule: Option<Spanned<Value>>,
}

/// Reads a table `[firing]`.
pub(super) fn sketch(source: &Source, file: &SketchFile) -> Result<Sketch, FileError> {
    let default = Sketch::default();
    let table = file.schedule.as_ref().map(|value| {
        let (Source { file, .. }, text) = match value.get_ref() {
            Value::String(name) => {
                let beside = source.beside(name)?;
                let table = beside.toml()?;
                (beside, table)
            }
            value => (source.clone(), value.as_table().cloned().unwrap_or_default()),
        };
        let line = (file == source.file).then(|| source.line(value.span(), ""));
        let error = |message| FileError::new(&file, format!("schedule: {message}")).at_line(line);
        table_of(text).map_err(error)
    });
    Ok(Sketch {
        timeout: file.timeout_us,
        pause: file.pause_us.unwrap_or_default(),
        turn: file.turn_us.unwrap_or_default(),
        rest: file.rest_us,
        arrays: file.arrays.clone(),
        groups: file.groups.clone(),
        consecutive: file.consecutive.unwrap_or(default.consecutive),
        drift_ppm: file.drift_ppm.unwrap_or(default.drift_ppm),
        table: table.transpose()?,
    })
}

/// Returns the firing times of a schedule of two phases, or of many.
fn table_of(table: Table) -> Result<FiringTable, String> {
    if table.contains_key("step_us") {
        return Err(
            "step_us: a code of time hopping, which is gone; expected t_fire_us, one list for each phase".into()
        );
    }
    if table.contains_key("t_fire_us") {
        return FiringTable::deserialize(table).map_err(|error| explain(&error));
    }
    let file = ScheduleFile::deserialize(table).map_err(|error| explain(&error))?;
    let schedule = file.schedule()?;
    let row = |phase| (0..schedule.sensors()).map(|x| schedule.t_fire(phase, x).unwrap_or_default()).collect();
    Ok(FiringTable { period: schedule.period(), rows: [Phase::A, Phase::B].map(row).into() })
}

impl Sketch {
    /// Reads the table `[firing]` of a scene file. A schedule that it names is searched for in the current folder.
    ///
    /// # Errors
    /// A message that names the key, its value and the expected value.
    ///
    /// ```
    /// use eeruf_sim::Sketch;
    /// let sketch = Sketch::from_table(&"turn_us = 33_000\narrays = [[0, 1], [2, 3]]".parse()?)?;
    /// assert_eq!(Sketch::from_table(&sketch.to_table())?, sketch);
    /// assert!(Sketch::from_table(&"turns_us = 1".parse()?).unwrap_err().contains("did you mean `turn_us`?"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_table(table: &Table) -> Result<Self, String> {
        let source = Source { file: "firing".into(), text: table.to_string() };
        let file: SketchFile = source.toml().map_err(|error| error.message().to_owned())?;
        sketch(&source, &file).map_err(|error| error.message().to_owned())
    }

    /// Returns the table `[firing]` of a scene file for these settings: the differences from the default.
    pub fn to_table(&self) -> Table {
        // The settings are numbers, lists and tables, which TOML supports.
        Table::try_from(SketchFile::from(self)).unwrap_or_default()
    }
}

impl From<&Sketch> for SketchFile {
    /// Keeps the differences from the default.
    fn from(sketch: &Sketch) -> Self {
        let default = Sketch::default();
        let above_zero = |time: Micros| (time != Micros::ZERO).then_some(time);
        let table = sketch.table.as_ref().and_then(|table| Value::try_from(table).ok());
        Self {
            timeout_us: sketch.timeout,
            pause_us: above_zero(sketch.pause),
            turn_us: above_zero(sketch.turn),
            rest_us: sketch.rest,
            arrays: sketch.arrays.clone(),
            groups: sketch.groups.clone(),
            consecutive: (sketch.consecutive != default.consecutive).then_some(sketch.consecutive),
            drift_ppm: (sketch.drift_ppm != default.drift_ppm).then_some(sketch.drift_ppm),
            schedule: table.map(|table| Spanned::new(0..0, table)),
        }
    }
}
