//! Listings of README and the guides: each is compiled or run in the folder where a reader would have it, or is part of
//! such a file.

use std::fs;
use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::path::Path;
use std::process::Command;

use crate::newcomers::shell;

/// A listing of a document.
struct Listing {
    document: String,
    language: String,
    /// The file to which the text belongs.
    source: Option<String>,
    text: String,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: impl AsRef<Path>) -> String {
    fs::read_to_string(root().join(&path)).unwrap_or_else(|error| panic!("{}: {error}", path.as_ref().display()))
}

/// README and the guides.
fn documents() -> Vec<String> {
    let guides = fs::read_dir(root().join("docs/how-to")).unwrap();
    let mut names: Vec<_> = guides.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let guides = names.into_iter().filter(|name| name.ends_with(".md")).map(|name| format!("docs/how-to/{name}"));
    ["README.md".to_owned()].into_iter().chain(guides).collect()
}

fn listings(document: &str) -> Vec<Listing> {
    let text = read(document);
    let mut found = Vec::new();
    let mut before = "";
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if let Some(language) = line.strip_prefix("```") {
            let body = lines.by_ref().take_while(|line| *line != "```").map(|line| format!("{line}\n")).collect();
            let source = before.strip_prefix("<!-- listing: ").and_then(|rest| rest.split(' ').next());
            let (document, language) = (document.to_owned(), language.to_owned());
            found.push(Listing { document, language, source: source.map(str::to_owned), text: body });
        }
        before = line;
    }
    found
}

/// Beginnings of commands that other tests run or that need missing tools, each with the file that runs it.
const ELSEWHERE: [(&str, &str); 15] = [
    ("cargo xtask test", "xtask/src/test.rs"),
    ("cargo install --path crates/eeruf-ros2", "xtask/src/ros2.rs"),
    ("pip install .", "xtask/src/python.rs"),
    ("git clone ", "xtask/src/ros2.rs"),
    ("colcon build ", "xtask/src/ros2.rs"),
    (". install/setup.sh", "xtask/src/ros2.rs"),
    ("ros2 ", "tests/ros2/test_launched.py"),
    ("sudo", "xtask/src/deb.rs"),
    ("eeruf-ros2 --gpio", "crates/eeruf-ros2/src/gpio.rs"),
    ("eeruf-ros2 --no-ros", "tests/ros2/test_mavlink.py"),
    ("eeruf-ros2 --", "tests/ros2/test_node.py"),
    ("rustup target add ", "xtask/src/examples.rs"),
    ("cp -r ~/eeruf/examples/", "xtask/src/examples.rs"),
    ("sed -i ", "xtask/src/examples.rs"),
    ("cargo build --release", "xtask/src/examples.rs"),
];

/// Parts of commands that take minutes, and shorter replacements.
const SHORTER: [(&str, &str); 5] = [
    ("eeruf design ring.toml", "eeruf design ring.toml --places 1"),
    ("eeruf design robot.toml", "eeruf design robot.toml --places 1"),
    ("eeruf design RING.toml", "eeruf design RING.toml --places 1"),
    ("eeruf lab dataset OUT", "eeruf lab dataset OUT --alcoves 1 --courses 0 --periods 20"),
    ("lab experiment set-one", "lab experiment set-one --seeds 8 --method eeruf"),
];

