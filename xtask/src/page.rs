//! `cargo xtask page`: the page in `playground/`, as a folder for a server and as one file for a disk, and its tests.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::thread;

use anyhow::{Context as _, Result, anyhow, ensure};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use fs_err as fs;

use crate::c::npm;
use crate::steps::{command, edited, need, output, run, skip};
use crate::toolchain::{cargo_for_target, target_folder};

const TARGET: &str = "wasm32-unknown-unknown";
const SOURCES: &str = "playground/page";
const TESTS: &str = "playground/tests";
/// The folder for a server.
const FOLDER: &str = "target/page/folder";
/// The single file for a disk, and the scripts bundled for it: browsers load no modules from a disk.
const SINGLE: &str = "target/page/who-fools-whom.html";
const BUNDLED: &str = "target/page/bundled";
/// The command that makes the engine smaller, with the features of WebAssembly that the compiler may use.
const SHRINK: &str = "wasm-opt -Os --enable-bulk-memory --enable-mutable-globals --enable-nontrapping-float-to-int \
                      --enable-sign-ext --enable-reference-types --enable-multivalue";
/// Packages that npm last installed for the tests.
const INSTALLED: &str = "node_modules/.installed.json";
/// The module that differs between the folder and the one file, and its replacement there.
const PLATFORM: [&str; 2] = ["platform.js", "platform-single.js"];

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
    let sources = sources()?;
    for (name, text) in sources.iter().filter(|(name, _)| **name != PLATFORM[1]) {
        fs::write(format!("{FOLDER}/{name}"), text)?;
    }
    let engine = fs::read(&engine)?;
    fs::write(SINGLE, single(&sources, &engine)?)?;
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

/// Returns the page's files by name.
fn sources() -> Result<BTreeMap<String, String>> {
    let mut sources = BTreeMap::new();
    for entry in fs::read_dir(SOURCES)? {
        let path = entry?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let text = fs::read_to_string(&path)?;
        sources.insert(name, text);
    }
    Ok(sources)
}

/// Makes the page as one file: style, scripts and engine within it.
fn single(sources: &BTreeMap<String, String>, engine: &[u8]) -> Result<String> {
    let html = sources.get("index.html").with_context(|| format!("{SOURCES}: no index.html"))?;
    let style = sources.get("style.css").map(String::as_str).unwrap_or_default();
    fs::create_dir_all(BUNDLED)?;
    for (name, text) in sources.iter().filter(|(name, _)| **name != PLATFORM[0]) {
        fs::write(format!("{BUNDLED}/{}", if name == PLATFORM[1] { PLATFORM[0] } else { name }), text)?;
    }
    // The content of a script element ends at the first end tag, and HTML comments begin in it too.
    let plain = |text: String| {
        let is_plain = !text.contains("</script") && !text.contains("<!--");
        ensure!(is_plain, "a script holds </script or <!--, which ends it in HTML");
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
    let of_folder = html.split('"').find(|part| part.starts_with("default-src")).context("index.html: no policy")?;
    let style = format!("<style>\n{style}</style>");
    let link = "<link rel=\"stylesheet\" href=\"style.css\">";
    edited(
        html,
        &[(of_folder, policy), (link, &style), ("<script type=\"module\" src=\"main.js\"></script>", &scripts)],
    )
}

/// Bundles a module and all its imports as one classic script.
fn bundle(entry: &str) -> Result<String> {
    let mut esbuild = Command::new(Path::new(TESTS).join("node_modules/.bin/esbuild"));
    esbuild.args(["--bundle", "--format=iife", "--charset=utf8", "--log-level=warning"]);
    output(esbuild.arg(format!("{BUNDLED}/{entry}")))
}

/// Encodes the engine as text: compressed first, since text compresses badly.
fn packed(engine: &[u8]) -> Result<String> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    let packed = encoder.write_all(engine).and_then(|()| encoder.finish());
    Ok(BASE64_STANDARD.encode(packed?))
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
    let browsers = ["chromium", "chromium-browser", "google-chrome"];
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut found = std::env::split_paths(&path).flat_map(|folder| browsers.map(|name| folder.join(name)));
    let Some(browser) = found.find(|path| path.is_file()) else {
        run(node.arg("engine.test.js"))?;
        return skip("the engine is tested, the page is not: no browser; try: apt install chromium");
    };
    run(node.env("PAGE_BROWSER", browser).args(["engine.test.js", "colours.test.js", "page.test.js"]))
}
