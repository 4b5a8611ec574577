//! `eeruf design --program`: its refusals, and the listings of README. `cargo xtask programs` builds and runs programs.

use crate::common::{Scratch, eeruf};

/// Checks that README's four lines are a ring file, that each language has its program, and that none overwrites
/// another.
#[test]
fn readme_goes_from_four_lines_to_a_program_in_each_language() {
    let readme = include_str!("../../README.md");
    let (_, rest) = readme.split_once("## From four lines to a program").unwrap();
    let ring = rest.split_once("```toml\n").and_then(|(_, rest)| rest.split_once("```")).unwrap().0;
    assert_eq!(ring.lines().count(), 4);
    let (folder, file) = Scratch::new("robot.toml", ring);
    let file = file.to_str().unwrap();
    for (language, main) in [
        ("arduino", "robot/robot.ino"),
        ("c", "c/sonar.c"),
        ("rust", "rust/src/lib.rs"),
        ("micropython", "micropython/main.py"),
        ("ros2", "ros2/eeruf.yaml"),
    ] {
        let out = folder.path().join(main.split('/').next().unwrap());
        let mut words = vec!["design", file, "--program", language, "--out", out.to_str().unwrap()];
        // The node fires by flow unasked.
        words.extend(if language == "ros2" { &[][..] } else { &["--way", "flow"] });
        let said = eeruf(&words);
        assert_eq!((said.code, said.out.contains("of a ring that fires by flow; ")), (Some(0), true), "{}", said.err);
        let text = std::fs::read_to_string(folder.path().join(main)).unwrap();
        let whole = std::fs::read_dir(&out).unwrap().count() >= 2 && !text.contains('@');
        assert!(whole, "{language}: a placeholder is left, or a file is missing:\n{text}");
        if language == "ros2" {
            let written = std::fs::read_to_string(out.join("ring.toml")).unwrap();
            assert_eq!(eeruf_design::RingSpec::in_file(&out, &written).unwrap().places.poses.len(), 8, "{written}");
        }
        let again = eeruf(&words);
        assert_eq!(again.code, Some(2));
        assert!(again.err.contains("it is there already; expected a new folder, by --out DIR"), "{}", again.err);
    }
}

#[test]
fn parameters_of_the_node_are_its_own() {
    let known = include_str!("../../crates/eeruf-ros2/config/eeruf.yaml");
    for line in include_str!("../../src/program/templates/eeruf.yaml").lines() {
        let key = line.trim().split(':').next().unwrap();
        assert!(line.trim().starts_with('#') || known.contains(&format!(" {key}:")) || key == "/**", "{line}");
    }
}

#[test]
fn programs_that_cannot_be_are_refused_by_what_is_expected() {
    for (ring, options, expected) in [
        ("rings/paper-12.toml", "arduino", "the ring file names no module; expected `module`"),
        ("rings/hc-sr04-8.toml", "rust --way flow --board uno", "--board uno: expected none"),
        (
            "rings/hc-sr04-8.toml",
            "micropython --way flow --board mega",
            "expected one that this program is written for: pico, esp32",
        ),
        (
            "rings/hc-sr04-8.toml",
            "micropython --way two-phases",
            "--way two-phases: expected --program arduino, c or rust",
        ),
        ("rings/hc-sr04-8.toml", "ros2 --way sequential", "--way sequential: expected flow"),
        ("rings/hc-sr04-8.toml", "micropython --way groups", "sensors that fire together"),
        ("tests/data/car-4.toml", "rust --mavlink", "--mavlink: expected --program arduino or c"),
        ("rings/hc-sr04-8.toml", "c --mavlink", "no places of sensors; expected poses"),
    ] {
        let words = format!("design {ring} --program {options}");
        let words: Vec<_> = words.split(' ').collect();
        let said = eeruf(&words);
        assert_eq!(said.code, Some(2), "{words:?}: {}", said.out);
        assert!(said.err.contains(expected), "{words:?}: {}", said.err);
    }
}
