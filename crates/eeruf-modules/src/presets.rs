//! The presets, with the source of each of their figures.

use crate::module::{Beam, CLONE_HOLDS_US, Gain, Interface, Module, NoEcho};

/// The source of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A document that gives the figure, and its words.
    Document(&'static str),
    /// Our own choice, and the reason.
    Choice(&'static str),
}

/// A known module, with the sources of its figures.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// The module.
    pub module: &'static Module,
    /// The name as its maker writes it.
    pub title: &'static str,
    /// The source of each figure, under the figure's name in files.
    pub sources: &'static [(&'static [&'static str], Source)],
}

impl Preset {
    /// Returns the source of a figure, by its name in files.
    pub fn source(&self, key: &str) -> Option<Source> {
        self.sources.iter().find(|(keys, _)| keys.contains(&key)).map(|&(_, source)| source)
    }
}

/// Returns the preset of this name. Case does not matter, and `_` may stand for `-`.
pub fn find(name: &str) -> Option<&'static Module> {
    let plain = |byte: u8| if byte == b'_' { b'-' } else { byte.to_ascii_lowercase() };
    let same = |known: &str| known.len() == name.len() && known.bytes().eq(name.bytes().map(plain));
    PRESETS.iter().map(|preset| preset.module).find(|module| same(module.name))
}

/// Returns the names of the presets.
pub fn names() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|preset| preset.module.name)
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
pub const HC_SR04_CLONE: Module = Module {
    name: "hc-sr04-clone",
    sees_to_mm: 4_000,
    hears_to_mm: 5_690,
    blanking_us: 117,
    frequency_hz: 40_000,
    bandwidth_hz: 5_000,
    burst_cycles: 8,
    gain: Gain::Constant,
    radius_um: 8_000,
    beam: Beam::Continuous,
    no_echo: NoEcho::Holds { us: CLONE_HOLDS_US },
    rest_us: 210_000,
    trigger_us: 10,
    interface: Interface::PulseWidth,
    report_us: 0,
};

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

use Source::{Choice, Document};

