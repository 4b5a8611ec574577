//! The pace of a sketch: the longest time of one `read()`, which each states, and what it says if its loop is too slow.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::build::{self, Board, Source};
use super::{EXAMPLES, Example, TARGET, failed, world};
use crate::c::need;
use crate::steps::{Trouble, output};

/// Sketches that read by a class; the first of them say when their loop is too slow.
const SKETCHES: [&str; 8] =
    ["Two", "Ring8", "Ring12OnePin", "States4", "FromNewPing", "Adaptive", "SerialRing8", "Flow12"];
const SAY_SO: usize = 4;
const SECONDS: u32 = 3;
/// Stands in each before `X ms`.
const STATED: &str = "One read() takes up to ";
const TOO_SLOW: &str = "too slow";
/// Times each call, and says a time that is longer than all before.
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

pub(super) fn run(library: &Path) -> Result<(), Trouble> {
    need("avr-g++", "gcc-avr avr-libc binutils-avr arduino-core-avr")?;
    let world = world::build()?;
    println!("| sketch | longest read() | it states | says that it is too slow, with 3 ms of other work |");
    println!("|---|---:|---:|---:|");
    for (number, name) in SKETCHES.into_iter().enumerate() {
        let example = EXAMPLES.iter().find(|example| example.name == name);
        let example = example.ok_or_else(|| Trouble::Failed(format!("{name}: no such example")))?;
        let file = format!("examples/{name}/{name}.ino");
        let text = fs::read_to_string(library.join(&file)).map_err(failed(&file))?;
        let stated = text.split_once(STATED).and_then(|(_, after)| after.split_once(" ms"));
        let stated = stated.and_then(|(ms, _)| ms.parse::<f64>().ok());
        let stated = stated.ok_or_else(|| Trouble::Failed(format!("{file}: expected `{STATED}X ms`")))?;
        let timed = text.replace("sonar.read()", "timed()").replacen("void setup() {", TIMED, 1);
        let said = heard(library, &world, example, &format!("{name}Timed"), &timed)?;
        let longest =
            said.lines().filter_map(|line| line.trim().strip_prefix("longest ")?.parse::<f64>().ok()).next_back();
        let ms = longest.unwrap_or(0.0) / 1000.0;
        if !(0.6 * stated..=stated).contains(&ms) {
            return Err(Trouble::Failed(format!("{file}: read() takes up to {ms:.2} ms; it states {stated} ms")));
        }
        if number >= SAY_SO {
            println!("| {name} | {ms:.2} ms | {stated} ms | |");
            continue;
        }
        let slow = text.replacen("void loop() {", "void loop() {\n  delay(3);  // something else", 1);
        let [of_fast, of_slow] = [(&text, "Paced"), (&slow, "Slow")].map(|(text, more)| {
            let said = heard(library, &world, example, &format!("{name}{more}"), text)?;
            Ok(said.lines().filter(|line| line.contains(TOO_SLOW)).count())
        });
        let (of_fast, of_slow) = (of_fast?, of_slow?);
        println!("| {name} | {ms:.2} ms | {stated} ms | {of_slow} times |");
        if of_fast > 0 || of_slow == 0 || of_slow > SECONDS as usize + 1 {
            let why =
                format!("{name} said {of_fast} times that it is too slow, and {of_slow} times with 3 ms of other work");
            return Err(Trouble::Failed(why));
        }
    }
    Ok(())
}

/// The output of a sketch among modules that are each before a wall of their own.
fn heard(library: &Path, world: &Path, example: &Example, name: &str, text: &str) -> Result<String, Trouble> {
    let source = Source { name, text, board: Board::Uno, ours: true, defines: &[] };
    let sketch = build::sketch(&source, &library.join("src"), &build::core(Board::Uno)?)?;
    let walls = Path::new(TARGET).join("pace.txt");
    let ways = (0..example.modules).map(|module| format!("{module} {module} {}\n", 6_000 + 1_300 * module));
    fs::write(&walls, ways.collect::<String>()).map_err(failed("target"))?;
    let mut run = Command::new(world);
    run.arg(&sketch.elf).arg(SECONDS.to_string()).arg(&walls).arg(example.modules.to_string());
    run.args(example.triggers.iter().chain(example.echoes).map(ToString::to_string));
    output(&mut run).ok_or_else(|| Trouble::Failed(format!("{name} did not run")))
}
