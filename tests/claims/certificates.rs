//! A period that `eeruf design` calls the shortest is checked by a program that shares no code with the search.

use std::fs;
use std::path::Path;
use std::process::Command;

use eeruf_design::certificate::Stated;

use crate::common::{Scratch, eeruf};

/// Runs the checker on a certificate: its exit code and its output.
fn python(certificate: &Path) -> (Option<i32>, String) {
    let checked =
        Command::new("python3").arg("checker/check_period.py").arg(certificate).output().expect("python3 runs");
    (checked.status.code(), String::from_utf8_lossy(&checked.stdout).trim().to_owned())
}

/// The claim of a certificate.
fn stated(certificate: &Path) -> Stated {
    Stated::read(&fs::read_to_string(certificate).expect("the certificate is written")).expect("a claim")
}

#[test]
fn checker_accepts_the_certificates_of_design() {
    let (_scratch, file) = Scratch::new("ring.cert", "");
    for (ring, says) in [
        ("rings/hc-sr04-8.toml", "67500 us is the shortest period"),
        ("rings/paper-12.toml", "65000 us is the shortest period"),
        ("rings/labmate-8.toml", "48300 us is the shortest period"),
    ] {
        let outcome = eeruf(&["design", "--period-only", ring, "--json", "--certificate", &file.display().to_string()]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.err);
        assert!(outcome.err.contains(says), "{}", outcome.err);
        let (code, certified) = python(&file);
        assert!(code == Some(0) && certified.starts_with(says), "{certified}");
        assert!(outcome.err.contains(&certified), "{}", outcome.err);
    }
}

// The checker refuses a certificate for a period that is not the shortest.
#[test]
fn checker_refuses_a_longer_period() {
    let (_scratch, file) = Scratch::new("ring.cert", "");
    let outcome = eeruf(&[
        "design",
        "--period-only",
        "rings/paper-12.toml",
        "--json",
        "--certificate",
        &file.display().to_string(),
    ]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.err);
    let text = fs::read_to_string(&file).expect("the certificate is written");
    // The schedule serves at a longer period as well, which is then not the shortest.
    let longer =
        text.replace("\nperiod 65\n", "\nperiod 66\n").replace("\nno_period_below 65\n", "\nno_period_below 66\n");
    assert_ne!(longer, text);
    fs::write(&file, &longer).expect("the folder can be written to");
    assert_eq!(python(&file).0, Some(1));
}

// A proof that is given too few nodes certifies a lower bound and says what a longer one would.
#[test]
fn short_proof_certifies_a_lower_bound() {
    let ring = "sensors = 12\nt_delta_us = 999\nmin_interval_us = 15_000\nwindow_us = 45_000\n";
    let (_scratch, ring) = Scratch::new("ring.toml", ring);
    let file = ring.with_extension("cert");
    let [ring, certificate] = [&ring, &file].map(|path| path.display().to_string());
    let asked =
        ["design", "--period-only", &ring, "--json", "--certificate", &certificate, "--certificate-budget", "16"];
    let outcome = eeruf(&asked);
    assert_eq!(outcome.code, Some(0), "{}", outcome.err);
    let (certified, rest) =
        outcome.err.split_once("; proven, not certified: a proof of 70 ms is longer").expect("it says so");
    assert!(certified.contains("no period below ") && certified.contains("schedule of 70000 us"), "{certified}");
    assert!(rest.contains("--certificate-budget"), "{rest}");
    assert_eq!(python(&file).0, Some(0));
    let bound = stated(&file).bound;
    assert!((50..70).contains(&bound), "{bound}");
}

// A time limit ends a search with a schedule a bound and its certificate.
#[test]
fn time_limit_ends_with_schedule_bound_and_certificate() {
    // Not proven within half a million nodes.
    let ring = "sensors = 11\nlayout = \"ring\"\nneighbours = 4\nt_delta_us = 999\nmin_interval_us = 15_000\n\
                window_us = 15_000\n";
    let (_scratch, file) = Scratch::new("ring.toml", ring);
    let certificate = file.with_extension("cert");
    let [ring_file, written] = [&file, &certificate].map(|path| path.display().to_string());
    let outcome =
        eeruf(&["design", "--period-only", &ring_file, "--json", "--time-limit", "0.2", "--certificate", &written]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.err);
    assert!(outcome.out.contains("\"proven\":false"), "{}", outcome.out);
    let stated = stated(&certificate);
    assert!(1 < stated.bound && stated.bound < stated.period, "{stated}");
    assert!(outcome.err.contains(&stated.to_string()), "{}", outcome.err);
    assert_eq!(python(&certificate), (Some(0), stated.to_string()));
    // As a robot with 64 sensors moves, its t_delta follows from the period; what was found so soon is too slow for it.
    let many = "sensors = 64\nlayout = \"ring\"\nneighbours = 6\njitter_us = 100\ncrosstalk_range_m = 2.0\n\
                max_range_m = 4.0\ntick_us = 100\nspeed_m_s = 1.0\n";
    fs::write(&file, many).expect("the folder can be written to");
    let outcome = eeruf(&["design", "--period-only", &ring_file, "--time-limit", "0.01"]);
    assert_eq!(outcome.code, Some(1), "{}", outcome.err);
    assert!(outcome.out.contains("the search ended before its proof"), "{}", outcome.out);
}

#[test]
fn a_time_limit_is_a_time() {
    for limit in ["0", "-1", "soon", "nan", "1e30"] {
        let outcome = eeruf(&["design", "--period-only", "rings/paper-12.toml", &format!("--time-limit={limit}")]);
        assert_eq!(outcome.code, Some(2), "{limit}");
        assert!(outcome.err.contains("expected seconds above 0"), "{}", outcome.err);
    }
}
