//! The faults of a world file: `[[fault]]`, with a kind and what that needs.

use eeruf_files::FileError;
use serde::Deserialize;
use toml::{Spanned, Table, Value};

use super::schedule_file::{ScheduleFile, schedule};
use super::source::Source;
use crate::world::fault::{Fault, FaultKind};

#[derive(Clone, Deserialize)]
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

impl FaultFile {
    /// The keys that a kind needs beside `kind`, `robot`, `sensors`, `from_s` and `to_s`.
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

    /// The keys that are given, of those that only some kinds need.
    fn given(&self) -> impl Iterator<Item = &'static str> {
        let given = [
            ("share", self.share.is_some()),
            ("per_s", self.per_s.is_some()),
            ("us", self.us.is_some()),
            ("ppm", self.ppm.is_some()),
            ("every", self.every.is_some()),
            ("after_us", self.after_us.is_some()),
            ("width_us", self.width_us.is_some()),
            ("schedule", self.schedule.is_some()),
            ("radius_m", self.radius_m.is_some()),
            ("from_m", self.from_m.is_some()),
            ("to_m", self.to_m.is_some()),
            ("hinge_m", self.hinge_m.is_some()),
            ("length_m", self.length_m.is_some()),
            ("from_deg", self.from_deg.is_some()),
            ("to_deg", self.to_deg.is_some()),
        ];
        given.into_iter().filter(|(_, given)| *given).map(|(key, _)| key)
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
    if let Some(key) = file.given().find(|key| !needs.contains(key)) {
        return Err(fail(key, format!("{key} with kind {:?}; expected no such key", file.kind)));
    }
    let given: Vec<_> = file.given().collect();
    if let Some(key) = needs.iter().find(|key| !given.contains(key)) {
        return Err(fail("kind", format!("no {key}; expected one with kind {:?}", file.kind)));
    }
    // All that the kind needs is there.
    let share = file.share.unwrap_or_default();
    let every = file.every.unwrap_or_default();
    let (after_us, width_us) = (file.after_us.unwrap_or_default(), file.width_us.unwrap_or_default());
    let kind = match &*file.kind {
        "lost" => FaultKind::Lost { share },
        "noise" => FaultKind::Noise { per_s: file.per_s.unwrap_or_default() },
        "uniform_noise" => FaultKind::UniformNoise { share },
        "echo_wires" => FaultKind::EchoWires,
        "trigger_wires" => FaultKind::TriggerWires,
        "late_trigger" => FaultKind::LateTrigger { us: file.us.unwrap_or_default() },
        "clock_drift" => FaultKind::ClockDrift { ppm: file.ppm.unwrap_or_default() },
        "missing" => FaultKind::Missing,
        "stuck" => FaultKind::Stuck,
        "cut" => FaultKind::Cut,
        "lost_rises" => FaultKind::LostRises { every },
        "lost_falls" => FaultKind::LostFalls { every },
        "glitch_low" => FaultKind::GlitchLow { after_us, width_us },
        "glitch_high" => FaultKind::GlitchHigh { after_us, width_us },
        "leg" => FaultKind::Leg {
            radius_m: file.radius_m.unwrap_or_default(),
            from_m: file.from_m.unwrap_or_default(),
            to_m: file.to_m.unwrap_or_default(),
        },
        "door" => FaultKind::Door {
            hinge_m: file.hinge_m.unwrap_or_default(),
            length_m: file.length_m.unwrap_or_default(),
            from_deg: file.from_deg.unwrap_or_default(),
            to_deg: file.to_deg.unwrap_or_default(),
        },
        // The one that is left.
        _ => match &file.schedule {
            Some(value) => FaultKind::OtherTable { schedule: Box::new(schedule(source, value)?) },
            None => return Err(fail("kind", "no schedule; expected one".to_owned())),
        },
    };
    let (robot, sensors) = (file.robot, file.sensors.clone());
    Ok(Fault { kind, robot, sensors, from_s: file.from_s, to_s: file.to_s.unwrap_or(f64::INFINITY) })
}

/// The table of a fault.
pub(super) fn fault_table(fault: &Fault) -> Table {
    let mut table = Table::new();
    let mut set = |key: &str, value: Value| {
        table.insert(key.to_owned(), value);
    };
    set("kind", fault.kind.name().into());
    let whole = |number: u32| Value::from(i64::from(number));
    match &fault.kind {
        FaultKind::Lost { share } | FaultKind::UniformNoise { share } => set("share", (*share).into()),
        FaultKind::Noise { per_s } => set("per_s", (*per_s).into()),
        FaultKind::LateTrigger { us } => set("us", whole(*us)),
        FaultKind::ClockDrift { ppm } => set("ppm", (*ppm).into()),
        FaultKind::LostRises { every } | FaultKind::LostFalls { every } => set("every", whole(*every)),
        FaultKind::GlitchLow { after_us, width_us } | FaultKind::GlitchHigh { after_us, width_us } => {
            set("after_us", whole(*after_us));
            set("width_us", whole(*width_us));
        }
        FaultKind::OtherTable { schedule } => {
            if let Ok(schedule) = Table::try_from(ScheduleFile::from(&**schedule)) {
                set("schedule", schedule.into());
            }
        }
        FaultKind::Leg { radius_m, from_m, to_m } => {
            set("radius_m", (*radius_m).into());
            set("from_m", from_m.to_vec().into());
            set("to_m", to_m.to_vec().into());
        }
        FaultKind::Door { hinge_m, length_m, from_deg, to_deg } => {
            set("hinge_m", hinge_m.to_vec().into());
            set("length_m", (*length_m).into());
            set("from_deg", (*from_deg).into());
            set("to_deg", (*to_deg).into());
        }
        FaultKind::EchoWires | FaultKind::TriggerWires | FaultKind::Missing | FaultKind::Stuck | FaultKind::Cut => {}
    }
    if !fault.kind.is_of_scene() {
        set("robot", Value::from(fault.robot as i64));
        if !fault.sensors.is_empty() {
            set("sensors", fault.sensors.iter().map(|&sensor| i64::from(sensor)).collect::<Vec<_>>().into());
        }
    }
    set("from_s", fault.from_s.into());
    if fault.to_s.is_finite() {
        set("to_s", fault.to_s.into());
    }
    table
}

impl Fault {
    /// The faults that these tables say, with the keys of `[[fault]]` in a scene file.
    ///
    /// # Errors
    /// The error of the first invalid one.
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

    /// The table of `[[fault]]` in a scene file that says this.
    pub fn to_table(&self) -> Table {
        fault_table(self)
    }
}
