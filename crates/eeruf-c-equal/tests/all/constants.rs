//! Times of an HC-SR04 in C and MicroPython, which must equal those of the Rust driver.

use eeruf_hc_sr04::{Settings, modules::HC_SR04};

const HEADER: &str = include_str!("../../../../c/eeruf.h");
const PYTHON: &str = include_str!("../../../../c/micropython/eeruf.py");

#[test]
fn times_of_an_hc_sr04_are_alike_in_all_languages() {
    assert_eq!(Settings::of(&HC_SR04), Some(Settings::default()));
    let Settings { trigger, deaf, shortest, latest_rise, longest, longest_hold, min_retrigger, missing_after, .. } =
        Settings::default();
    let us = [deaf, shortest, latest_rise, longest, longest_hold, min_retrigger, trigger].map(|time| time.as_micros());
    let [deaf, shortest, latest_rise, longest, longest_hold, min_retrigger, trigger] = us;
    let edges = format!("{deaf}, {shortest}, {latest_rise}");
    let times = format!("{edges}, {longest}, {longest_hold}, {min_retrigger}, {missing_after}, {trigger}");
    let macro_line = format!("#define EERUF_HC_SR04 {{EERUF_VERSION, {times}}}");
    assert!(HEADER.lines().any(|line| line.starts_with(&macro_line)), "{macro_line}");
    let first = format!("{deaf}, {shortest}, {longest}");
    for line in [
        format!("DEAF_US, SHORTEST_US, LONGEST_US, MIN_RETRIGGER_US, TRIGGER_US = {first}, {min_retrigger}, {trigger}"),
        format!("LATEST_RISE_US, LONGEST_HOLD_US, RECOVERY_US = {latest_rise}, {longest_hold}, "),
    ] {
        assert!(PYTHON.lines().any(|text| text.trim_start().starts_with(&line)), "{line}");
    }
}
