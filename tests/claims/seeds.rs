//! Six boards with one program of `eeruf design --program`: each draws its own seed, by its chip's number or noise.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{Scratch, eeruf};

/// A stand-in for the library's ring, which prints the seed that it is given.
const RING: &str = r"
#pragma once
#include <cstdio>
#include <eeruf.h>
template <int N> struct EerufFlow {
    EerufFlow(const uint8_t (&)[N], const uint8_t (&)[N]) {}
    bool begin(const EerufFlowConfig &ring, const EerufHcSr04Settings &) {
        return printf(`%lu `, (unsigned long)ring.seed);
    }
    bool read() { return false; }
    bool accepted() { return false; }
    bool clear() { return false; }
    bool tooSlow() { return false; }
    int status() { return 0; }
    int sensor() { return 0; }
    int millimetres() { return 0; }
};
#define F(text) text
struct {
    void begin(long) {}
    int availableForWrite() { return 0; }
    template <class What> void print(What) {}
    template <class What> void println(What) {}
} Serial;
";

/// A main function of C that prints, for each of six seeds, the instants at which modules fire.
const FIRINGS: &str = r"
#include <stdio.h>
#include `sonar.h`
static uint32_t clock_us;
static unsigned long sum;
uint32_t board_micros(void) { return clock_us; }
bool board_line_is_high(uint8_t sensor) { return sensor > EERUF_SENSORS; }
void board_trigger(uint8_t sensor, uint16_t us) { sum = sum * 31 + clock_us + sensor + us; }
int main(void) {
    for (uint32_t chip = 0xe6610001; chip <= 0xe6610006; chip++) {
        uint8_t sensor;
        EerufReading reading;
        if (sonar_begin(chip) != EERUF_OK) return 1;
        const uint32_t began = clock_us;
        for (sum = 0; clock_us - began < 500000; clock_us += 100) (void)sonar_read(&sensor, &reading);
        printf(`%lu\n`, sum);
        clock_us = began;
    }
}
";

/// A main function of Rust that prints when rings of six seeds fire next.
const DEADLINES: &str = r"
use std::convert::Infallible;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use robot::eeruf_core::Instant;
struct Pin;
impl ErrorType for Pin { type Error = Infallible; }
impl OutputPin for Pin {
    fn set_high(&mut self) -> Result<(), Infallible> { Ok(()) }
    fn set_low(&mut self) -> Result<(), Infallible> { Ok(()) }
}
impl InputPin for Pin {
    fn is_high(&mut self) -> Result<bool, Infallible> { Ok(false) }
    fn is_low(&mut self) -> Result<bool, Infallible> { Ok(true) }
}
impl DelayNs for Pin {
    fn delay_ns(&mut self, _: u32) {}
}
fn main() {
    for chip in 0xe661_0001..=0xe661_0006 {
        let pins = std::array::from_fn(|_| eeruf_hc_sr04::Pins { trigger: Pin, echo: Pin });
        let mut ring = robot::sonar(pins, Pin, chip, Instant::from_micros(0)).expect(`the settings are valid`);
        let fired: Vec<_> = (0..40).map(|_| { let at = ring.next_deadline(); ring.poll(at); at.as_micros() }).collect();
        println!(`{fired:?}`);
    }
}
";

/// The first lines of a `main.py` on six chips of this number, up to its first pin.
const CHIPS: &str = r"
import sys, types
sys.path.insert(0, '.')
for chip in range(6):
    said = []
    sys.modules['machine'] = types.SimpleNamespace(unique_id=lambda: bytes([0xE6, 0x61, chip]))
    try:
        exec(compile(open('main.py').read(), 'main.py', 'exec'), {'print': lambda *words: said.append(words)})
    except AttributeError:
        pass
    print(said[0][1])
";

/// Writes a program for four modules into a folder `robot`.
fn program(language: &str) -> (Scratch, PathBuf) {
    let (folder, file) =
        Scratch::new("ring.toml", "sensors = 4\nmodule = \"hc-sr04\"\nlayout = \"ring\"\nspeed_m_s = 0.5\n");
    let (out, words) = (folder.path().join("robot"), format!("--way flow --places 1 --program {language}"));
    let words: Vec<_> = words.split(' ').chain(["--out", out.to_str().unwrap()]).collect();
    let said = eeruf(&[&["design", file.to_str().unwrap()], &words[..]].concat());
    assert_eq!(said.code, Some(0), "{}", said.err);
    (folder, out)
}