/// Makes the folder of a reader: a clone's `c`, the examples, and the rings and logs of the guides.
fn folder_of_a_reader(document: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    assert!(shell("eeruf examples .", folder.path()).status.success());
    symlink(root().join("c"), path("c")).unwrap();
    for made in ["src", "Arduino/libraries", "bin", "target"] {
        fs::create_dir_all(path(made)).unwrap();
    }
    let ring = listings("README.md").into_iter().find(|listing| listing.language == "toml").unwrap().text;
    // A survey writes it.
    let written = if document.ends_with("survey.md") { "ring.toml" } else { "" };
    for name in ["ring.toml", "RING.toml", "robot.toml"].into_iter().filter(|name| *name != written) {
        fs::write(path(name), &ring).unwrap();
    }
    // An autopilot must know where each sensor looks.
    if document.ends_with("autopilots.md") {
        fs::write(path("ring.toml"), ring + "spacing_deg = 45.0\nradius_m = 0.2\n").unwrap();
    }
    fs::copy(root().join("tests/data/field-cases/multiarray.bag"), path("drive.bag")).unwrap();
    let rows = |row: &dyn Fn(u32) -> String| (1..20).map(row).collect::<String>();
    fs::write(path("serial.csv"), rows(&|k| format!("{},40,x,{}\n", 60 * k, if k % 4 == 0 { 999 } else { 80 })))
        .unwrap();
    let table = "stamp,left,right\n".to_owned() + &rows(&|k| format!("{},{},80\n", 60 * k, 40 + k % 2));
    fs::write(path("log.csv"), table).unwrap();
    // Lines as an MQTT broker's client prints them.
    fs::write(path("bin/mosquitto_sub"), "#!/bin/sh\nfor k in 1 2 3 4 5 6 7 8; do echo car/left 0.4$k; done\n")
        .unwrap();
    fs::set_permissions(path("bin/mosquitto_sub"), fs::Permissions::from_mode(0o755)).unwrap();
    folder
}

/// Runs a command of a listing in a shell; returns the fault, if any.
fn run(command: &str, folder: &Path) -> Option<String> {
    let mut words = command.replace("cargo run --release -- ", "eeruf ").replace("cargo run -- ", "eeruf ");
    for (part, shorter) in SHORTER {
        words = words.replace(part, shorter);
    }
    if words.starts_with("eeruf design rings/") && words.ends_with(".toml") {
        words += " --period-only";
    }
    let home = folder.display();
    let setting = format!("export HOME='{home}' SLURM_ARRAY_TASK_ID=1 PATH=\"{home}/bin:$PATH\"");
    let output = shell(&format!("{setting}; {words}"), folder);
    // No crosstalk, crosstalk, or a log that cannot tell: an answer each.
    let answers: &[i32] = if words.contains("eeruf logs") { &[0, 1, 3] } else { &[0] };
    let is_right = output.status.code().is_some_and(|code| answers.contains(&code));
    (!is_right).then(|| format!("{words}: {:?} {}", output.status.code(), String::from_utf8_lossy(&output.stderr)))
}

