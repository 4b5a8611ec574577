//! Attribution by path: the critical paths along which foreign sound was taken for an echo, under several methods.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use comfy_table::{CellAlignment, Table, presets};
use eeruf_sim::Bounce;
use eeruf_sim::{Cause, HeardPath, Method, Readings, SensorId};

use crate::report::bounces::by_way_of;

/// The largest number of printed rows.
const ROWS: usize = 8;
/// The methods compared if there are more of them than columns: without filter, with filter, and with alternation too.
const COMPARED: [Method; 4] = [Method::Conventional, Method::Comparison, Method::Eeruf, Method::EerufBest];

/// Key of a path in all runs: receiver, sender and bounces.
type Key = (SensorId, Option<SensorId>, u8, Box<[Bounce]>);

/// One path, and how often it fooled its receiver under each method.
struct FooledRow {
    path: Option<HeardPath>,
    /// For each method: number of wrong readings, and of those believed.
    counts: Vec<(usize, usize)>,
}

/// The paths that fooled one robot's sensors.
pub(crate) struct Fooled {
    methods: Vec<Method>,
    rows: Vec<(Key, FooledRow)>,
    /// For each method, wrong readings by a sensor's own sound: its echo faded and it heard what lies behind.
    own: Vec<(usize, usize)>,
}

impl Fooled {
    /// Counts the readings of one robot under each method.
    pub(crate) fn of(runs: &[Readings], robot: usize, tolerance_us: f64) -> Self {
        let mut compared: Vec<&Readings> = runs.iter().collect();
        if compared.len() > COMPARED.len() {
            compared.retain(|readings| COMPARED.contains(&readings.method));
        }
        if compared.is_empty() {
            compared = runs.iter().take(COMPARED.len()).collect();
        }
        let mut rows: BTreeMap<Key, FooledRow> = BTreeMap::new();
        let mut own = vec![(0, 0); compared.len()];
        for (column, readings) in compared.iter().enumerate() {
            for entry in readings.attribution(tolerance_us) {
                if usize::from(entry.receiver.robot) != robot {
                    continue;
                }
                let counts = if is_foreign(entry.cause) {
                    let path = readings.paths.get(entry.path as usize);
                    let bounces = path.map_or_else(Box::default, |path| path.bounces.clone());
                    let key = (entry.receiver, entry.emitter, entry.cause as u8, bounces);
                    let new = || FooledRow { path: path.cloned(), counts: vec![(0, 0); compared.len()] };
                    &mut rows.entry(key).or_insert_with(new).counts[column]
                } else {
                    &mut own[column]
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

    /// Writes the commonest paths as a table. Sensors from 1, walls and poles from 0 as in files.
    pub(crate) fn describe(&self) -> String {
        let mut text = String::new();
        if self.rows.is_empty() {
            let methods: Vec<_> = self.methods.iter().map(Method::to_string).collect();
            _ = writeln!(text, "\nNobody was fooled by foreign sound under {}.", methods.join(", "));
            return text;
        }
        let mut table = Table::new();
        table.load_style(presets::ASCII_MARKDOWN);
        let columns = ["sensor", "heard", "order", "by way of", "m"].map(str::to_owned);
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
        for (index, column) in table.column_iter_mut().enumerate() {
            // "by way of" is text.
            if index != 3 {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        let paths = self.rows.len();
        let shown = if paths > ROWS { format!(" (the {ROWS} commonest of {paths} paths)") } else { String::new() };
        _ = writeln!(text, "\nWho was fooled by whom, believed of wrong readings{shown}:");
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
