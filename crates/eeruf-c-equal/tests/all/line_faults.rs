//! Faults of one echo line, in Rust and in C: no free space without evidence, and the right state for each.

use std::collections::BTreeSet;

use eeruf_c_equal::Random;
use eeruf_c_equal::line_faults::{Fault, Faults, Outcome, Says, outcomes};

const FAULTS: &str = include_str!("../../../../tests/data/line-faults.txt");
const LANGUAGES: [&str; 2] = ["Rust", "C"];
const OUTCOMES: &str = "../../tests/data/line-fault-outcomes.txt";

/// Passes each fault's outcome in each language to a check.
fn each(mut check: impl FnMut(&str, &Fault, &Outcome)) {
    let faults = Faults::read(FAULTS);
    for fault in &faults.faults {
        for (language, outcome) in LANGUAGES.iter().zip(outcomes(&faults, fault, 0)) {
            check(language, fault, &outcome);
        }
    }
}

/// Number of readings after which the state must be right.
fn until_right(fault: &Fault) -> usize {
    match fault.says {
        // For 250 ms, three firings, the module may be a clone that has heard nothing.
        Says::Held => 3,
        // Each pulse is one silence, however many firings it outlasts.
        Says::Clear => fault.two_pulses(Faults::read(FAULTS).period_us).max(2),
        _ => 2,
    }
}

fn right(fault: &Fault, outcome: &Outcome) -> usize {
    outcome.faulty[until_right(fault)..].iter().filter(|said| said.is(fault.says)).count()
}

/// Number of readings that report free space without evidence, of both sensors if wires are exchanged.
fn lies(fault: &Fault, outcome: &Outcome) -> usize {
    let witnessed = if fault.says == Says::Clear { outcome.faulty.len() } else { 0 };
    outcome.faulty.iter().skip(witnessed).chain(&outcome.partner).filter(|said| said.is_clear()).count()
}

#[test]
fn faulty_line_is_never_clear_without_evidence() {
    each(|language, fault, outcome| {
        assert!(outcome.faulty.len() > 97, "{language}, {}", fault.name);
        assert_eq!(lies(fault, outcome), 0, "{language}, {}, before {}", fault.name, fault.before);
    });
}

#[test]
fn state_is_right_within_two_answered_firings() {
    each(|language, fault, outcome| {
        let after = &outcome.faulty[until_right(fault)..];
        let wrong = after.iter().find(|said| !said.is(fault.says));
        assert_eq!(wrong, None, "{language}, {}, before {}", fault.name, fault.before);
    });
}

// A clone that holds its line longer is as healthy as a module that holds it for 38 ms.
#[test]
fn healthy_module_is_well_and_clear_before_nothing() {
    let mut healthy = 0;
    each(|language, fault, outcome| {
        if fault.name == "healthy" || fault.name.starts_with("hold of") {
            healthy += 1;
            let after = &outcome.faulty[until_right(fault)..];
            let right = after.iter().filter(|said| said.is_well && said.is(fault.says)).count();
            assert!(100 * right >= 99 * after.len(), "{language}, {}: {right}", fault.name);
        }
    });
    assert_eq!(healthy, 5 * LANGUAGES.len());
}

// A sensor sees an obstacle, then its line sticks high at any time: the driver never reports free space.
#[test]
fn line_that_sticks_high_before_an_obstacle_is_never_clear() {
    let (faults, r) = (Faults::read(FAULTS), Random::new(1));
    let held = faults.faults.iter().find(|fault| fault.says == Says::Held).expect("a line that is held");
    for _ in 0..20 {
        let onset_us = 1_000_000 + r.within(0, 2_000_000);
        for (language, Outcome { faulty, .. }) in LANGUAGES.iter().zip(outcomes(&faults, held, onset_us)) {
            let clear = faulty.iter().filter(|said| said.is_clear()).count();
            assert_eq!(clear, 0, "{language}, from {onset_us} us on");
            assert!(faulty[9].is(Says::Obstacle(5_830)) && faulty[40].is(Says::Held), "{language}, {onset_us}");
        }
    }
}

#[test]
fn file_has_each_fault_that_the_ring_must_name() {
    let faults = Faults::read(FAULTS).faults;
    let names: BTreeSet<&str> = faults.iter().map(|fault| &*fault.name).collect();
    // In addition to holds of 38 ms, by a healthy module.
    let expected = [
        "cut wire",
        "exchanged, 1 ms apart",
        "exchanged, 20 ms apart",
        "forgotten call",
        "glitch high",
        "glitch high, cut wire",
        "glitch low",
        "healthy",
        "held for ever",
        "hold of 130 ms",
        "hold of 200 ms",
        "hold of 66 ms",
        "lost falling edge",
        "lost rising edge",
        "no power",
    ];
    assert_eq!(names, BTreeSet::from(expected));
}

/// The cells of a row of a table.
fn cells(line: &str) -> Vec<&str> {
    line.trim_matches('|').split('|').map(str::trim).collect()
}

/// Returns the document with the results in these languages in its table.
fn with_outcomes(document: &str) -> String {
    let head = document.lines().find(|line| line.starts_with("| fault")).map(cells).expect("a table of faults");
    let mut lines: Vec<String> = document.lines().map(str::to_owned).collect();
    each(|language, fault, outcome| {
        let column = head.iter().position(|name| *name == language).expect("a column for each language");
        let (fault_and_place, all) = ([&*fault.name, &*fault.before], outcome.faulty.len() - until_right(fault));
        let of_fault = |line: &&mut String| line.starts_with('|') && cells(line).starts_with(&fault_and_place);
        let line = lines.iter_mut().find(of_fault).unwrap_or_else(|| panic!("no row of {fault_and_place:?}"));
        let mut row = cells(line);
        let cell = format!("{} of {all}, {}", right(fault, outcome), lies(fault, outcome));
        row[column] = &cell;
        *line = format!("| {} |", row.join(" | "));
    });
    lines.join("\n") + "\n"
}

// EERUF_WRITE=1 rewrites the document.
#[test]
fn outcomes_are_what_rust_and_c_say() {
    let stands = std::fs::read_to_string(OUTCOMES).unwrap();
    let said = with_outcomes(&stands);
    if std::env::var_os("EERUF_WRITE").is_some() {
        std::fs::write(OUTCOMES, said).unwrap();
    } else {
        assert!(said == stands, "{OUTCOMES} is not what Rust and C say; EERUF_WRITE=1 writes it:\n{said}");
    }
}
