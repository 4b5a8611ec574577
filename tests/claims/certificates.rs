//! Whoever doubts a period that `eeruf design` calls the shortest has it checked by two programs that share nothing
//! with the search, nor with each other.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{Scratch, eeruf};

/// What the checker in Python says of a certificate: its exit code and what it prints.
fn python(certificate: &Path) -> (Option<i32>, String) {
    let checked =
        Command::new("python3").arg("checker/check_period.py").arg(certificate).output().expect("python3 runs");
    (checked.status.code(), String::from_utf8_lossy(&checked.stdout).trim().to_owned())
}

#[test]
fn both_checkers_accept_the_certificates_of_design() {
    let (_scratch, file) = Scratch::new("ring.cert", "");
    for (ring, says) in [
        ("rings/hc-sr04-8.toml", "63000 us is the shortest period"),
        ("rings/paper-12.toml", "65000 us is the shortest period"),
        ("rings/labmate-8.toml", "48300 us is the shortest period"),
    ] {
        let outcome = eeruf(&["design", ring, "--json", "--certificate", &file.display().to_string()]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.err);
        assert!(outcome.err.contains(says), "{}", outcome.err);
        let text = fs::read_to_string(&file).expect("the certificate is written");
        let certified = eeruf_check::check(&text).expect("the checker in Rust accepts it").to_string();
        assert!(certified.starts_with(says), "{certified}");
        assert_eq!(python(&file), (Some(0), certified));
    }
}

#[test]
fn both_checkers_refuse_a_certificate_for_a_period_that_is_not_the_shortest() {
    let (_scratch, file) = Scratch::new("ring.cert", "");
    let outcome = eeruf(&["design", "rings/paper-12.toml", "--json", "--certificate", &file.display().to_string()]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.err);
    let text = fs::read_to_string(&file).expect("the certificate is written");
    // The schedule serves at a longer period as well, which is then not the shortest.
    let longer =
        text.replace("\nperiod 65\n", "\nperiod 66\n").replace("\nno_period_below 65\n", "\nno_period_below 66\n");
    assert_ne!(longer, text);
    fs::write(&file, &longer).expect("the folder can be written to");
    assert!(eeruf_check::check(&longer).is_err());
    assert_eq!(python(&file).0, Some(1));
}

#[test]
fn a_proof_that_is_given_too_few_nodes_is_not_written_and_the_answer_is_no() {
    let (_scratch, file) = Scratch::new("ring.cert", "");
    let certificate = file.display().to_string();
    let asked = ["design", "rings/paper-12.toml", "--json", "--certificate", &certificate, "--certificate-budget", "1"];
    let outcome = eeruf(&asked);
    assert_eq!(outcome.code, Some(1), "{}", outcome.err);
    assert!(outcome.err.contains("--certificate-budget"), "{}", outcome.err);
    assert_eq!(fs::read_to_string(&file).expect("it was there before"), "");
}