/// All presets.
pub const PRESETS: [Preset; 10] = [
    Preset {
        module: &POLAROID_6500,
        title: "Polaroid 6500",
        sources: &[
            (
                &["sees_to_m"],
                Document("6500 Series Sonar Ranging Module, Technical Specifications (Polaroid): 6 in to 35 ft"),
            ),
            (&["hears_to_m"], Choice("five sigma of 1.5 dB of fading over its farthest range, in air of 20 degrees")),
            (
                &["blanking_us"],
                Document("SN28827 and 6500 described in comp.robotics, 7 September 1993: blanked for 2.38 ms"),
            ),
            (
                &["frequency_hz", "burst_cycles"],
                Document(
                    "6500 Series Sonar Ranging Module, Technical Specifications (Polaroid): 16 cycles at 49.4 kHz",
                ),
            ),
            (&["bandwidth_hz"], Choice("as wide as its burst, frequency / cycles: 3.9 dB down at the edges")),
            (&["gain"], Choice("as in the documents' tables; polaroid_6500, its steps, is nearer to it")),
            (&["radius_mm"], Choice("ka = 17.4, so that the first null is at 12.8 degrees")),
            (&["beam"], Choice("as if in an endless baffle")),
            (
                &["no_echo", "trigger_us", "interface"],
                Document("comp.robotics, 7 September 1993: INIT is a level; ECHO rises with the echo, falls with INIT"),
            ),
            (&["rest_us"], Choice("a wall at its farthest range is heard after 62.4 ms")),
            (&["report_us"], Choice("the line rises with the echo")),
            (&["hold_us"], Choice("it holds no line")),
        ],
    },
    Preset {
        module: &HC_SR04,
        title: "HC-SR04",
        sources: &[
            (
                &["sees_to_m", "blanking_us", "trigger_us", "interface"],
                Document("HC-SR04 (SparkFun): 2 cm to 4 m, 10 us trigger, a pulse as wide as the echo time"),
            ),
            (&["hears_to_m"], Choice("five sigma of 1.5 dB of fading over its farthest range, in air of 20 degrees")),
            (&["frequency_hz", "burst_cycles"], Document("HC-SR04 (SparkFun): 8 cycles of 40 kHz")),
            (&["bandwidth_hz"], Choice("as wide as its burst, frequency / cycles: 3.9 dB down at the edges")),
            (&["gain"], Document("Making a better HC-SR04 Echo Locator (2014): two amplifiers of fixed gain")),
            (&["radius_mm"], Choice("an open can of 16 mm")),
            (&["beam"], Choice("its can stands free on a board")),
            (
                &["no_echo", "hold_us"],
                Document("Simple range finder using HC-SR04 (BuildCircuit): 38 ms high without an obstacle"),
            ),
            (&["rest_us"], Document("HC-SR04 (SparkFun): a cycle of over 60 ms is suggested")),
            (&["report_us"], Choice("the pulse ends with the echo")),
        ],
    },
    Preset {
        module: &HC_SR04_CLONE,
        title: "HC-SR04 clone that holds its line",
        sources: &[
            (
                &["sees_to_m", "blanking_us", "frequency_hz", "burst_cycles", "trigger_us", "interface"],
                Choice("as the HC-SR04"),
            ),
            (&["hears_to_m"], Choice("five sigma of 1.5 dB of fading over its farthest range, in air of 20 degrees")),
            (&["bandwidth_hz"], Choice("as wide as its burst, frequency / cycles: 3.9 dB down at the edges")),
            (&["gain"], Choice("as the HC-SR04")),
            (&["radius_mm"], Choice("an open can of 16 mm")),
            (&["beam"], Choice("its can stands free on a board")),
            (
                &["no_echo", "hold_us"],
                Document("a robot's published firmware: some clones hold ECHO high some 200 ms after a lost echo"),
            ),
            (&["rest_us"], Choice("a trigger while the line is held is lost")),
            (&["report_us"], Choice("the pulse ends with the echo")),
        ],
    },
    Preset {
        module: &US_100,
        title: "US-100, by its serial line",
        sources: &[
            (
                &["sees_to_m", "blanking_us", "interface"],
                Document(
                    "US-100 with RT-Thread MicroPython (cnblogs 9486575): 2 cm to 4.5 m; 9600 baud with the jumper set",
                ),
            ),
            (&["hears_to_m"], Choice("five sigma of 1.5 dB of fading over its farthest range, in air of 20 degrees")),
            (&["frequency_hz", "burst_cycles"], Choice("as the HC-SR04")),
            (&["bandwidth_hz"], Choice("as wide as its burst, frequency / cycles: 3.9 dB down at the edges")),
            (&["gain"], Choice("as the HC-SR04")),
            (&["radius_mm"], Choice("an open can of 16 mm")),
            (&["beam"], Choice("its can stands free on a board")),
            (&["no_echo"], Choice("a distance beyond its range")),
            (&["hold_us"], Choice("it holds no line")),
            (
                &["rest_us", "report_us"],
                Document("adafruit_us100 API Reference: a reading always blocks for at least 100 ms"),
            ),
            (
                &["trigger_us"],
                Document("US-100 with RT-Thread MicroPython (cnblogs 9486575): the byte 0x55 at 9600 baud"),
            ),
        ],
    },
    Preset {
        module: &JSN_SR04T,
        title: "JSN-SR04T 3.0",
        sources: &[
            (&["sees_to_m", "blanking_us"], Document("JSN-SR04T Version 3 (androegg): 20 to 600 cm")),
            (&["hears_to_m"], Choice("five sigma of 1.5 dB of fading over its farthest range, in air of 20 degrees")),
            (
                &["frequency_hz", "burst_cycles", "trigger_us", "interface"],
                Document("JSN-SR04T (qariya): 8 cycles of 40 kHz, 10 us trigger, a pulse as wide as the echo time"),
            ),
            (&["bandwidth_hz"], Choice("as wide as its burst, frequency / cycles: 3.9 dB down at the edges")),
            (&["gain"], Choice("nothing is published")),
            (
                &["radius_mm"],
                Document("JSN-SR04T-3.0 (alichecker 4000302883856): -6 dB at 75 degrees, which is ka = 3.64"),
            ),
            (&["beam"], Choice("its probe sits in a bumper")),
            (&["no_echo", "hold_us"], Document("JSN-SR04T (qariya): ECHO falls after 60 ms without an echo")),
            (&["rest_us"], Choice("after its line has fallen")),
            (&["report_us"], Choice("the pulse ends with the echo")),
        ],
    },
    Preset {
        module: &A02YYUW,
        title: "A02YYUW",
        sources: &[
            (
                &["sees_to_m", "blanking_us", "frequency_hz", "interface"],
                Document("A02YYUW, SKU SEN0311 (DFRobot wiki): 3 to 450 cm, 40 kHz, 9600 baud"),
            ),
            (&["hears_to_m"], Choice("five sigma of 1.5 dB of fading over its farthest range, in air of 20 degrees")),
            (&["burst_cycles"], Choice("as the HC-SR04")),
            (&["bandwidth_hz"], Choice("as wide as its burst, frequency / cycles: 3.9 dB down at the edges")),
            (&["gain"], Choice("nothing is published")),
            (
                &["radius_mm"],
                Document(
                    "A02YYUW, SKU SEN0311 (DFRobot wiki): an angle of 60 degrees, taken for -6 dB, which is ka = 4.43",
                ),
            ),
            (&["beam"], Choice("its probe sits in a bumper")),
            (&["no_echo"], Choice("a distance beyond its range")),
            (&["hold_us"], Choice("it holds no line")),
            (
                &["rest_us", "report_us"],
                Document("A02YYUW, SKU SEN0311 (DFRobot wiki): a value every 100 ms where RX is low"),
            ),
            (&["trigger_us"], Choice("it runs freely")),
        ],
    },
    Preset {
        module: &PING,
        title: "PING)))",
        sources: &[
            (&["sees_to_m"], Document("PING))) Ultrasonic Distance Sensor (28015) v2.0 (Parallax): 2 cm to 3 m")),
            (&["hears_to_m"], Choice("five sigma of 1.5 dB of fading over its farthest range, in air of 20 degrees")),
            (
                &["blanking_us", "no_echo", "hold_us"],
                Document("PING))) (28015) v2.0 (Parallax): pulses of 115 us to 18.5 ms"),
            ),
            (&["frequency_hz", "burst_cycles"], Document("PING))) (28015) v2.0 (Parallax): 200 us of 40 kHz")),
            (&["bandwidth_hz"], Choice("as wide as its burst, frequency / cycles: 3.9 dB down at the edges")),
            (&["gain"], Choice("nothing is published")),
            (&["radius_mm"], Choice("an open can of 16 mm")),
            (&["beam"], Choice("its can stands free on a board")),
            (
                &["rest_us"],
                Document("PING))) (28015) v2.0 (Parallax): 5 us, holdoff 750 us, pulse 18.5 ms, delay 200 us"),
            ),
            (
                &["trigger_us", "interface"],
                Document("PING))) (28015) v2.0 (Parallax): a trigger of 5 us on the pin that answers"),
            ),
            (&["report_us"], Choice("the pulse ends with the echo")),
        ],
    },
    Preset {
        module: &MB1010,
        title: "MaxBotix MB1010 (LV-MaxSonar-EZ1)",
        sources: &[
            (
                &["sees_to_m", "blanking_us"],
                Document("LV-MaxSonar-EZ1 Data Sheet (MaxBotix): 6 to 254 in; what is nearer is reported as 6 in"),
            ),
            (&["hears_to_m"], Choice("five sigma of 1.5 dB of fading over its farthest range, in air of 20 degrees")),
            (
                &["frequency_hz", "burst_cycles"],
                Document("LV-MaxSonar-EZ, timing (MaxBotix): thirteen waves of 42 kHz"),
            ),
            (&["bandwidth_hz"], Choice("as wide as its burst, frequency / cycles: 3.9 dB down at the edges")),
            (&["gain"], Choice("the sheet says continuously variable")),
            (&["radius_mm"], Choice("an open can of 16 mm")),
            (&["beam"], Choice("its can stands free on a board")),
            (
                &["no_echo", "hold_us"],
                Document("LV-MaxSonar-EZ, timing (MaxBotix): PW is high for up to 37.5 ms where there is no target"),
            ),
            (&["rest_us"], Document("LV-MaxSonar-EZ1 Data Sheet (MaxBotix): a reading every 50 ms")),
            (
                &["trigger_us", "interface"],
                Document("LV-MaxSonar-EZ1 Data Sheet (MaxBotix): RX high for 20 us; PW, beside analog and serial"),
            ),
            (&["report_us"], Choice("the pulse ends with the echo")),
        ],
    },
    Preset {
        module: &MB1242,
        title: "MaxBotix MB1242 (I2CXL-MaxSonar-EZ4)",
        sources: &[
            (
                &["sees_to_m", "blanking_us", "frequency_hz", "interface"],
                Document("I2CXL-MaxSonar-EZ Datasheet (MaxBotix): from 20 cm to 765 cm, 42 kHz, I2C"),
            ),
            (&["hears_to_m"], Choice("five sigma of 1.5 dB of fading over its farthest range, in air of 20 degrees")),
            (&["burst_cycles"], Choice("as the MB1010")),
            (&["bandwidth_hz"], Choice("as wide as its burst, frequency / cycles: 3.9 dB down at the edges")),
            (&["gain"], Choice("the sheet says continuously variable")),
            (&["radius_mm"], Choice("an open can of 16 mm")),
            (&["beam"], Choice("its can stands free on a board")),
            (&["no_echo"], Choice("a value")),
            (&["hold_us"], Choice("it holds no line")),
            (
                &["rest_us", "report_us"],
                Document("I2CXL-MaxSonar-EZ Datasheet (MaxBotix): 100 ms between readings, read after 80 ms"),
            ),
            (&["trigger_us"], Document("I2CXL-MaxSonar-EZ Datasheet (MaxBotix): a command byte")),
        ],
    },
    Preset {
        module: &SRF08,
        title: "SRF08",
        sources: &[
            (
                &["sees_to_m", "rest_us"],
                Document("SRF08 Technical Specification (Devantech): up to 6 m, every 65 ms or slower"),
            ),
            (&["hears_to_m"], Choice("five sigma of 1.5 dB of fading over its farthest range, in air of 20 degrees")),
            (&["blanking_us"], Choice("3 cm")),
            (&["frequency_hz", "burst_cycles"], Choice("as its forerunner, the SRF04: 8 cycles of 40 kHz")),
            (&["bandwidth_hz"], Choice("as wide as its burst, frequency / cycles: 3.9 dB down at the edges")),
            (&["gain"], Choice("the sheet has it grow up to 390 mm and stay")),
            (&["radius_mm"], Choice("an open can of 16 mm")),
            (&["beam"], Choice("its can stands free on a board")),
            (
                &["no_echo", "interface", "trigger_us", "report_us"],
                Document("SRF08 Technical Specification (Devantech): a command over I2C, 65 ms of ranging, 0 for none"),
            ),
            (&["hold_us"], Choice("it holds no line")),
        ],
    },
];
