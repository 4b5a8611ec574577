//! `[firing]` of a world file: how its robots are fired today.

use eeruf_core::Micros;
use eeruf_files::{FileError, explain};
use serde::Deserialize;
use toml::{Spanned, Table, Value};

use super::schedule_file::ScheduleFile;
use super::source::Source;
use super::write::set;
use crate::world::sketch::{FiringTable, Sketch};

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SketchFile {
    timeout_us: Option<u32>,
    pause_us: Option<u32>,
    turn_us: Option<u32>,
    rest_us: Option<u32>,
    #[serde(default)]
    arrays: Vec<Vec<u8>>,
    #[serde(default)]
    groups: Vec<Vec<u8>>,
    consecutive: Option<u8>,
    drift_ppm: Option<f64>,
    schedule: Option<Spanned<Value>>,
}

/// A table of many phases, by its firing times.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PhasesFile {
    period_us: u32,
    t_fire_us: Vec<Vec<u32>>,
}

/// A table `[firing]`.
pub(super) fn sketch(source: &Source, file: &SketchFile) -> Result<Sketch, FileError> {
    let default = Sketch::default();
    let us = |time: Option<u32>| Micros::new(time.unwrap_or(0));
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
        timeout: file.timeout_us.map(Micros::new),
        pause: us(file.pause_us),
        turn: us(file.turn_us),
        rest: file.rest_us.map(Micros::new),
        arrays: file.arrays.clone(),
        groups: file.groups.clone(),
        consecutive: file.consecutive.unwrap_or(default.consecutive),
        drift_ppm: file.drift_ppm.unwrap_or(default.drift_ppm),
        table: table.transpose()?,
    })
}

/// The firing times of a schedule of two phases, or of many.
fn table_of(table: Table) -> Result<FiringTable, String> {
    if table.contains_key("step_us") {
        return Err(
            "step_us: a code of time hopping, which is gone; expected t_fire_us, one list for each phase".into()
        );
    }
    if table.contains_key("t_fire_us") {
        let PhasesFile { period_us, t_fire_us } = PhasesFile::deserialize(table).map_err(|error| explain(&error))?;
        let row = |row: Vec<u32>| row.into_iter().map(Micros::new).collect();
        return Ok(FiringTable { period: Micros::new(period_us), rows: t_fire_us.into_iter().map(row).collect() });
    }
    let file = ScheduleFile::deserialize(table).map_err(|error| explain(&error))?;
    let schedule = file.schedule()?;
    let row = |phase| (0..schedule.sensors()).map(|x| schedule.t_fire(phase, x).unwrap_or_default()).collect();
    Ok(FiringTable { period: schedule.period(), rows: [eeruf_core::Phase::A, eeruf_core::Phase::B].map(row).into() })
}

impl Sketch {
    /// Reads the table `[firing]` of a scene file. A schedule that it names is looked for in the present folder.
    ///
    /// # Errors
    /// A message that names the key, its value and what is expected.
    ///
    /// ```
    /// use eeruf_sim::Sketch;
    /// let sketch = Sketch::from_table(&"turn_us = 33_000\narrays = [[0, 1], [2, 3]]".parse()?)?;
    /// assert_eq!(Sketch::from_table(&sketch.to_table())?, sketch);
    /// assert!(Sketch::from_table(&"turns_us = 1".parse()?).unwrap_err().contains("expected one of `timeout_us`"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_table(table: &Table) -> Result<Self, String> {
        let source = Source { file: "firing".into(), text: table.to_string() };
        let file: SketchFile = source.toml().map_err(|error| error.message().to_owned())?;
        sketch(&source, &file).map_err(|error| error.message().to_owned())
    }

    /// The table `[firing]` in a scene file that says this: what differs from the default.
    pub fn to_table(&self) -> Table {
        let (mut table, default) = (Table::new(), Self::default());
        let us = |time: Micros| i64::from(time.as_micros());
        let lists = |lists: &[Vec<u8>]| {
            lists.iter().map(|list| list.iter().map(|&x| i64::from(x)).collect::<Vec<_>>()).collect::<Vec<_>>()
        };
        for (key, time) in [("timeout_us", self.timeout), ("rest_us", self.rest)] {
            if let Some(time) = time {
                set(&mut table, key, us(time));
            }
        }
        for (key, time) in [("pause_us", self.pause), ("turn_us", self.turn)] {
            if time != Micros::ZERO {
                set(&mut table, key, us(time));
            }
        }
        for (key, sets) in [("arrays", &self.arrays), ("groups", &self.groups)] {
            if !sets.is_empty() {
                set(&mut table, key, lists(sets));
            }
        }
        if self.consecutive != default.consecutive {
            set(&mut table, "consecutive", i64::from(self.consecutive));
        }
        if self.drift_ppm != default.drift_ppm {
            set(&mut table, "drift_ppm", self.drift_ppm);
        }
        if let Some(FiringTable { period, rows }) = &self.table {
            let mut schedule = Table::new();
            set(&mut schedule, "period_us", us(*period));
            let rows = rows.iter().map(|row| row.iter().map(|&time| us(time)).collect::<Vec<_>>());
            set(&mut schedule, "t_fire_us", rows.collect::<Vec<_>>());
            set(&mut table, "schedule", schedule);
        }
        table
    }
}