/// Compiles a sketch against the cores' declarations; one that is cut off has an empty `loop`.
fn compile_sketch(text: &str, folder: &Path) -> Option<String> {
    let sketch = folder.join("sketch.cpp");
    fs::write(&sketch, if text.contains("void loop") { text.to_owned() } else { format!("{text}void loop() {{}}\n") })
        .unwrap();
    let mut compiler = Command::new("g++");
    compiler.args(["-std=c++11", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-DARDUINO_ARCH_RP2040", "-I"]);
    compiler.arg(root().join("tests/arduino")).args(["-include", "Arduino.h", "-I"]);
    let output = compiler.arg(folder.join("Arduino/libraries/Eeruf/src")).arg(&sketch).output().expect("g++ runs");
    (!output.status.success()).then(|| format!("{text}{}", String::from_utf8_lossy(&output.stderr)))
}

/// Builds and runs a program in a crate that depends on core by its path.
fn run_crate(text: &str, folder: &Path) -> Option<String> {
    let core = root().join("crates/eeruf-core");
    let manifest = "[package]\nname = 'listing'\nversion = '0.1.0'\nedition = '2024'\n[workspace]\n[dependencies]\n";
    fs::write(folder.join("Cargo.toml"), format!("{manifest}eeruf-core = {{ path = '{}' }}\n", core.display()))
        .unwrap();
    fs::write(folder.join("src/main.rs"), text).unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["run", "--quiet", "--offline"]).current_dir(folder);
    // Core is compiled once for all runs of the tests.
    let output = cargo.env("CARGO_TARGET_DIR", root().join("target/listings")).output().unwrap();
    (!output.status.success()).then(|| format!("{text}{}", String::from_utf8_lossy(&output.stderr)))
}

/// Checks a listing by its language; returns the fault, if any. A listing that no test covers is a fault.
fn check(listing: &Listing, folder: &Path) -> Vec<String> {
    let Listing { document, language, source, text } = listing;
    let eeruf = |words: &str| run(&format!("eeruf {words}"), folder);
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    if let Some(source) = source {
        let part: Vec<_> = text.lines().map(str::trim_end).collect();
        let file = read(source);
        let lines: Vec<_> = file.lines().map(str::trim_end).collect();
        let is_part = lines.windows(part.len()).any(|window| window == part);
        return if is_part { vec![] } else { vec![format!("not a part of {source}:\n{text}")] };
    }
    let wrong = match language.as_str() {
        "sh" => {
            let commands = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
            let wrong = commands.filter_map(|command| match ELSEWHERE.iter().find(|of| command.starts_with(of.0)) {
                Some((_, holder)) => (!root().join(holder).exists()).then(|| format!("{command}: no {holder}")),
                // The sketch's runner needs the simulated Uno of `cargo xtask arduino`.
                None if command.starts_with("./uno.sh ") => {
                    let files = command.split(' ').filter(|word| word.contains('/') && !word.starts_with("./"));
                    let missing = files.filter(|file| !root().join("c/arduino").join(file).exists());
                    missing.map(|file| format!("{command}: no {file}")).next()
                }
                None => run(command, folder),
            });
            return wrong.collect();
        }
        // `examples_in_documents_are_what_the_program_prints` runs them.
        "console" => None,
        "python" => {
            let held = read("tests/python/test_docs.py").contains(&format!("(\"{document}\", "));
            (!held).then(|| "tests/python/test_docs.py does not run its Python".to_owned())
        }
        "rust" => run_crate(text, folder),
        "cpp" => compile_sketch(text, folder),
        "toml" if text.contains("[[robot]]") => {
            write("room.toml", text);
            eeruf("study room.toml --method sequential --periods 40 --log room.csv")
        }
        "toml" if text.contains("[[fault]]") => {
            write("fault.toml", &(read("scenes/alcove.toml") + "\n" + text));
            eeruf("lab paths fault.toml")
        }
        "toml" => {
            write("listing.toml", text);
            eeruf("design listing.toml --period-only")
        }
        // The project stands beside the clone.
        "yaml" => {
            // A component of ESP-IDF, or ESPHome's folder of components, whose test reads such a file.
            let path = text.split("path: ").nth(1).and_then(|rest| rest.split([' ', '\n']).next()).unwrap_or_default();
            let path = root().join(path.trim_start_matches("../../eeruf/"));
            let is_there = ["idf_component.yml", "eeruf/__init__.py"].iter().any(|file| path.join(file).exists());
            (!is_there).then(|| format!("no component at its path:\n{text}"))
        }
        "html" => {
            let page = text.split("src=\"").nth(1).and_then(|rest| rest.split('#').next()).unwrap_or_default();
            (page.is_empty() || !read("xtask/src/page.rs").contains(page)).then(|| format!("no page {page}"))
        }
        // Logs, which are read; answers, which `answers_quoted_by_a_guide_are_printed` compares; and lists of files.
        "text" if text.contains("fired_us") => {
            write("firings.csv", text);
            eeruf("diagnose firings.csv")
        }
        "text" if text.contains("recommended: ") || document.ends_with("dataset.md") => None,
        _ => Some(format!("a listing in `{language}` that no test holds:\n{text}")),
    };
    wrong.into_iter().collect()
}

#[test]
fn every_listing_of_readme_and_guides_is_compiled_or_run() {
    let mut wrong = String::new();
    let mut held = 0;
    for document in documents() {
        let folder = folder_of_a_reader(&document);
        for listing in listings(&document) {
            held += 1;
            for error in check(&listing, folder.path()) {
                wrong += &format!("\n{document}: {error}");
            }
        }
    }
    assert!(held >= 75, "{held}");
    assert!(wrong.is_empty(), "{wrong}");
}
