//! `hands_on!`: methods that every driver forwards to its ring.

/// Implements the methods that do not depend on the source of edges, for a driver whose first type parameter is its
/// ring and whose last is the number of sensors.
macro_rules! hands_on {
    ($driver:ident, $($parameter:ident),+ $(; $edges:ident)?) => {
        impl<P, J, $($parameter,)+ const K: usize, const H: usize $(, $edges)?>
            $driver<eeruf_core::Ring<P, J, K, 1, H>, $($parameter,)+ K $(, $edges)?>
        where
            P: eeruf_core::plan::Plan,
            J: eeruf_core::judge::Judge,
        {
            /// The ring.
            pub const fn ring(&self) -> &eeruf_core::Ring<P, J, K, 1, H> {
                &self.ring
            }

            /// Like [`Ring::upcoming`](eeruf_core::Ring::upcoming).
            pub fn upcoming(&self) -> impl Iterator<Item = eeruf_core::plan::Upcoming> {
                self.ring.upcoming()
            }

            /// Like [`Ring::disable`](eeruf_core::Ring::disable).
            ///
            /// # Errors
            /// [`SensorError`](eeruf_core::SensorError) for a sensor out of range.
            pub fn disable(&mut self, sensor: u8) -> Result<(), eeruf_core::SensorError> {
                self.ring.disable(sensor)
            }

            /// Like [`Ring::enable`](eeruf_core::Ring::enable).
            ///
            /// # Errors
            /// [`SensorError`](eeruf_core::SensorError) for a sensor out of range.
            pub fn enable(&mut self, sensor: u8) -> Result<(), eeruf_core::SensorError> {
                self.ring.enable(sensor)
            }

            /// Like [`Ring::moving`](eeruf_core::Ring::moving): how fast the robot moves and turns.
            pub fn moving(&mut self, speed_mm_s: u32, turn_mrad_s: u32, now: eeruf_core::Instant) {
                self.ring.moving(speed_mm_s, turn_mrad_s, now);
            }

            /// Like [`Ring::pause`](eeruf_core::Ring::pause).
            pub fn pause(&mut self) {
                self.ring.pause();
            }

            /// Like [`Ring::resume`](eeruf_core::Ring::resume).
            pub fn resume(&mut self) {
                self.ring.resume();
            }
        }
    };
}

pub(crate) use hands_on;
