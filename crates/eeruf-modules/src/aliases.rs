//! Names of modules that are not presets: some behave like a preset, others cannot be fired in a ring.

use crate::module::Module;
use crate::presets::{HC_SR04, JSN_SR04T, MB1010, MB1242, PING, POLAROID_6500, find};

/// Modules that trigger, answer and rest like a preset, under their common names.
const LIKE: [(&[&str], &Module); 6] = [
    // Versions for 3.3 V and boards with the same protocol: a trigger of 10 us, then the echo pulse.
    (
        &[
            "hcsr04",
            "sr04",
            "hc-sr04p",
            "hcsr04p",
            "hc-sr04+",
            "hc-sr05",
            "srf05",
            "hy-srf05",
            "us-015",
            "us-020",
            "rcwl-1601",
            "rcwl1601",
        ],
        &HC_SR04,
    ),
    // These answer like the preset in their factory mode.
    (&["jsnsr04t", "jsn-sr04", "jsn-sr04t-2.0", "jsn-sr04m", "aj-sr04m", "ajsr04m", "sr04t"], &JSN_SR04T),
    (&["ping)))", "parallax-ping", "28015"], &PING),
    (&["lv-ez1", "lv-maxsonar", "maxsonar", "mb1000", "mb1020", "mb1030", "mb1040"], &MB1010),
    (&["i2cxl", "mb1202", "mb1212", "mb1222", "mb1232"], &MB1242),
    (&["polaroid", "6500", "senscomp", "senscomp-6500"], &POLAROID_6500),
];

/// Modules that a ring cannot fire, or only with help, and the alternative.
const OTHER: [(&[&str], &str); 3] = [
    (
        &["me007ys", "a01nyub", "a0221", "dyp-a02", "sen0208", "mb1240", "mb7389", "urm37", "urm09"],
        "fires by a clock of its own; if a line or a command triggers it, describe that, as { like = \"us-100\", .. }",
    ),
    (
        &["srf02", "srf10", "srf235"],
        "is fired by a command on I2C as the srf08 is; say { like = \"srf08\", .. } and what differs",
    ),
    (
        &["vl53l0x", "vl53l1x", "tfmini", "tf-luna", "lidar", "sharp", "gp2y0a21"],
        "sends light, which no other hears as sound",
    ),
];

fn is(known: &[&str], name: &str) -> bool {
    let plain = |byte: u8| if byte == b'_' || byte == b' ' { b'-' } else { byte.to_ascii_lowercase() };
    known.iter().any(|known| known.bytes().eq(name.bytes().map(plain)))
}

/// Returns the preset that a module behaves like; `None` for the name of a preset itself. Tell the user about it.
///
/// ```
/// assert_eq!(eeruf_modules::like("HCSR04").map(|module| module.name), Some("hc-sr04"));
/// assert!(eeruf_modules::like("hc-sr04").is_none(), "it is one");
/// ```
pub fn like(name: &str) -> Option<&'static Module> {
    if find(name).is_some() {
        return None;
    }
    LIKE.iter().find(|(known, _)| is(known, name)).map(|&(_, module)| module)
}

/// Returns an explanation for a module that is unlike any preset.
pub(crate) fn why_not(name: &str) -> Option<&'static str> {
    OTHER.iter().find(|(known, _)| is(known, name)).map(|&(_, why)| why)
}
