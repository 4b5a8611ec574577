//! The C library in `c/`: strict compilers, what a caller may do wrong, the sample for Zephyr, equality with the Rust
//! crates under sanitizers.

use std::path::Path;
use std::process::Command;

use crate::steps::{Trouble, output, run};

const STRICT: [&str; 7] = ["-Wall", "-Wextra", "-Werror", "-pedantic", "-Wconversion", "-Wshadow", "-Ic"];
/// Compilers and the languages that each takes the library as.
const COMPILERS: [(&str, &[&str]); 8] = [
    ("gcc", &["-std=c99"]),
    ("gcc", &["-std=c17", "-DEERUF_HOPPING=0"]),
    ("g++", &["-xc++", "-std=c++11"]),
    ("g++", &["-xc++", "-std=c++20", "-DEERUF_HOPPING=0"]),
    ("avr-gcc", &["-mmcu=atmega328p", "-std=c99"]),
    ("avr-gcc", &["-mmcu=atmega328p", "-std=c99", "-DEERUF_SCHEDULE_IN_RAM"]),
    ("avr-g++", &["-mmcu=atmega328p", "-xc++", "-std=gnu++11"]),
    ("arm-none-eabi-gcc", &["-mcpu=cortex-m0", "-mthumb", "-std=c99"]),
];
const SANITIZERS: &str = "-fsanitize=address,undefined";

/// Returns true if a compiler is installed.
pub(crate) fn need(tool: &str, package: &str) -> Result<(), Trouble> {
    match output(Command::new(tool).arg("--version")) {
        Some(_) => Ok(()),
        None => Err(Trouble::Skipped(format!("no {tool}; install {package}"))),
    }
}

pub(crate) fn c() -> Result<(), Trouble> {
    let needed = [("g++", "g++"), ("avr-gcc", "gcc-avr avr-libc"), ("arm-none-eabi-gcc", "gcc-arm-none-eabi")];
    needed.iter().try_for_each(|(compiler, package)| need(compiler, package))?;
    let target = Path::new("target/c");
    std::fs::create_dir_all(target).map_err(|error| Trouble::Failed(error.to_string()))?;
    let object = target.join("eeruf.o");
    for (compiler, language) in COMPILERS {
        run(Command::new(compiler).args(language).args(STRICT).args(["-Os", "-c", "c/eeruf.c", "-o"]).arg(&object))?;
    }
    run(Command::new("gcc").args(STRICT).args(["-std=c99", "-c", "c/examples/flow.c", "-o"]).arg(&object))?;
    for (compiler, language) in &COMPILERS[..4] {
        let program = target.join("misuse");
        let sources = ["c/tests/misuse.c", "c/eeruf.c", SANITIZERS, "-fno-sanitize-recover=all", "-g", "-o"];
        run(Command::new(compiler).args(*language).args(STRICT).args(sources).arg(&program))?;
        run(&mut Command::new(program))?;
    }
    crate::zephyr::sample()?;
    equal_under_sanitizers()
}

/// The comparison of `eeruf-c-equal`, with the C side watched for each byte out of place.
fn equal_under_sanitizers() -> Result<(), Trouble> {
    let host = output(Command::new("rustc").args(["--print", "host-tuple"]))
        .ok_or_else(|| Trouble::Failed("rustc does not say its host".to_owned()))?;
    let asan = output(Command::new("gcc").arg("-print-file-name=libasan.so"))
        .ok_or_else(|| Trouble::Failed("gcc does not say where its libasan is".to_owned()))?;
    // With a target named, so that build scripts are built as ever. The sanitizer must be loaded before all else.
    let runner = format!("CARGO_TARGET_{}_RUNNER", host.to_uppercase().replace('-', "_"));
    run(Command::new("cargo")
        .args(["test", "--quiet", "--locked", "--package", "eeruf-c-equal", "--target", &host, "--tests"])
        .args(["--target-dir", "target/c/sanitized"])
        .env("CFLAGS", format!("{SANITIZERS} -fno-sanitize-recover=all -g"))
        .env("RUSTFLAGS", "-Clink-arg=-lasan -Clink-arg=-lubsan")
        .env(runner, format!("env LD_PRELOAD={asan}")))
}
