//! The pace of a sketch: the longest time of one `read()`, which each sketch states.

use std::path::Path;

use anyhow::{Context as _, Result, ensure};
use fs_err as fs;

use super::build::{self, Board};
use super::world::Room;
use super::{EXAMPLES, TARGET};
use crate::steps::edited;

/// The sketch that has no `read()` of its own.
const WITHOUT: &str = "SerialRing8";
const SECONDS: u32 = 3;
/// Words in each sketch before `X ms`.
const STATED: &str = "One read() takes up to ";
/// A function that times each call, and prints a time longer than all before.
const TIMED: &str = "bool timed() {
  const uint32_t began = micros();
  const bool is_reading = sonar.read();
  const uint32_t took = micros() - began;
  static uint32_t longest;
  if (took > longest) {
    longest = took;
    Serial.print(F(\"longest \"));
    Serial.println(took);
  }
  return is_reading;
}

void setup() {";

pub(super) fn run(library: &Path) -> Result<()> {
    println!("| sketch | longest read() | it states |\n|---|---:|---:|");
    for example in EXAMPLES.iter().filter(|example| example.name != WITHOUT) {
        let name = example.name;
        let file = format!("examples/{name}/{name}.ino");
        let text = fs::read_to_string(library.join(&file))?;
        let stated = text.split_once(STATED).and_then(|(_, after)| after.split_once(" ms"));
        let stated = stated.and_then(|(ms, _)| ms.parse::<f64>().ok());
        let stated = stated.with_context(|| format!("{file}: expected `{STATED}X ms`"))?;
        let timed = edited(&text, &[("sonar.read()", "timed()"), ("void setup() {", TIMED)])?;
        let elf = build::ours(library, Board::Uno, &format!("{name}Timed"), &timed, &[])?.elf;
        let walls = (0..example.modules() as u32).map(|module| Some(6_000 + 1_300 * module));
        let room = Room::walls(format!("{TARGET}/walls-of-paces.txt"), walls)?;
        let said = room.text(&elf, SECONDS, &example.pins(), &[])?;
        let longest =
            said.lines().filter_map(|line| line.trim().strip_prefix("longest ")?.parse::<f64>().ok()).next_back();
        let ms = longest.unwrap_or(0.0) / 1000.0;
        let is_so = (0.6 * stated..=stated).contains(&ms);
        ensure!(is_so, "{file}: read() takes up to {ms:.2} ms; it states {stated} ms");
        println!("| {name} | {ms:.2} ms | {stated} ms |");
    }
    Ok(())
}
