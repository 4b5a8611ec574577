//! Each rule broken in turn, in the engine that writes certificates and in the checker: a false certificate of a broken
//! engine is refused by the checker, and one that a broken checker accepts is refused by the checker in Python.

use eeruf_check::check;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A rule that refutes too much: what is replaced, file by file, in the engine and in the checker.
struct Broken {
    rule: &'static str,
    engine: [&'static str; 3],
    checker: [&'static str; 3],
}

/// The same change in both.
const fn alike(rule: &'static str, file: &'static str, from: &'static str, to: &'static str) -> Broken {
    Broken { rule, engine: [file, from, to], checker: [file, from, to] }
}

const BROKEN: [Broken; 14] = [
    alike("closure: a cycle of 0 is refuted", "bounds.rs", "self.at(j, i)) < 0", "self.at(j, i)) <= 0"),
    alike("window: a tick more", "state.rs", "merged.window[x]) - step", "merged.window[x]) - step - 2"),
    alike(
        "gap into the next phase: a tick more",
        "state.rs",
        "merged.gap[x][y]) - step",
        "merged.gap[x][y]) - step - 2",
    ),
    alike("stale echoes: a tick more", "state.rs", "{ half(x) }", "{ half(x) + 2 }"),
    alike(
        "orders: after a gap that just fits",
        "rules.rs",
        "event(y, phase)) < 2 * merged.gap[x][y]",
        "event(y, phase)) <= 2 * merged.gap[x][y]",
    ),
    alike("orders: reversed in the same phase", "rules.rs", "merged, x, y, 1 - phase)?", "merged, x, y, phase)?"),
    alike("signs: a d that can just be positive", "rules.rs", "if most < low {", "if most <= low {"),
    alike("ranks: a |d| that can just be larger", "rules.rs", "+ merged.apart(x, y) {", "+ merged.apart(x, y) + 2 {"),
    alike("ranks: a separation too many", "rules.rs", "bound - 2 * (width - narrowest)", "bound - 2 * width"),
    alike(
        "spacing: an interval that just has room",
        "rules.rs",
        "(width - narrowest) > high",
        "(width - narrowest) >= high",
    ),
    alike(
        "precedence: a separation too many",
        "rules.rs",
        "threshold) - 2 * (width - narrowest)",
        "threshold) - 2 * width",
    ),
    Broken {
        rule: "branching: a d of 0 is left out",
        engine: ["branching.rs", "if case == 0 { 0 }", "if case == 0 { -2 }"],
        checker: ["tree.rs", "if case == 0 { 0 }", "if case == 0 { -2 }"],
    },
    Broken {
        rule: "symmetry: another separation",
        engine: ["symmetry.rs", "problem.separation[x] == problem.separation[image[x]] && ", ""],
        checker: ["symmetry.rs", "problem.separation[x] == problem.separation[image[x]] && ", ""],
    },
    Broken {
        rule: "symmetry: other gaps",
        engine: [
            "symmetry.rs",
            "(0..sensors).all(|x| alike(x) && (0..sensors).all(|y| same_gap(x, y)))",
            "(0..sensors).all(alike)",
        ],
        checker: [
            "symmetry.rs",
            "if table[x * sensors + y] != table[image[x] * sensors + image[y]] {",
            "if sensors == 0 {",
        ],
    },
];

/// Writes false certificates into the folder that is its argument: that no period is below one tick more than the
/// shortest.
const WRITER: &str = "
mod common;
mod engine;

use common::{Random, feasible, random_problem};
use engine::{Claim, prove::prove};

fn main() {
    let folder = std::env::args().nth(1).expect(\"a folder\");
    for seed in 0..400 {
        let problem = random_problem(&mut Random(seed + 1));
        let most = if problem.sensors() <= 3 { 10 } else { 7 };
        let Some(shortest) = (1..most).find(|&period| feasible(&problem, period).is_some()) else { continue };
        let period = shortest + 1;
        let Some(fire) = feasible(&problem, period) else { continue };
        if let Ok(text) = prove(&Claim { problem, period, fire, bound: period }, 2_000) {
            std::fs::write(format!(\"{folder}/{seed}.cert\"), text).expect(\"it can be written\");
        }
    }
}
";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn write(path: &Path, text: &str) {
    std::fs::write(path, text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}

/// A folder of this test, empty.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mutations").join(name);
    _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("the folder can be made");
    folder
}

/// Copies a folder of sources; one file gets one text in place of another.
fn copy(from: &Path, to: &Path, [file, old, new]: [&str; 3]) {
    std::fs::create_dir_all(to).expect("the folder can be made");
    for entry in std::fs::read_dir(from).expect("a folder") {
        let path = entry.expect("an entry").path();
        let target = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy(&path, &target, ["", "", ""]);
            continue;
        }
        let mut text = read(&path);
        if !file.is_empty() && path.ends_with(file) {
            assert_eq!(text.matches(old).count(), 1, "{}: {old}", path.display());
            text = text.replace(old, new);
        }
        write(&target, &text);
    }
}

fn rustc(arguments: &[&str]) {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let done = Command::new(rustc).args(["--edition", "2024", "--cap-lints", "allow"]).args(arguments).output();
    let done = done.expect("rustc runs");
    assert!(done.status.success(), "{arguments:?}\n{}", String::from_utf8_lossy(&done.stderr));
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}

/// The false certificates of an engine with one text replaced.
fn false_certificates(name: &str, change: [&str; 3]) -> Vec<(PathBuf, String)> {
    let folder = folder(name);
    copy(&root().join("crates/eeruf-period/src/engine"), &folder.join("engine"), change);
    let tests = read(&root().join("crates/eeruf-period/tests/common/mod.rs")).replace("eeruf_period::", "crate::");
    // Without what reads certificates and the table.
    let from = tests.find("/// The claim of a certificate").expect("it converts");
    let to = tests.find("/// A small generator").expect("it has a generator");
    let table = tests.find("/// The claims of tests/data").expect("it reads the table");
    write(&folder.join("common.rs"), &format!("{}{}", &tests[..from], &tests[to..table]));
    write(&folder.join("main.rs"), &WRITER.replace("mod common;", "mod common;\n#[path = \"engine/mod.rs\"]"));
    let writer = folder.join("writer");
    rustc(&["-C", "opt-level=1", "-o", text(&writer), text(&folder.join("main.rs"))]);
    let certificates = folder.join("certificates");
    std::fs::create_dir_all(&certificates).expect("the folder can be made");
    let done = Command::new(writer).arg(&certificates).output().expect("the writer runs");
    assert!(done.status.success(), "{name}: {}", String::from_utf8_lossy(&done.stderr));
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(certificates).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    files.sort_unstable();
    files.into_iter().map(|file| (file.clone(), read(&file))).collect()
}

/// The checker's program with one text replaced.
fn checker(name: &str, change: [&str; 3]) -> PathBuf {
    let folder = folder(name);
    copy(&root().join("crates/eeruf-check/src"), &folder, change);
    let library = folder.join("libeeruf_check.rlib");
    let of = |file: &str| text(&folder.join(file)).to_owned();
    rustc(&["--crate-name", "eeruf_check", "--crate-type", "lib", "-o", text(&library), &of("lib.rs")]);
    rustc(&["--extern", &format!("eeruf_check={}", text(&library)), "-o", &of("checker"), &of("main.rs")]);
    folder.join("checker")
}

#[test]
fn whole_engine_writes_no_false_certificate() {
    assert!(false_certificates("whole", ["", "", ""]).is_empty());
}

#[test]
fn broken_rules_are_noticed_by_the_other_programs() {
    for (number, Broken { rule, engine, checker: change }) in BROKEN.iter().enumerate() {
        let certificates = false_certificates(&format!("engine-{number}"), *engine);
        assert!(!certificates.is_empty(), "{rule}: the engine proves nothing false");
        for (file, certificate) in &certificates {
            assert!(check(certificate).is_err(), "{rule}: {}: accepted", file.display());
        }
        let broken = checker(&format!("checker-{number}"), *change);
        let accepts = |program: &mut Command| program.output().expect("the checker runs").status.success();
        let accepted: Vec<_> =
            certificates.iter().filter(|(file, _)| accepts(Command::new(&broken).arg(file))).take(5).collect();
        assert!(!accepted.is_empty(), "{rule}: the broken checker accepts nothing false");
        for (file, _) in &accepted {
            let mut python = Command::new("python3");
            python.arg(root().join("checker/check_period.py")).arg(file);
            assert!(!accepts(&mut python), "{rule}: {}: accepted in Python", file.display());
        }
        println!("{rule}: {} false certificates", certificates.len());
    }
}
