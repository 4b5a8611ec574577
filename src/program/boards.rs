//! Boards, and the pins to which modules are wired by default.

use clap::ValueEnum;

/// A board that a program is written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Board {
    /// Arduino Uno or Nano with an `ATmega328P`: to 8 modules on two pins each, to 16 on one
    Uno,
    /// Arduino Mega 2560: to 24 modules
    Mega,
    /// Raspberry Pi Pico: to 13 modules
    Pico,
    /// ESP32: to 9 modules
    Esp32,
    /// Raspberry Pi with Linux: to 10 modules
    RaspberryPi,
}

/// The trigger pin and the echo pin of each module; the same pin if one wire serves both.
pub(crate) struct Wiring {
    pub(crate) triggers: Vec<u8>,
    pub(crate) echoes: Vec<u8>,
}

const UNO: [u8; 16] = [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17];
/// Pins of a Mega whose changes cause interrupts.
const MEGA_ECHOES: [u8; 24] =
    [10, 11, 12, 13, 50, 51, 52, 53, 62, 63, 64, 65, 66, 67, 68, 69, 14, 15, 2, 3, 18, 19, 20, 21];
const PICO: [u8; 26] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 26, 27, 28];
/// Pins that have no special level at boot and do not belong to the flash or the serial line.
const ESP32_TRIGGERS: [u8; 9] = [4, 13, 16, 17, 18, 19, 21, 22, 23];
/// Echo pins of an ESP32, some of which can only be inputs.
const ESP32_ECHOES: [u8; 9] = [25, 26, 27, 32, 33, 34, 35, 36, 39];
/// GPIO numbers; the serial line, I2C and the first SPI are left free.
const PI: [u8; 20] = [4, 5, 6, 12, 13, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 7, 8, 9];

impl Board {
    /// Returns true if the board's pins tolerate no more than 3.3 V.
    pub(crate) const fn has_3v3(self) -> bool {
        !matches!(self, Self::Uno | Self::Mega)
    }

    /// Returns the board's usual name.
    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::Uno => "Arduino Uno",
            Self::Mega => "Arduino Mega 2560",
            Self::Pico => "Raspberry Pi Pico",
            Self::Esp32 => "ESP32",
            Self::RaspberryPi => "Raspberry Pi",
        }
    }

    /// Returns an analog pin without a module, as a sketch writes it.
    pub(crate) const fn open_pin(self) -> &'static str {
        match self {
            Self::Uno => "A5",
            Self::Mega => "A0",
            _ => "",
        }
    }

    /// Returns the serial line to an autopilot, as a sketch writes it, and its pins: sending, receiving.
    pub(crate) const fn line(self) -> (&'static str, [&'static str; 2]) {
        match self {
            Self::Mega => ("Serial2", ["16 (TX2)", "17 (RX2)"]),
            Self::Pico => ("Serial1", ["GP0", "GP1"]),
            Self::Esp32 => ("Serial", ["TX0", "RX0"]),
            _ => ("Serial", ["1 (TX)", "0 (RX)"]),
        }
    }

    /// Returns the pins of this many modules, without those of the line to an autopilot.
    ///
    /// # Errors
    /// The number of modules that the board has pins for, in words.
    pub(crate) fn wiring(self, modules: usize, mavlink: bool) -> Result<Wiring, String> {
        let pico = &PICO[if mavlink { 2 } else { 0 }..];
        let halves = |pins: &[u8]| {
            (pins.len() >= 2 * modules).then(|| (pins[..modules].into(), pins[modules..2 * modules].into()))
        };
        let of =
            |triggers: &[u8], echoes: &[u8]| Some((triggers.get(..modules)?.to_vec(), echoes.get(..modules)?.to_vec()));
        let (pins, most) = match self {
            Self::Uno => (halves(&UNO).or_else(|| of(&UNO, &UNO)), UNO.len()),
            Self::Mega => (of(&std::array::from_fn::<u8, 24, _>(|pin| 22 + pin as u8), &MEGA_ECHOES), 24),
            Self::Pico => (halves(pico), pico.len() / 2),
            Self::Esp32 => (of(&ESP32_TRIGGERS, &ESP32_ECHOES), ESP32_ECHOES.len()),
            Self::RaspberryPi => (halves(&PI), PI.len() / 2),
        };
        let (triggers, echoes) =
            pins.ok_or_else(|| format!("{modules} modules on one {}; expected no more than {most}", self.title()))?;
        Ok(Wiring { triggers, echoes })
    }

    /// Returns the pin's name on the board.
    fn name_of(self, pin: u8) -> String {
        match self {
            Self::Uno if pin >= 14 => format!("A{}", pin - 14),
            Self::Mega if pin >= 54 => format!("A{}", pin - 54),
            Self::Pico => format!("GP{pin}"),
            Self::RaspberryPi | Self::Esp32 => format!("GPIO{pin}"),
            _ => pin.to_string(),
        }
    }

    /// Describes the wires, line by line.
    pub(crate) fn in_words(self, Wiring { triggers, echoes }: &Wiring) -> Vec<String> {
        let mut lines = vec![format!(
            "Wires to this board ({}), besides supply and ground; for other pins change the lists below:",
            self.title()
        )];
        for (module, (&trigger, &echo)) in (1..).zip(triggers.iter().zip(echoes)) {
            let (from, to) = (self.name_of(trigger), self.name_of(echo));
            lines.push(if trigger == echo {
                format!("  module {module}: pin {from} to Trig and to Echo, both joined")
            } else {
                format!("  module {module}: pin {from} to Trig, pin {to} to Echo")
            });
        }
        if self.has_3v3() {
            lines.push(
                "A module that runs from 5 V answers with 5 V, which breaks pins of 3.3 V: between its Echo".into(),
            );
            lines.push("and the pin 1 kOhm, and 2 kOhm from the pin to ground.".into());
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_pin_has_two_wires_of_two_modules() {
        for &board in Board::value_variants() {
            let mut most = 0;
            for modules in 1..=24 {
                let Ok(Wiring { triggers, echoes }) = board.wiring(modules, false) else { continue };
                most = modules;
                let joined = triggers == echoes;
                let mut pins = if joined { triggers } else { [triggers, echoes].concat() };
                pins.sort_unstable();
                assert!(pins.windows(2).all(|two| two[0] < two[1]), "{board:?} {modules}: {pins:?}");
                assert_eq!(pins.len(), modules * if joined { 1 } else { 2 });
            }
            let refused = board.wiring(most + 1, false).err().unwrap();
            assert!(refused.ends_with(&format!("expected no more than {most}")), "{refused}");
        }
    }
}
