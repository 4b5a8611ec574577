//! Compilers by purpose: a declared minimum version, or a target without an operating system.
//!
//! Compilers that come from different places must not share a target directory.

use std::env;
use std::path::Path;
use std::process::Command;

use crate::steps::{Trouble, output};

/// A `cargo` that compiles with this minor version of Rust ("1.85").
///
/// That is the default one, one of rustup's, or the compiler that the environment variable `EERUF_RUSTC_1_85` names.
pub(crate) fn cargo_of_version(version: &str) -> Result<Command, Trouble> {
    let is_it = |command: &mut Command| {
        output(command.arg("--version")).is_some_and(|said| said.starts_with(&format!("rustc {version}.")))
    };
    if is_it(&mut Command::new("rustc")) {
        return Ok(Command::new("cargo"));
    }
    let variable = format!("EERUF_RUSTC_{}", version.replace('.', "_"));
    if let Some(rustc) = env::var_os(&variable) {
        if !is_it(&mut Command::new(&rustc)) {
            return Err(Trouble::Failed(format!("{variable} does not name a rustc {version}")));
        }
        let mut cargo = Command::new("cargo");
        cargo.env("RUSTC", rustc).env("CARGO_TARGET_DIR", format!("target/rust-{version}"));
        return Ok(cargo);
    }
    let toolchain = format!("+{version}");
    if is_it(Command::new("rustc").arg(&toolchain)) {
        let mut cargo = Command::new("cargo");
        cargo.arg(toolchain).env("CARGO_TARGET_DIR", format!("target/rust-{version}"));
        return Ok(cargo);
    }
    Err(Trouble::Skipped(format!("no rustc {version}; try: rustup toolchain install {version}")))
}

/// A `cargo` that compiles for a target without an operating system; the caller adds `build --target` and the rest.
///
/// That is rustup's if the target is installed; else Debian's, which builds `core` from its sources, and for
/// WebAssembly
/// `std` too.
pub(crate) fn cargo_for_target(target: &str) -> Result<Command, Trouble> {
    let libdir = output(Command::new("rustc").args(["--print", "target-libdir", "--target", target]));
    let has_core = |dir: &str| {
        let entries = Path::new(dir).read_dir().ok()?;
        Some(entries.flatten().any(|entry| entry.file_name().to_string_lossy().starts_with("libcore-")))
    };
    if libdir.is_some_and(|dir| has_core(&dir) == Some(true)) {
        return Ok(Command::new("cargo"));
    }
    let debian = ["/usr/bin/cargo", "/usr/bin/rustc", "/usr/lib/rustlib/src/rust/library/core", "/usr/bin/rust-lld"];
    if debian.iter().all(|path| Path::new(path).exists()) {
        let mut cargo = Command::new("/usr/bin/cargo");
        let path = env::var("PATH").unwrap_or_default();
        cargo
            .env("PATH", format!("/usr/bin:{path}"))
            .env("RUSTC", "/usr/bin/rustc")
            .env("RUSTC_BOOTSTRAP", "1")
            .env("CARGO_UNSTABLE_BUILD_STD", if target.starts_with("wasm32") { "std,panic_abort" } else { "core" })
            .env("CARGO_TARGET_DIR", "target/debian");
        return Ok(cargo);
    }
    Err(Trouble::Skipped(format!(
        "no core library for {target}; try: rustup target add {target} (or Debian's rustc-web, cargo-web, rust-web-src \
         and lld-22)"
    )))
}
