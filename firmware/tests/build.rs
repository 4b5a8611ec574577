//! Converts the shared cases of `tests/data` to Rust, for programs that cannot read files.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::{env, fs};

use serde_json::Value;

fn main() {
    let data = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it")).join("../../tests/data");
    let mut rust = String::new();
    shortest_periods(&mut rust, &read(&data.join("shortest-periods.json")));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it")).join("cases.rs");
    fs::write(out, rust).expect("OUT_DIR can be written");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={}", data.display());
}

fn read(path: &PathBuf) -> Value {
    let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn layout(case: &Value) -> String {
    let neighbours = &case["neighbours"];
    match case["layout"].as_str() {
        Some("line") => format!("Layout::Line({neighbours})"),
        Some("ring") => format!("Layout::Ring({neighbours})"),
        Some("blocks") => format!("Layout::Blocks({neighbours})"),
        other => panic!("layout {other:?}; expected line, ring or blocks"),
    }
}

fn fields(case: &Value, names: &[&str]) -> String {
    names.iter().map(|name| format!("{name}: {}, ", case[name])).collect()
}

fn shortest_periods(rust: &mut String, file: &Value) {
    rust.push_str("static SHORTEST_PERIODS: &[ShortestPeriod] = &[\n");
    for case in file["cases"].as_array().expect("a list of cases") {
        let names = ["tick_us", "min_interval", "separation", "window", "stale_echo", "period"];
        let fields = fields(case, &names);
        let (layout, a, b) = (layout(case), &case["fire_a"], &case["fire_b"]);
        writeln!(rust, "    ShortestPeriod {{ {fields}layout: {layout}, fire_a: &{a}, fire_b: &{b} }},")
            .expect("a string");
    }
    rust.push_str("];\n");
}
