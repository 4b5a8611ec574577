//! Types for reading `tests/data/wait-tables.json`.

use serde::Deserialize;
use std::collections::BTreeMap;

use super::naive::Layout;

#[derive(Debug, Deserialize)]
pub struct File {
    pub cases: Vec<Case>,
    pub rearrangements_of_table_i: Rearrangements,
}

#[derive(Debug, Clone, Deserialize)]
pub struct Case {
    pub sensors: usize,
    pub period: u32,
    pub wait_max: u32,
    pub group: usize,
    pub separation: u32,
    pub min_interval: u32,
    pub neighbours: usize,
    pub criterion: String,
    pub layout: Layout,
    pub count: u128,
    pub best_interval: i64,
}

#[derive(Debug, Deserialize)]
pub struct Rearrangements {
    pub line: BTreeMap<u32, u128>,
    pub ring: BTreeMap<u32, u128>,
    pub blocks: BTreeMap<u32, u128>,
    pub the_one_with_19_on_a_line: One,
}

#[derive(Debug, Deserialize)]
pub struct One {
    pub t_wait_b_ms: Vec<u32>,
}

impl File {
    pub fn read() -> Self {
        serde_json::from_str(include_str!("../../../../../tests/data/wait-tables.json")).unwrap()
    }
}
