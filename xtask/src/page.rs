//! `cargo xtask page`: the page in `playground/`, as a folder for a server and as one file for a disk, and its tests.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;

use crate::steps::{Trouble, output, run};
use crate::toolchain::cargo_for_target;

const TARGET: &str = "wasm32-unknown-unknown";
const SOURCES: &str = "playground/page";
const TESTS: &str = "playground/tests";
/// The folder for a server.
const FOLDER: &str = "target/page/folder";
/// The one file for a disk, and the scripts that are bundled for it: browsers load no modules from a disk.
const SINGLE: &str = "target/page/who-fools-whom.html";
const BUNDLED: &str = "target/page/bundled";
/// Features of WebAssembly that the compiler may use, for `wasm-opt`.
const FEATURES: [&str; 6] = [
    "--enable-bulk-memory",
    "--enable-mutable-globals",
    "--enable-nontrapping-float-to-int",
    "--enable-sign-ext",
    "--enable-reference-types",
    "--enable-multivalue",
];
/// Packages that npm last installed for the tests.
const INSTALLED: &str = "node_modules/.installed.json";
/// The module that differs between the folder and the one file, and what stands for it there.
const PLATFORM: [&str; 2] = ["platform.js", "platform-single.js"];

/// Tests of the page to run.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tests {
    /// None, only build.
    No,
    /// Those that `cargo xtask test` runs.
    Short,
    /// All of them.
    Long,
}

/// Builds the page and tests it.
pub(crate) fn page(tests: Tests) -> Result<(), Trouble> {
    install()?;
    if tests == Tests::No {
        return build();
    }
    // Linking the engine takes one core; what else the tests need is made meanwhile.
    thread::scope(|scope| {
        let prepared = scope.spawn(prepare);
        build()?;
        prepared.join().map_err(|_| Trouble::Failed("what the tests need cannot be made".to_owned()))?
    })?;
    test(tests == Tests::Long)
}

/// Writes the folder and the one file.
fn build() -> Result<(), Trouble> {
    let mut cargo = cargo_for_target(TARGET)?;
    run(cargo.args(["build", "--package", "eeruf-playground", "--profile", "page", "--locked", "--target", TARGET]))?;
    let debian = cargo.get_program() == "/usr/bin/cargo";
    let built = PathBuf::from(if debian { "target/debian" } else { "target" });
    fs::create_dir_all(FOLDER).map_err(|error| failed(FOLDER, &error))?;
    let engine = format!("{FOLDER}/eeruf.wasm");
    shrink(&built.join(TARGET).join("page/eeruf_playground.wasm"), Path::new(&engine))?;
    let sources = sources()?;
    for (name, text) in sources.iter().filter(|(name, _)| **name != PLATFORM[1]) {
        write(&format!("{FOLDER}/{name}"), text)?;
    }
    let engine = fs::read(&engine).map_err(|error| failed(&engine, &error))?;
    write(SINGLE, &single(&sources, &engine)?)?;
    println!("{FOLDER}/index.html is for a server, {SINGLE} for a disk");
    Ok(())
}

/// Makes the engine smaller where `wasm-opt` is installed, if it was rebuilt.
fn shrink(from: &Path, to: &Path) -> Result<(), Trouble> {
    let changed = |path: &Path| path.metadata().and_then(|about| about.modified()).ok();
    if changed(to).is_some_and(|to| changed(from).is_some_and(|from| from < to)) {
        return Ok(());
    }
    if output(Command::new("wasm-opt").arg("--version")).is_some() {
        return run(Command::new("wasm-opt").arg("-Os").args(FEATURES).arg(from).arg("-o").arg(to));
    }
    println!("no wasm-opt, so the engine is a little larger; try: apt install binaryen");
    fs::copy(from, to).map(drop).map_err(|error| failed(&from.display().to_string(), &error))
}

/// The page's files by name.
fn sources() -> Result<BTreeMap<String, String>, Trouble> {
    let mut sources = BTreeMap::new();
    for entry in fs::read_dir(SOURCES).map_err(|error| failed(SOURCES, &error))? {
        let path = entry.map_err(|error| failed(SOURCES, &error))?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let text = fs::read_to_string(&path).map_err(|error| failed(&name, &error))?;
        sources.insert(name, text);
    }
    Ok(sources)
}

