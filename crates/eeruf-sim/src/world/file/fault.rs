//! The faults of a world file: `[[fault]]`, with a kind and its keys.

use eeruf_files::{FileError, ScheduleFile, explain};
use serde::{Deserialize, Serialize};
use toml::{Spanned, Table, Value};

use super::source::Source;
use crate::world::fault::{Fault, FaultKind};

/// Keys of a fault of any kind; see [`FaultKind`] for the keys of each kind.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FaultFile {
    kind: String,
    #[serde(default)]
    robot: usize,
    #[serde(default)]
    sensors: Vec<u8>,
    #[serde(default)]
    from_s: f64,
    to_s: Option<f64>,
    share: Option<f64>,
    per_s: Option<f64>,
    us: Option<u32>,
    ppm: Option<f64>,
    every: Option<u32>,
    after_us: Option<u32>,
    width_us: Option<u32>,
    schedule: Option<Spanned<Value>>,
    radius_m: Option<f64>,
    from_m: Option<[f64; 2]>,
    to_m: Option<[f64; 2]>,
    hinge_m: Option<[f64; 2]>,
    length_m: Option<f64>,
    from_deg: Option<f64>,
    to_deg: Option<f64>,
}

/// The keys that only some kinds have.
const KEYS: [&str; 15] = [
    "share", "per_s", "us", "ppm", "every", "after_us", "width_us", "schedule", "radius_m", "from_m", "to_m",
    "hinge_m", "length_m", "from_deg", "to_deg",
];

impl FaultFile {
    /// Returns the keys that a kind needs besides `kind`, `robot`, `sensors`, `from_s` and `to_s`.
    fn needs(kind: &str) -> Option<&'static [&'static str]> {
        Some(match kind {
            "lost" | "uniform_noise" => &["share"],
            "noise" => &["per_s"],
            "late_trigger" => &["us"],
            "other_table" => &["schedule"],
            "clock_drift" => &["ppm"],
            "lost_rises" | "lost_falls" => &["every"],
            "glitch_low" | "glitch_high" => &["after_us", "width_us"],
            "leg" => &["radius_m", "from_m", "to_m"],
            "door" => &["hinge_m", "length_m", "from_deg", "to_deg"],
            "echo_wires" | "trigger_wires" | "missing" | "stuck" | "cut" => &[],
            _ => return None,
        })
    }
}

/// Builds the fault with this index.
pub(super) fn fault(source: &Source, index: usize, entry: &Spanned<FaultFile>) -> Result<Fault, FileError> {
    let file = entry.get_ref();
    let fail =
        |field, message: String| source.error(Some(entry.span()), field, format!("fault {}: {message}", index + 1));
    let Some(needs) = FaultFile::needs(&file.kind) else {
        let names = FaultKind::NAMES.join(", ");
        return Err(fail("kind", format!("kind is {:?}; expected {names}", file.kind)));
    };
    let mut table = Table::try_from(file).map_err(|error| fail("kind", error.to_string()))?;
    if let Some(key) = KEYS.into_iter().find(|key| table.contains_key(*key) && !needs.contains(key)) {
        return Err(fail(key, format!("{key} with kind {:?}; expected no such key", file.kind)));
    }
    if let Some(key) = needs.iter().find(|key| !table.contains_key(**key)) {
        return Err(fail("kind", format!("no {key}; expected one with kind {:?}", file.kind)));
    }
    if let Some(value) = &file.schedule {
        let schedule = Table::try_from(ScheduleFile::from(&source.schedule(value)?));
        set(&mut table, "schedule", schedule.map_err(|error| fail("schedule", error.to_string()))?);
    }
    let kind = FaultKind::deserialize(table).map_err(|error| fail("kind", explain(&error)))?;
    let (robot, sensors) = (file.robot, file.sensors.clone());
    Ok(Fault { kind, robot, sensors, from_s: file.from_s, to_s: file.to_s.unwrap_or(f64::INFINITY) })
}

fn set(table: &mut Table, key: &str, value: impl Into<Value>) {
    table.insert(key.to_owned(), value.into());
}

impl Fault {
    /// Reads faults from tables with the keys of `[[fault]]` in a scene file.
    ///
    /// # Errors
    /// The error of the first invalid table.
    ///
    /// ```
    /// use eeruf_sim::Fault;
    /// let table: toml::Table = "kind = \"cut\"\nsensors = [2]".parse()?;
    /// let faults = Fault::list_from(vec![table])?;
    /// assert_eq!(Fault::list_from(vec![faults[0].to_table()])?, faults);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn list_from(tables: Vec<Table>) -> Result<Vec<Self>, String> {
        #[derive(Deserialize)]
        struct Faults {
            fault: Vec<Spanned<FaultFile>>,
        }
        let mut file = Table::new();
        file.insert("fault".to_owned(), Value::Array(tables.into_iter().map(Value::Table).collect()));
        let source = Source { file: "faults".into(), text: file.to_string() };
        let faults: Faults = source.toml().map_err(|error| error.message().to_owned())?;
        let each = faults.fault.iter().enumerate().map(|(index, entry)| fault(&source, index, entry));
        each.collect::<Result<_, _>>().map_err(|error| error.message().to_owned())
    }

    /// Returns this fault as a table `[[fault]]` of a scene file.
    pub fn to_table(&self) -> Table {
        // Each kind consists of numbers and a schedule, which TOML supports.
        let mut table = Table::try_from(&self.kind).unwrap_or_default();
        if !self.kind.is_of_scene() {
            set(&mut table, "robot", self.robot as i64);
            if !self.sensors.is_empty() {
                let sensors: Vec<_> = self.sensors.iter().map(|&sensor| i64::from(sensor)).collect();
                set(&mut table, "sensors", sensors);
            }
        }
        set(&mut table, "from_s", self.from_s);
        if self.to_s.is_finite() {
            set(&mut table, "to_s", self.to_s);
        }
        table
    }
}
