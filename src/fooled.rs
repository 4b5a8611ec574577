//! Who was fooled by whom: the critical paths along which foreign sound was taken for an echo, under several methods at once.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use comfy_table::{CellAlignment, Table, presets};
use eeruf_sim::{Bounce, Cause, HeardPath, Method, Readings, SensorId};
use serde::Serialize;

/// The most rows that are printed.
const ROWS: usize = 8;
/// The methods that are compared, where they were simulated: no filter, the filter without alternation, and with it.
const COMPARED: [Method; 4] = [Method::Conventional, Method::Comparison, Method::Eeruf, Method::EerufBest];

/// What a path is called in all runs: who heard whom, along which bounces.
type Key = (SensorId, Option<SensorId>, u8, Box<[Bounce]>);

/// One path, and how often it fooled its receiver under each method.
struct Row {
    path: Option<HeardPath>,
    /// For each method: wrong readings, and those of them that were believed.
    counts: Vec<(usize, usize)>,
}

/// The paths that fooled one robot's sensors.
pub(crate) struct Fooled {
    methods: Vec<Method>,
    rows: Vec<(Key, Row)>,
    /// For each method, the wrong readings that are a sensor's own doing: its echo faded and it heard what lies behind.
    own: Vec<(usize, usize)>,
}

impl Fooled {
    /// From the readings of one robot under each method.
    pub(crate) fn of(runs: &[Readings], robot: usize, tolerance_us: f64) -> Self {
        let compared: Vec<&Readings> = runs.iter().filter(|readings| COMPARED.contains(&readings.method)).collect();
        let compared = if compared.is_empty() { runs.iter().take(COMPARED.len()).collect() } else { compared };
        let mut rows: BTreeMap<Key, Row> = BTreeMap::new();
        let mut own = vec![(0, 0); compared.len()];
        for (place, readings) in compared.iter().enumerate() {
            for entry in readings.attribution(tolerance_us) {
                if usize::from(entry.receiver.robot) != robot {
                    continue;
                }
                let counts = if is_foreign(entry.cause) {
                    let path = readings.paths.get(entry.path as usize);
                    let bounces = path.map_or_else(Box::default, |path| path.bounces.clone());
                    let key = (entry.receiver, entry.emitter, entry.cause as u8, bounces);
                    let new = || Row { path: path.cloned(), counts: vec![(0, 0); compared.len()] };
                    &mut rows.entry(key).or_insert_with(new).counts[place]
                } else {
                    &mut own[place]
                };
                counts.0 += entry.wrong;
                counts.1 += entry.accepted;
            }
        }
        let mut rows: Vec<_> = rows.into_iter().collect();
        // Stable, so that ties stay in the order of the keys.
        rows.sort_by_key(|(_, row)| {
            let most = |count: fn(&(usize, usize)) -> usize| row.counts.iter().map(count).max();
            core::cmp::Reverse((most(|counts| counts.1), most(|counts| counts.0)))
        });
        Self { methods: compared.iter().map(|readings| readings.method).collect(), rows, own }
    }

    /// The commonest as a table. Sensors from 1, walls and poles from 0 as in files.
    pub(crate) fn describe(&self) -> String {
        let mut text = String::new();
        if self.rows.is_empty() {
            _ = writeln!(text, "\nNobody was fooled by foreign sound.");
            return text;
        }
        let mut table = Table::new();
        table.load_style(presets::ASCII_MARKDOWN);
        let columns = ["sensor", "took the sound of", "order", "by way of", "m"].map(str::to_owned);
        table.set_header(columns.into_iter().chain(self.methods.iter().map(Method::to_string)));
        for ((receiver, emitter, _, bounces), row) in self.rows.iter().take(ROWS) {
            let who = match emitter {
                Some(emitter) if emitter == receiver => "itself, before".to_owned(),
                Some(emitter) if emitter.robot == receiver.robot => format!("{}", emitter.sensor + 1),
                Some(emitter) => format!("{} of robot {}", emitter.sensor + 1, emitter.robot + 1),
                None => "something outside".to_owned(),
            };
            let (order, length) = match &row.path {
                Some(path) => (path.order.to_string(), format!("{:.2}", path.length_m)),
                None => ("-".to_owned(), "-".to_owned()),
            };
            let mut cells = vec![format!("{}", receiver.sensor + 1), who, order, by_way_of(bounces), length];
            cells.extend(row.counts.iter().map(|&(wrong, believed)| match (wrong, believed) {
                (0, _) => "-".to_owned(),
                _ => format!("{believed} of {wrong}"),
            }));
            table.add_row(cells);
        }
        for (place, column) in table.column_iter_mut().enumerate() {
            if place != 3 {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        _ = writeln!(
            text,
            "\nWho was fooled by whom, believed of wrong readings (the {ROWS} commonest of {} paths):",
            self.rows.len()
        );
        _ = writeln!(text, "{table}");
        let own = self.methods.iter().zip(&self.own).filter(|(_, (_, believed))| *believed > 0);
        let own: Vec<_> = own.map(|(method, (_, believed))| format!("{believed} under {method}")).collect();
        if !own.is_empty() {
            _ = writeln!(
                text,
                "Believed and wrong without foreign sound (a faint echo faded, or none came): {}.",
                own.join(", ")
            );
        }
        text
    }
}

fn is_foreign(cause: Cause) -> bool {
    matches!(cause, Cause::Stale | Cause::Crosstalk | Cause::External)
}

/// The bounces of a path, emitter to receiver; walls and poles from 0, as in files.
pub(crate) fn by_way_of(bounces: &[Bounce]) -> String {
    if bounces.is_empty() {
        return "straight".to_owned();
    }
    let mut text = String::new();
    let mut walls = false;
    for (place, bounce) in bounces.iter().enumerate() {
        text += if place == 0 { "" } else { ", " };
        match bounce {
            Bounce::Wall(wall) if walls => _ = write!(text, "{wall}"),
            Bounce::Wall(wall) => _ = write!(text, "wall {wall}"),
            Bounce::Pole(pole) => _ = write!(text, "pole {pole}"),
        }
        walls = matches!(bounce, Bounce::Wall(_));
    }
    text
}

/// The bounces of a path as numbers: walls from 0; pole p as -1 - p.
pub(crate) fn wall_numbers(bounces: &[Bounce]) -> Vec<i64> {
    let number = |bounce: &Bounce| match *bounce {
        Bounce::Wall(wall) => i64::from(wall),
        Bounce::Pole(pole) => -1 - i64::from(pole),
    };
    bounces.iter().map(number).collect()
}

/// One way in which readings were wrong under a method, for `--json`.
#[derive(Serialize)]
pub(crate) struct FooledJson {
    receiver: SensorId,
    emitter: Option<SensorId>,
    cause: Cause,
    order: Option<u32>,
    length_m: Option<f64>,
    walls: Vec<i64>,
    wrong: usize,
    accepted: usize,
}

/// All of a method's wrong readings by who, by whom and along which path, the ones believed most often first.
pub(crate) fn to_json(readings: &Readings, tolerance_us: f64) -> Vec<FooledJson> {
    let entries = readings.attribution(tolerance_us).into_iter().map(|entry| {
        let path = readings.paths.get(entry.path as usize);
        FooledJson {
            receiver: entry.receiver,
            emitter: entry.emitter,
            cause: entry.cause,
            order: entry.order,
            length_m: path.map(|path| path.length_m),
            walls: path.map_or_else(Vec::new, |path| wall_numbers(&path.bounces)),
            wrong: entry.wrong,
            accepted: entry.accepted,
        }
    });
    entries.collect()
}
