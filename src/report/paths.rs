//! Critical paths, as a table and as JSON.

use comfy_table::{CellAlignment, Table};
use serde::Serialize;

use super::table::markdown;

/// Arrays of equal length, sorted by emitter, receiver and length, named as in Python; sensors and walls from 0.
#[derive(Default, Serialize)]
pub(crate) struct PathsJson {
    pub(crate) emitter: Vec<u32>,
    pub(crate) receiver: Vec<u32>,
    pub(crate) length_m: Vec<f64>,
    pub(crate) order: Vec<u32>,
    pub(crate) departure_rad: Vec<f64>,
    pub(crate) arrival_rad: Vec<f64>,
    /// Amplitude relative to 1 m on axis, including both sensors' patterns.
    pub(crate) amplitude: Vec<f64>,
    /// Level above the threshold of hearing.
    pub(crate) level_db: Vec<f64>,
    /// Numbers of walls; pole p is -1 - p.
    pub(crate) walls: Vec<Vec<i64>>,
    #[serde(skip)]
    pub(crate) by_way_of: Vec<String>,
}

impl PathsJson {
    pub(crate) fn table(&self) -> Table {
        let header = ["emitter", "receiver", "order", "length m", "level dB", "by way of"];
        let row = |k: usize| {
            vec![
                (self.emitter[k] + 1).to_string(),
                (self.receiver[k] + 1).to_string(),
                self.order[k].to_string(),
                format!("{:.3}", self.length_m[k]),
                format!("{:.1}", self.level_db[k]),
                self.by_way_of[k].clone(),
            ]
        };
        let mut table = markdown(&header, (0..self.order.len()).map(row));
        for (index, column) in table.column_iter_mut().enumerate() {
            let is_text = index == header.len() - 1;
            column.set_cell_alignment(if is_text { CellAlignment::Left } else { CellAlignment::Right });
        }
        table
    }
}