/// The page as one file: style, scripts and engine within it.
fn single(sources: &BTreeMap<String, String>, engine: &[u8]) -> Result<String, Trouble> {
    let html = sources.get("index.html").ok_or_else(|| Trouble::Failed(format!("{SOURCES}: no index.html")))?;
    let style = sources.get("style.css").map(String::as_str).unwrap_or_default();
    fs::create_dir_all(BUNDLED).map_err(|error| failed(BUNDLED, &error))?;
    for (name, text) in sources.iter().filter(|(name, _)| **name != PLATFORM[0]) {
        write(&format!("{BUNDLED}/{}", if name == PLATFORM[1] { PLATFORM[0] } else { name }), text)?;
    }
    // What a script element holds ends at its end tag, and a comment begins in HTML too.
    let plain = |text: String| {
        if text.contains("</script") || text.contains("<!--") {
            return Err(Trouble::Failed("a script holds </script or <!--, which ends it in HTML".to_owned()));
        }
        Ok(text)
    };
    let scripts = format!(
        "<script type=\"text/plain\" id=\"engine-packed\">{}</script>\n\
         <script type=\"text/plain\" id=\"worker-source\">{}</script>\n\
         <script>{}</script>",
        packed(engine)?,
        plain(bundle("worker.js")?)?,
        plain(bundle("main.js")?)?,
    );
    let policy = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; \
                  style-src 'unsafe-inline'; img-src data:";
    let (before, rest) = split(html, "content=\"default-src")?;
    let (_, after) = split(rest, "\">")?;
    let html = format!("{before}content=\"{policy}\">{after}");
    let html = replaced(&html, "<link rel=\"stylesheet\" href=\"style.css\">", &format!("<style>\n{style}</style>"))?;
    replaced(&html, "<script type=\"module\" src=\"main.js\"></script>", &scripts)
}

/// A module and all that it imports as one classic script.
fn bundle(entry: &str) -> Result<String, Trouble> {
    let mut esbuild = Command::new(Path::new(TESTS).join("node_modules/.bin/esbuild"));
    esbuild.args(["--bundle", "--format=iife", "--charset=utf8", "--log-level=warning"]);
    output(esbuild.arg(format!("{BUNDLED}/{entry}"))).ok_or_else(|| failed(entry, &"esbuild does not take it"))
}

fn split<'a>(text: &'a str, at: &str) -> Result<(&'a str, &'a str), Trouble> {
    text.split_once(at).ok_or_else(|| Trouble::Failed(format!("index.html: no {at}")))
}

fn replaced(text: &str, part: &str, by: &str) -> Result<String, Trouble> {
    let (before, after) = split(text, part)?;
    Ok(format!("{before}{by}{after}"))
}

/// The engine as letters: packed first, since letters pack badly.
fn packed(engine: &[u8]) -> Result<String, Trouble> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    let packed = encoder.write_all(engine).and_then(|()| encoder.finish());
    packed.map(|packed| BASE64_STANDARD.encode(packed)).map_err(|error| failed("eeruf.wasm", &error))
}

/// Installs what bundles and tests the page, if that is not done.
fn install() -> Result<(), Trouble> {
    if output(Command::new("node").arg("--version")).is_none() {
        return Err(Trouble::Skipped("no node; try: apt install nodejs npm".to_owned()));
    }
    let npm = if cfg!(windows) { "npm.cmd" } else { "npm" };
    let tests = Path::new(TESTS);
    if output(Command::new(npm).arg("--version")).is_none() {
        return Err(Trouble::Skipped("no npm; try: apt install npm".to_owned()));
    }
    // A copy of the lock file says what is installed.
    let read = |name: &str| fs::read_to_string(tests.join(name)).ok();
    let lock = read("package-lock.json");
    if lock.is_none() || read(INSTALLED) != lock {
        run(Command::new(npm).current_dir(tests).args(["ci", "--ignore-scripts", "--no-audit", "--no-fund"]))?;
        write(&tests.join(INSTALLED).display().to_string(), &lock.unwrap_or_default())?;
    }
    Ok(())
}

/// Makes what the tests need beside the page: types without a fault, and the program that the engine is held against.
fn prepare() -> Result<(), Trouble> {
    let npm = if cfg!(windows) { "npm.cmd" } else { "npm" };
    run(Command::new(npm).current_dir(TESTS).args(["run", "--silent", "types"]))?;
    crate::program::program().map(drop)
}

/// Runs the tests in Node and, if there is one, a browser.
fn test(long: bool) -> Result<(), Trouble> {
    let mut node = Command::new("node");
    node.current_dir(TESTS).args(["--test", "--test-reporter=spec"]);
    node.env("PAGE_LONG", if long { "1" } else { "" });
    // Files run beside each other, but where figures are printed. Before Node 20.10 there is no such option.
    let beside = if long { "--test-concurrency=1" } else { "--test-concurrency=3" };
    if output(Command::new("node").args([beside, "--version"])).is_some() {
        node.arg(beside);
    }
    let browser = ["chromium", "chromium-browser", "google-chrome"].iter().find_map(|name| which(name));
    let Some(browser) = browser else {
        run(node.arg("engine.test.js"))?;
        return Err(Trouble::Skipped(
            "the engine is tested, the page is not: no browser; try: apt install chromium".into(),
        ));
    };
    run(node.env("PAGE_BROWSER", browser).args(["engine.test.js", "colours.test.js", "page.test.js"]))
}

/// Where a program is.
fn which(name: &str) -> Option<PathBuf> {
    std::env::split_paths(&std::env::var_os("PATH")?).map(|folder| folder.join(name)).find(|path| path.is_file())
}

fn write(path: &str, text: &str) -> Result<(), Trouble> {
    fs::write(path, text).map_err(|error| failed(path, &error))
}

fn failed(what: &str, error: &dyn std::fmt::Display) -> Trouble {
    Trouble::Failed(format!("{what}: {error}"))
}
