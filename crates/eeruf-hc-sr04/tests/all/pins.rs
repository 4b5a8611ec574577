//! Pins whose lines a test controls.

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

/// The lines of all sensors.
pub(crate) trait Lines {
    fn is_high(&self, sensor: u8) -> bool;
    /// Notes the end of a trigger.
    fn trigger(&mut self, sensor: u8);
}

/// Trigger or echo pin of a sensor.
pub(crate) struct Pin<L>(pub(crate) Rc<RefCell<L>>, pub(crate) u8);

impl<L> ErrorType for Pin<L> {
    type Error = Infallible;
}

impl<L: Lines> InputPin for Pin<L> {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.borrow().is_high(self.1))
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

impl<L: Lines> OutputPin for Pin<L> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().trigger(self.1);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
