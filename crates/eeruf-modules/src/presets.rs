//! The presets. The source of each figure is in docs/reference/modules.md.

use crate::module::{Beam, CLONE_HOLDS_US, Gain, Interface, Module, NoEcho};

/// Returns the preset of this name. Case does not matter, and `_` may stand for `-`.
pub fn find(name: &str) -> Option<&'static Module> {
    let plain = |byte: u8| if byte == b'_' { b'-' } else { byte.to_ascii_lowercase() };
    let same = |known: &str| known.len() == name.len() && known.bytes().eq(name.bytes().map(plain));
    PRESETS.into_iter().find(|module| same(module.name))
}

/// Returns the names of the presets.
pub fn names() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|module| module.name)
}

/// Polaroid 6500.
pub const POLAROID_6500: Module = Module {
    name: "polaroid-6500",
    sees_to_mm: 10_700,
    hears_to_mm: 12_570,
    blanking_us: 2_380,
    frequency_hz: 49_400,
    bandwidth_hz: 3_088,
    burst_cycles: 16,
    gain: Gain::Constant,
    radius_um: 19_200,
    beam: Beam::CutAt90,
    no_echo: NoEcho::Silent,
    rest_us: 65_000,
    trigger_us: 0,
    interface: Interface::Edge,
    report_us: 0,
};

/// HC-SR04.
pub const HC_SR04: Module = Module {
    name: "hc-sr04",
    sees_to_mm: 4_000,
    hears_to_mm: 5_690,
    blanking_us: 117,
    frequency_hz: 40_000,
    bandwidth_hz: 5_000,
    burst_cycles: 8,
    gain: Gain::Constant,
    radius_um: 8_000,
    beam: Beam::Continuous,
    no_echo: NoEcho::Holds { us: 38_000 },
    rest_us: 60_000,
    trigger_us: 10,
    interface: Interface::PulseWidth,
    report_us: 0,
};

/// HC-SR04 clone that holds its line.
pub const HC_SR04_CLONE: Module =
    Module { name: "hc-sr04-clone", no_echo: NoEcho::Holds { us: CLONE_HOLDS_US }, rest_us: 210_000, ..HC_SR04 };

/// US-100, by its serial line.
pub const US_100: Module = Module {
    name: "us-100",
    sees_to_mm: 4_500,
    hears_to_mm: 6_260,
    blanking_us: 117,
    frequency_hz: 40_000,
    bandwidth_hz: 5_000,
    burst_cycles: 8,
    gain: Gain::Constant,
    radius_um: 8_000,
    beam: Beam::Continuous,
    no_echo: NoEcho::Reports,
    rest_us: 100_000,
    trigger_us: 1_042,
    interface: Interface::Uart,
    report_us: 100_000,
};

/// JSN-SR04T 3.0.
pub const JSN_SR04T: Module = Module {
    name: "jsn-sr04t",
    sees_to_mm: 6_000,
    hears_to_mm: 7_930,
    blanking_us: 1_166,
    frequency_hz: 40_000,
    bandwidth_hz: 5_000,
    burst_cycles: 8,
    gain: Gain::Constant,
    radius_um: 5_000,
    beam: Beam::CutAt90,
    no_echo: NoEcho::Holds { us: 60_000 },
    rest_us: 70_000,
    trigger_us: 10,
    interface: Interface::PulseWidth,
    report_us: 0,
};

/// A02YYUW.
pub const A02YYUW: Module = Module {
    name: "a02yyuw",
    sees_to_mm: 4_500,
    hears_to_mm: 6_260,
    blanking_us: 175,
    frequency_hz: 40_000,
    bandwidth_hz: 5_000,
    burst_cycles: 8,
    gain: Gain::Constant,
    radius_um: 6_000,
    beam: Beam::CutAt90,
    no_echo: NoEcho::Reports,
    rest_us: 100_000,
    trigger_us: 0,
    interface: Interface::Uart,
    report_us: 100_000,
};

/// PING))).
pub const PING: Module = Module {
    name: "ping",
    sees_to_mm: 3_000,
    hears_to_mm: 4_510,
    blanking_us: 115,
    frequency_hz: 40_000,
    bandwidth_hz: 5_000,
    burst_cycles: 8,
    gain: Gain::Constant,
    radius_um: 8_000,
    beam: Beam::Continuous,
    no_echo: NoEcho::Holds { us: 18_500 },
    rest_us: 19_455,
    trigger_us: 5,
    interface: Interface::OnePin,
    report_us: 0,
};

/// `MaxBotix` MB1010 (LV-MaxSonar-EZ1).
pub const MB1010: Module = Module {
    name: "mb1010",
    sees_to_mm: 6_450,
    hears_to_mm: 8_350,
    blanking_us: 888,
    frequency_hz: 42_000,
    bandwidth_hz: 3_231,
    burst_cycles: 13,
    gain: Gain::Linear,
    radius_um: 8_000,
    beam: Beam::Continuous,
    no_echo: NoEcho::Holds { us: 37_500 },
    rest_us: 50_000,
    trigger_us: 20,
    interface: Interface::PulseWidth,
    report_us: 0,
};

/// `MaxBotix` MB1242 (I2CXL-MaxSonar-EZ4).
pub const MB1242: Module = Module {
    name: "mb1242",
    sees_to_mm: 7_650,
    hears_to_mm: 9_630,
    blanking_us: 1_166,
    frequency_hz: 42_000,
    bandwidth_hz: 3_231,
    burst_cycles: 13,
    gain: Gain::Linear,
    radius_um: 8_000,
    beam: Beam::Continuous,
    no_echo: NoEcho::Reports,
    rest_us: 100_000,
    trigger_us: 0,
    interface: Interface::I2c,
    report_us: 80_000,
};

/// SRF08.
pub const SRF08: Module = Module {
    name: "srf08",
    sees_to_mm: 6_000,
    hears_to_mm: 7_930,
    blanking_us: 175,
    frequency_hz: 40_000,
    bandwidth_hz: 5_000,
    burst_cycles: 8,
    gain: Gain::Constant,
    radius_um: 8_000,
    beam: Beam::Continuous,
    no_echo: NoEcho::Reports,
    rest_us: 65_000,
    trigger_us: 0,
    interface: Interface::I2c,
    report_us: 65_000,
};

/// All presets.
pub const PRESETS: [&Module; 10] =
    [&POLAROID_6500, &HC_SR04, &HC_SR04_CLONE, &US_100, &JSN_SR04T, &A02YYUW, &PING, &MB1010, &MB1242, &SRF08];
