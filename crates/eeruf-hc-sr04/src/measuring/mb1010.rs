//! [`Mb1010`]: a module that answers with the width of a pulse.

use eeruf_core::Micros;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;

use super::{Fault, Measured, Measures};
use crate::modules::{MB1010, Module};
use crate::settings::Settings;

/// Interval between two checks for a pulse, an arbitrary choice. A pulse that ends sooner after the start than its own
/// width belongs to an earlier start.
const LOOK_EVERY: Micros = Micros::from_millis(5);

const SETTINGS: Settings = match Settings::of(&MB1010) {
    Some(settings) => settings,
    None => panic!("an MB1010 answers by a pulse"),
};

/// A `MaxBotix` MB1010 (LV-MaxSonar-EZ1), started by its RX pin, whose pulses on PW are measured by a timer, PIO or
/// RMT: report each by [`pulse`](Self::pulse).
///
/// RX high for 20 us starts a reading, and PW is high for 147 us per inch of range (LV-MaxSonar-EZ1 Data Sheet,
/// `MaxBotix`), which is the echo time in air of 24 degrees. PW rises after the burst and falls with the echo, so its
/// width is taken as the echo time; without an echo it is high for up to 37.5 ms ("LV-MaxSonar-EZ, timing"). The first
/// reading after power-up takes 49 ms longer and goes unanswered. Closer than 6 inches it reports 6 inches.
#[derive(Debug)]
pub struct Mb1010<T, D> {
    rx: T,
    delay: D,
    is_started: bool,
    pulse: Option<Micros>,
    /// True if two pulses of one start had different widths.
    differs: bool,
}

impl<T: OutputPin, D: DelayNs> Mb1010<T, D> {
    /// A module whose RX pin is `rx`, which must be low at first.
    pub const fn new(rx: T, delay: D) -> Self {
        Self { rx, delay, is_started: false, pulse: None, differs: false }
    }

    /// Reports the width of a pulse on PW, as soon as it has ended.
    pub fn pulse(&mut self, width: Micros) {
        if self.is_started {
            self.differs |= self.pulse.is_some_and(|before| before != width);
            self.pulse = Some(width);
        }
    }

    /// Returns RX and the delay.
    pub fn release(self) -> (T, D) {
        (self.rx, self.delay)
    }
}

impl<T: OutputPin, D: DelayNs> Measures for Mb1010<T, D> {
    fn module(&self) -> &Module {
        &MB1010
    }

    fn start(&mut self) -> Result<Micros, Fault> {
        (self.is_started, self.pulse, self.differs) = (false, None, false);
        let rose = self.rx.set_high();
        self.delay.delay_us(MB1010.trigger_us);
        // Also after an error: while RX is high the module keeps ranging.
        let fell = self.rx.set_low();
        if rose.is_err() || fell.is_err() {
            return Err(Fault::Bus);
        }
        self.is_started = true;
        Ok(LOOK_EVERY)
    }

    fn result(&mut self, since: Micros) -> Result<Measured, Fault> {
        let within = self.answers_within();
        let Some(width) = self.pulse else {
            return if since < within {
                Ok(Measured::NotYet(within.min(since.saturating_add(LOOK_EVERY))))
            } else {
                Err(Fault::NoAnswer)
            };
        };
        if self.differs {
            return Err(Fault::Invalid);
        }
        if width > since || width < SETTINGS.shortest || width > within {
            // The pulse of this start may still be to come.
            self.pulse = None;
            return Err(Fault::Invalid);
        }
        Ok(if width < SETTINGS.longest { Measured::Echo(width) } else { Measured::Nothing })
    }
}