fn write(folder: &Path, file: &str, text: &str) {
    std::fs::write(folder.join(file), text.replace('`', "\"")).unwrap();
}

/// Returns the lines that a command prints in a folder.
fn lines(folder: &Path, command: &mut Command) -> Vec<String> {
    let ran = command.current_dir(folder).output().unwrap();
    assert!(ran.status.success(), "{command:?}: {}", String::from_utf8_lossy(&ran.stderr));
    String::from_utf8(ran.stdout).unwrap().lines().map(str::to_owned).collect()
}

fn assert_six(lines: &[String], language: &str) {
    let different: BTreeSet<_> = lines.iter().filter(|line| !line.is_empty() && *line != "0").collect();
    assert_eq!((lines.len(), different.len()), (6, 6), "{language}: {lines:#?}");
}

/// Checks that the sketch draws its seed on boards whose chips have numbers, and of noise on one that has none, and has
/// the same again at the next start.
#[test]
fn six_boards_with_one_sketch_draw_six_seeds() {
    let root = env!("CARGO_MANIFEST_DIR");
    for (board, core) in [("uno", "__AVR__"), ("pico", "ARDUINO_ARCH_RP2040"), ("esp32", "ARDUINO_ARCH_ESP32")] {
        let (_kept, folder) = program(&format!("arduino --board {board}"));
        write(&folder, "src/eeruf/EerufFlow.h", RING);
        write(&folder, "src/eeruf/EerufArduino.h", "");
        let strict = ["-std=c++11", "-Wall", "-Wextra", "-Werror", "-Wno-int-to-pointer-cast", "-Isrc/eeruf"];
        let mut cpp = Command::new("g++");
        cpp.args(strict).args([
            format!("-D{core}"),
            format!("-I{root}/tests/programs"),
            format!("-I{root}/tests/arduino"),
        ]);
        lines(
            &folder,
            cpp.arg("-DSKETCH=\"robot.ino\"")
                .arg("-I.")
                .arg(format!("{root}/tests/programs/seed.cpp"))
                .args(["-o", "seeds"]),
        );
        let said = lines(&folder, &mut Command::new("./seeds"));
        let kept = said.iter().filter_map(|line| line.trim().split_once(' ')).filter(|(first, next)| first == next);
        assert_six(&kept.map(|(first, _)| first.to_owned()).collect::<Vec<_>>(), &format!("{board}: {said:?}"));
    }
}

#[test]
fn six_chips_with_one_main_py_have_six_seeds() {
    let (_kept, folder) = program("micropython");
    write(&folder, "chips.py", CHIPS);
    assert_six(&lines(&folder, Command::new("python3").arg("chips.py")), "micropython");
}

/// Checks that the seed that a program in C is given, its chip's number, decides when its modules fire.
#[test]
fn six_chips_with_one_program_in_c_fire_apart() {
    let (_kept, folder) = program("c");
    write(&folder, "main.c", FIRINGS);
    lines(
        &folder,
        Command::new("gcc")
            .args(["-std=c99", "-Wall", "-Werror", "-I.", "main.c", "sonar.c", "eeruf.c", "-o", "seeds"]),
    );
    assert_six(&lines(&folder, &mut Command::new("./seeds")), "c");
}

/// Checks the same of the crate, which is built by its paths in this checkout.
#[test]
fn six_chips_with_one_crate_fire_apart() {
    let (_kept, folder) = program("rust");
    let (root, manifest) = (env!("CARGO_MANIFEST_DIR"), folder.join("Cargo.toml"));
    let text = std::fs::read_to_string(&manifest).unwrap();
    let here = ["eeruf-core", "eeruf-hc-sr04"].iter().fold(text, |text, name| {
        let by_git = format!("{name} = {{ git = `https://github.com/eeruf/eeruf`").replace('`', "\"");
        assert!(text.contains(&by_git), "{text}");
        text.replace(&by_git, &format!("{name} = {{ path = \"{root}/crates/{name}\""))
    });
    std::fs::write(manifest, here).unwrap();
    write(&folder, "src/main.rs", DEADLINES);
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["run", "--quiet", "--offline"]).env("CARGO_TARGET_DIR", Path::new(root).join("target/listings"));
    assert_six(&lines(&folder, &mut cargo), "rust");
}
