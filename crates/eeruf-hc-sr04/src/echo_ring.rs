//! [`EchoRing`]: what the driver asks of a ring.

use eeruf_core::{HoppingRing, Instant, Micros, Ring, RingEvent, Scheduler, SensorError};

/// A ring that an [`HcSr04Ring`](crate::HcSr04Ring) can drive: [`Ring`], and [`HoppingRing`], of which no sensor stays
/// blind. It has up to `K` sensors, as many as the driver has pins. Each function does what the ring's own of the same
/// name does.
pub trait EchoRing<const K: usize> {
    /// The next event, if there is one at `now`; see [`Ring::poll_expecting`].
    fn poll_expecting(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent>;
    /// When to poll next.
    fn next_deadline(&self) -> Instant;
    /// No sensor fires again within this time of firing.
    fn min_refire(&self) -> Micros;
    /// An edge on the echo line of a sensor.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    fn echo(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError>;
    /// When the sensor of the last [`Fire`](RingEvent::Fire) really fired.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    fn fired(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError>;
    /// When a sensor last fired, by what [`fired`](Self::fired) said of it; `None` for one that is not there.
    fn last_firing(&self, sensor: u8) -> Option<Instant>;
    /// The echo line of a sensor was high when it was to fire.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    fn stuck(&mut self, sensor: u8) -> Result<(), SensorError>;
    /// Asks silence for a witness, from the next firing on.
    fn expect_answers(&mut self);
    /// A sensor has shown that it listens.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    fn answered(&mut self, sensor: u8) -> Result<(), SensorError>;
    /// Takes an answer back: it was a disturbance.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    fn unanswered(&mut self, sensor: u8) -> Result<(), SensorError>;
    /// The last reading of a sensor was not what it seemed.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    fn forget(&mut self, sensor: u8) -> Result<(), SensorError>;
    /// Stops a sensor from firing.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    fn disable(&mut self, sensor: u8) -> Result<(), SensorError>;
    /// Lets a sensor fire again.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    fn enable(&mut self, sensor: u8) -> Result<(), SensorError>;
    /// Lets no sensor fire until it is resumed.
    fn pause(&mut self);
    /// Lets sensors fire again; what was known of their echoes is forgotten.
    fn resume(&mut self);
    /// Starts again at `now`.
    fn restart(&mut self, now: Instant);
}

/// Hands everything on to the ring's own functions; rings differ in how they say how soon a sensor fires again.
macro_rules! echo_ring {
    ([$($generics:tt)*] $ring:ty, $min_refire:expr) => {
        impl<$($generics)*> EchoRing<K> for $ring {
            fn poll_expecting(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
                self.poll_expecting(now, expected_change_us)
            }
            fn next_deadline(&self) -> Instant {
                self.next_deadline()
            }
            fn min_refire(&self) -> Micros {
                let min_refire: fn(&Self) -> Micros = $min_refire;
                min_refire(self)
            }
            fn echo(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError> {
                self.echo(sensor, at)
            }
            fn fired(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError> {
                self.fired(sensor, at)
            }
            fn last_firing(&self, sensor: u8) -> Option<Instant> {
                self.last_firing(sensor)
            }
            fn stuck(&mut self, sensor: u8) -> Result<(), SensorError> {
                self.stuck(sensor)
            }
            fn expect_answers(&mut self) {
                self.expect_answers();
            }
            fn answered(&mut self, sensor: u8) -> Result<(), SensorError> {
                self.answered(sensor)
            }
            fn unanswered(&mut self, sensor: u8) -> Result<(), SensorError> {
                self.unanswered(sensor)
            }
            fn forget(&mut self, sensor: u8) -> Result<(), SensorError> {
                self.forget(sensor)
            }
            fn disable(&mut self, sensor: u8) -> Result<(), SensorError> {
                self.disable(sensor)
            }
            fn enable(&mut self, sensor: u8) -> Result<(), SensorError> {
                self.enable(sensor)
            }
            fn pause(&mut self) {
                self.pause();
            }
            fn resume(&mut self) {
                self.resume();
            }
            fn restart(&mut self, now: Instant) {
                self.restart(now);
            }
        }
    };
}

echo_ring!([S: Scheduler, const K: usize] Ring<S, K>, |ring| ring.scheduler().min_refire());
echo_ring!([const K: usize, const H: usize] HoppingRing<K, H>, |ring| ring.firing().min_refire());
