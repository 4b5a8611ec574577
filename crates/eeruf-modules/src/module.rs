//! [`Module`]: an ultrasonic transducer with its electronics, in whole numbers.

/// Time for which a clone of the HC-SR04 holds its line without an echo, in microseconds.
pub(crate) const CLONE_HOLDS_US: u32 = 200_000;

/// A ranging module. Start from a preset and change its fields, directly or by [`set`](Self::set).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Module {
    /// The name in files: the name of a preset, or of the preset that the module was derived from.
    pub name: &'static str,
    /// The farthest range that the module reports, in mm.
    pub sees_to_mm: u32,
    /// Distance of the farthest wall whose echo is still heard now and then, in mm.
    pub hears_to_mm: u32,
    /// Time for which the module is deaf after firing, in us.
    pub blanking_us: u32,
    /// Frequency in Hz.
    pub frequency_hz: u32,
    /// Bandwidth around the frequency, for sending and hearing, in Hz.
    pub bandwidth_hz: u32,
    /// Length of the burst in cycles.
    pub burst_cycles: u32,
    /// The growth of the gain while the module listens.
    pub gain: Gain,
    /// Radius of the piston with the same beam, in um.
    pub radius_um: u32,
    /// The pattern near 90 degrees and beyond.
    pub beam: Beam,
    /// Behaviour where nothing is in range.
    pub no_echo: NoEcho,
    /// The shortest time from one trigger to the next, in us.
    pub rest_us: u32,
    /// The length of the trigger pulse, in us; 0 for a command, a level, or a module that runs freely.
    pub trigger_us: u32,
    /// The way in which the module reports.
    pub interface: Interface,
    /// The time from the trigger to its report, in us; 0 where the echo's own edge reports it.
    pub report_us: u32,
}

/// Makes an enum of words used in files.
macro_rules! words {
    ($(#[doc = $about:literal])+ $name:ident { $( $(#[doc = $doc:literal])+ $variant:ident = $word:literal, )+ }) => {
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $name {
            $( $(#[doc = $doc])+ $variant, )+
        }

        impl $name {
            /// All variants, with their names in files.
            pub const NAMES: [(&'static str, Self); [$($word),+].len()] = [$(($word, Self::$variant)),+];

            /// Returns the name in files.
            pub const fn name(self) -> &'static str {
                match self {
                    $( Self::$variant => $word, )+
                }
            }
        }

        impl Default for $name {
            /// The first in the list.
            fn default() -> Self {
                Self::NAMES[0].1
            }
        }
    };
}

words! {
    /// The growth of a receiver's gain while it listens.
    Gain {
        /// Constant gain.
        Constant = "constant",
        /// Gain proportional to the square root of time.
        SquareRoot = "square_root",
        /// Gain proportional to time, which makes up for spherical spreading.
        Linear = "linear",
        /// Linear gain, in twelve equal steps.
        Stepped = "stepped",
        /// The twelve steps of the Polaroid 6500's control circuit.
        Polaroid6500 = "polaroid_6500",
    }
}

words! {
    /// The pattern near 90 degrees off the axis, and beyond.
    Beam {
        /// An endless baffle: nothing behind.
        CutAt90 = "cut_at_90",
        /// A baffle that ends with the piston: half of the wave at 90 degrees, and a shadow behind.
        Continuous = "continuous",
    }
}

words! {
    /// A module's way of reporting.
    Interface {
        /// A line rises when the echo is heard.
        Edge = "edge",
        /// Trigger and echo share a pin: the width of the pulse that answers is the echo time.
        OnePin = "one_pin",
        /// A line is high from the burst to the echo.
        PulseWidth = "pulse_width",
        /// A serial line.
        Uart = "uart",
        /// A bus of many modules.
        I2c = "i2c",
        /// A voltage.
        Analog = "analog",
    }
}

impl Interface {
    /// The time in microseconds by which a ring listens longer than the longest echo lasts: a line that is high during
    /// the echo rises about half a millisecond after the trigger, and edges are read late.
    pub const fn rise_us(self) -> u32 {
        if matches!(self, Self::PulseWidth | Self::OnePin) { 1_000 } else { 0 }
    }
}

/// Behaviour of a module where nothing is in range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoEcho {
    /// The module holds its line high for this long, then releases it.
    Holds {
        /// The time, in us.
        us: u32,
    },
    /// The line never rises.
    Silent,
    /// The module reports that there is nothing, by a value.
    Reports,
}

impl NoEcho {
    /// The names in files; `holds` goes with `hold_us`.
    pub const NAMES: [&'static str; 3] = ["holds", "silent", "reports"];

    /// Returns the name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Holds { .. } => "holds",
            Self::Silent => "silent",
            Self::Reports => "reports",
        }
    }

    /// Returns the time for which the module holds its line, in us; 0 if it does not.
    pub const fn hold_us(self) -> u32 {
        match self {
            Self::Holds { us } => us,
            Self::Silent | Self::Reports => 0,
        }
    }
}

/// Times in us by which a driver reads a module that answers with a pulse as long as the echo took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PulseTimes {
    /// Edges sooner than this after the trigger are the trigger itself, seen through the cable.
    pub deaf_us: u32,
    /// Shorter pulses are no echoes: 100 us is 17 mm, less than these modules can measure.
    pub shortest_us: u32,
    /// A line that rises later than this was not raised by the trigger, for example if wires are swapped. An HC-SR04
    /// takes half a millisecond, so this choice catches even one that fires a millisecond late.
    pub latest_rise_us: u32,
    /// Pulses this long or longer are no echo, but the module's own time-out, which may be a nineteenth short.
    pub longest_us: u32,
    /// The longest time for which a healthy module holds its line where nothing is in range, plus a quarter.
    pub longest_hold_us: u32,
}

impl Module {
    /// Returns true if the module hears another kind, that is, if their bands overlap.
    pub const fn hears(&self, other: &Self) -> bool {
        2 * self.frequency_hz.abs_diff(other.frequency_hz) < self.bandwidth_hz + other.bandwidth_hz
    }

    /// Returns the times by which a driver reads the line; `None` if the module gives no pulse without an echo.
    pub const fn pulse_times(&self) -> Option<PulseTimes> {
        let NoEcho::Holds { us: hold_us } = self.no_echo else { return None };
        // Modules sold under one name include clones.
        let longest_us = if hold_us > CLONE_HOLDS_US { hold_us } else { CLONE_HOLDS_US };
        let (longest_us, longest_hold_us) = (hold_us / 19 * 18, longest_us / 4 * 5);
        Some(PulseTimes { deaf_us: 100, shortest_us: 100, latest_rise_us: 1400, longest_us, longest_hold_us })
    }
}
