//! Cargo by purpose: for a declared minimum version, or a target without an operating system; and its results.
//!
//! Compilers that come from different places must not share a target directory.

use std::env;
use std::env::consts::EXE_SUFFIX;
use std::path::{Path, PathBuf, absolute};
use std::process::Command;

use anyhow::{Context as _, Result, bail};

use crate::steps::{output, run, skip};

/// Debian's compiler, which builds the standard library from its sources.
const DEBIAN_CARGO: &str = "/usr/bin/cargo";
pub(crate) const DEBIAN_RUSTC: &str = "/usr/bin/rustc";

/// The version of a compiler, as "1.95".
pub(crate) fn version_of(rustc: &str) -> Result<String> {
    let said = output(Command::new(rustc).arg("--version"))?;
    let numbers = said.strip_prefix("rustc ").with_context(|| format!("{rustc} --version says {said}"))?;
    Ok(numbers.split('.').take(2).collect::<Vec<_>>().join("."))
}

/// A `cargo` that compiles with this minor version of Rust ("1.85").
///
/// It is the default compiler, one of rustup's, or the one that the environment variable `EERUF_RUSTC_1_85` names.
pub(crate) fn cargo_of_version(version: &str) -> Result<Command> {
    let is_it = |command: &mut Command| {
        output(command.arg("--version")).is_ok_and(|said| said.starts_with(&format!("rustc {version}.")))
    };
    let mut cargo = Command::new("cargo");
    if is_it(&mut Command::new("rustc")) {
        return Ok(cargo);
    }
    cargo.env("CARGO_TARGET_DIR", format!("target/rust-{version}"));
    let variable = format!("EERUF_RUSTC_{}", version.replace('.', "_"));
    if let Some(rustc) = env::var_os(&variable) {
        if !is_it(&mut Command::new(&rustc)) {
            bail!("{variable} does not name a rustc {version}");
        }
        cargo.env("RUSTC", rustc);
        return Ok(cargo);
    }
    let toolchain = format!("+{version}");
    if is_it(Command::new("rustc").arg(&toolchain)) {
        cargo.arg(toolchain);
        return Ok(cargo);
    }
    skip(format!("no rustc {version}; try: rustup toolchain install {version}"))
}

/// Returns true if the default compiler has the library `core` for a target.
fn has_core(target: &str) -> bool {
    let folder = output(Command::new("rustc").args(["--print", "target-libdir", "--target", target]));
    let entries = folder.ok().and_then(|folder| Path::new(&folder).read_dir().ok());
    entries.is_some_and(|mut entries| {
        entries.any(|entry| entry.is_ok_and(|entry| entry.file_name().to_string_lossy().starts_with("libcore-")))
    })
}

/// A `cargo` that compiles for a target without an operating system; the caller adds `build --target` and the rest.
///
/// It is rustup's if the target is installed; else Debian's, which builds `core` from its sources, and for WebAssembly
/// `std` too.
pub(crate) fn cargo_for_target(target: &str) -> Result<Command> {
    if has_core(target) {
        let mut cargo = Command::new("cargo");
        // Images are looked for in `target_folder`.
        cargo.env_remove("CARGO_TARGET_DIR");
        return Ok(cargo);
    }
    let debian = [DEBIAN_CARGO, DEBIAN_RUSTC, "/usr/lib/rustlib/src/rust/library/core", "/usr/bin/rust-lld"];
    if debian.iter().all(|path| Path::new(path).exists()) {
        let mut cargo = Command::new(DEBIAN_CARGO);
        cargo
            .env("PATH", format!("/usr/bin:{}", env::var("PATH").unwrap_or_default()))
            .env("RUSTC", DEBIAN_RUSTC)
            .env("RUSTC_BOOTSTRAP", "1")
            .env("CARGO_UNSTABLE_BUILD_STD", if target.starts_with("wasm32") { "std,panic_abort" } else { "core" })
            .env("CARGO_TARGET_DIR", "target/debian");
        return Ok(cargo);
    }
    skip(format!(
        "no core library for {target}; try: rustup target add {target} (or Debian's rustc-web, cargo-web, rust-web-src \
         and lld-22)"
    ))
}

/// Returns true if a command is Debian's `cargo`, whose standard library has known frame sizes.
pub(crate) fn is_debian(cargo: &Command) -> bool {
    cargo.get_program() == DEBIAN_CARGO
}

/// The folder below the current one in which a `cargo` of [`cargo_for_target`] builds.
pub(crate) fn target_folder(cargo: &Command) -> &'static str {
    if is_debian(cargo) { "target/debian" } else { "target" }
}

/// The size limit in bytes of a build product. Limits are for the compilers that CI installs; CI sets
/// `EERUF_EXACT_SIZES`. Without that variable a twentieth more is allowed.
pub(crate) fn most_bytes(limit: u64) -> u64 {
    most(limit, env::var_os("EERUF_EXACT_SIZES").is_some())
}

const fn most(limit: u64, exact: bool) -> u64 {
    if exact { limit } else { limit + limit / 20 }
}

/// Builds the program `eeruf`.
pub(crate) fn program() -> Result<PathBuf> {
    built("eeruf")
}

/// Builds the program of `cargo lab`.
pub(crate) fn lab() -> Result<PathBuf> {
    built("eeruf-lab")
}

/// A binary of the workspace as built for the tests, with the features of all packages: other features would rebuild
/// the dependencies. A test is built too, so that dependencies have the features that tests need.
pub(crate) fn built(name: &str) -> Result<PathBuf> {
    build("--bin", name, "")
}

/// An example of the workspace, likewise.
pub(crate) fn example(name: &str) -> Result<PathBuf> {
    build("--example", name, "examples/")
}

fn build(kind: &str, name: &str, folder: &str) -> Result<PathBuf> {
    let build = ["build", "--quiet", "--locked", "--workspace", "--test", "line", kind, name];
    run(Command::new("cargo").args(build))?;
    Ok(absolute(format!("target/debug/{folder}{name}{EXE_SUFFIX}"))?)
}

#[cfg(test)]
mod tests {
    #[test]
    fn sizes_have_slack_where_the_compiler_is_not_cis() {
        // A page of 742.8 kB, where CI's compiler and wasm-opt make one below 740.
        assert!(super::most(740_000, false) > 742_800 && super::most(740_000, true) < 742_800);
    }
}
