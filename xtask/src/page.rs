//! `cargo xtask page`: the page in `playground/`, as a folder for a server and as one file for a disk, and its tests.

use std::path::Path;
use std::process::Command;
use std::thread;

use anyhow::{Result, anyhow};
use fs_err as fs;

use crate::c::npm;
use crate::steps::{command, need, output, run, skip};
use crate::toolchain::{cargo_for_target, target_folder};

const TARGET: &str = "wasm32-unknown-unknown";
const SOURCES: &str = "playground/page";
const TESTS: &str = "playground/tests";
/// The folder for a server.
const FOLDER: &str = "target/page/folder";
/// The single file for a disk.
const SINGLE: &str = "target/page/who-fools-whom.html";
/// The command that makes the engine smaller, with the features of WebAssembly that the compiler may use.
const SHRINK: &str = "wasm-opt -Os --enable-bulk-memory --enable-mutable-globals --enable-nontrapping-float-to-int \
                      --enable-sign-ext --enable-reference-types --enable-multivalue";
/// Packages that npm last installed for the tests.
const INSTALLED: &str = "node_modules/.installed.json";
/// The module that the one file has in place of another of the folder.
const PLATFORM_OF_SINGLE: &str = "platform-single.js";

/// Builds the page and, if asked to, runs the tests that `cargo xtask test` runs, or all of them.
pub(crate) fn page(short: bool, long: bool) -> Result<()> {
    install()?;
    if !short && !long {
        return build();
    }
    // Linking the engine takes one core; the other needs of the tests are prepared meanwhile.
    thread::scope(|scope| {
        let prepared = scope.spawn(prepare);
        build()?;
        prepared.join().map_err(|_| anyhow!("what the tests need cannot be made"))?
    })?;
    test(long)
}

/// Writes the folder and the one file.
fn build() -> Result<()> {
    let mut cargo = cargo_for_target(TARGET)?;
    run(cargo.args(["build", "--package", "eeruf-playground", "--profile", "page", "--locked", "--target", TARGET]))?;
    let built = Path::new(target_folder(&cargo));
    fs::create_dir_all(FOLDER)?;
    let engine = format!("{FOLDER}/eeruf.wasm");
    shrink(&built.join(TARGET).join("page/eeruf_playground.wasm"), Path::new(&engine))?;
    for entry in fs::read_dir(SOURCES)?.filter_map(Result::ok) {
        if entry.file_name() != PLATFORM_OF_SINGLE {
            fs::copy(entry.path(), Path::new(FOLDER).join(entry.file_name()))?;
        }
    }
    run(Command::new("node").arg(format!("{TESTS}/single.js")).args([SOURCES, &engine, SINGLE]))?;
    println!("{FOLDER}/index.html is for a server, {SINGLE} for a disk");
    Ok(())
}

/// Makes the engine smaller where `wasm-opt` is installed, if it was rebuilt.
fn shrink(from: &Path, to: &Path) -> Result<()> {
    let changed = |path: &Path| path.metadata().and_then(|about| about.modified()).ok();
    if changed(to).is_some_and(|to| changed(from).is_some_and(|from| from < to)) {
        return Ok(());
    }
    if output(Command::new("wasm-opt").arg("--version")).is_ok() {
        return run(command(SHRINK).arg(from).arg("-o").arg(to));
    }
    println!("no wasm-opt, so the engine is a little larger; try: apt install binaryen");
    fs::copy(from, to)?;
    Ok(())
}

/// Installs the packages that bundle and test the page, unless they are installed.
fn install() -> Result<()> {
    need("node --version", "apt install nodejs npm")?;
    let tests = Path::new(TESTS);
    // A copy of the lock file says what is installed.
    let read = |name: &str| fs::read_to_string(tests.join(name)).ok();
    let lock = read("package-lock.json");
    if lock.is_none() || read(INSTALLED) != lock {
        npm(TESTS, "ci --ignore-scripts --no-audit --no-fund")?;
        fs::write(tests.join(INSTALLED), lock.unwrap_or_default())?;
    }
    Ok(())
}

/// Prepares the tests of the page: checks types, and builds the program that the engine is compared with.
fn prepare() -> Result<()> {
    npm(TESTS, "run --silent types")?;
    crate::toolchain::program().map(drop)
}

/// Runs the tests in Node and, if there is one, a browser.
fn test(long: bool) -> Result<()> {
    let mut node = Command::new("node");
    node.current_dir(TESTS).args(["--test", "--test-reporter=spec"]);
    node.env("PAGE_LONG", if long { "1" } else { "" });
    // Test files run in parallel, except where figures are printed. Before Node 20.10 there is no such option.
    let beside = if long { "--test-concurrency=1" } else { "--test-concurrency=3" };
    if output(Command::new("node").args([beside, "--version"])).is_ok() {
        node.arg(beside);
    }
    let browsers = "command -v chromium || command -v chromium-browser || command -v google-chrome";
    let Ok(browser) = output(Command::new("sh").args(["-c", browsers])) else {
        run(node.arg("engine.test.js"))?;
        return skip("the engine is tested, the page is not: no browser; try: apt install chromium");
    };
    run(node.env("PAGE_BROWSER", browser).args(["engine.test.js", "colours.test.js", "page.test.js"]))
}
