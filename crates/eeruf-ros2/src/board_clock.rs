//! Conversion of the board's clock to the host's time.
//!
//! A frame says when its sensor fired, and how long before the frame was made. The delay of the line varies; the
//! shortest of the last ten seconds counts.

use eeruf_core::{Instant, Micros};

/// Least time for which an offset is kept, in microseconds of the board's clock.
const KEPT_US: i64 = 5_000_000;
/// Jump of the clock that means that the board has restarted.
const RESTART_NS: i64 = 2_000_000_000;

#[derive(Debug, Default)]
pub(crate) struct BoardClock {
    /// The last instant, raw and with its wraps counted.
    last: Option<(Instant, i64)>,
    /// The least differences between the arrival and the making of a frame, in this stretch and the previous one.
    offsets_ns: Option<[i64; 2]>,
    began_us: i64,
}

impl BoardClock {
    /// Returns the time when a sensor fired, in nanoseconds of the host's clock, from a frame made `age` later that
    /// arrived at `arrived_ns`.
    pub(crate) fn fired_ns(&mut self, fired: Instant, age: Micros, arrived_ns: i64) -> i64 {
        let fired_us = self.without_wraps(fired);
        let offset = arrived_ns - 1000 * (fired_us + i64::from(age.as_micros()));
        let [mut now, mut before] = self.offsets_ns.unwrap_or([offset; 2]);
        if (offset - now.min(before)).abs() > RESTART_NS {
            [now, before] = [offset; 2];
            self.began_us = fired_us;
        }
        if fired_us - self.began_us > KEPT_US {
            [now, before] = [offset, now];
            self.began_us = fired_us;
        }
        now = now.min(offset);
        self.offsets_ns = Some([now, before]);
        1000 * fired_us + now.min(before)
    }

    fn without_wraps(&mut self, at: Instant) -> i64 {
        let us = match self.last {
            None => i64::from(at.as_micros()),
            // Less than half an hour forward or back.
            Some((last, us)) => us + i64::from(at.since(last).as_micros().cast_signed()),
        };
        self.last = Some((at, us));
        us
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const START_NS: i64 = 1_700_000_000_000_000_000;

    /// The worst error if the board's clock runs `drift` ppm too fast, over a line that takes 1 to 9 ms.
    fn worst_error_us(start: u32, drift: i64) -> i64 {
        let mut clock = BoardClock::default();
        let mut worst = 0;
        for n in 0..6_000_i64 {
            let true_us = n * 12_500;
            let board = start.wrapping_add((true_us + true_us * drift / 1_000_000) as u32);
            let way_us = 1_000 + n * 7_919 % 8_000;
            let fired_ns = START_NS + 1000 * true_us;
            let arrived = fired_ns + 1000 * (40_000 + way_us);
            let said = clock.fired_ns(Instant::from_micros(board), Micros::new(40_000), arrived);
            if n > 50 {
                worst = worst.max((said - fired_ns).abs() / 1000);
            }
        }
        worst
    }

    // Instants are right up to the shortest delay, through a wrap and with drift.
    #[test]
    fn instants_are_right_through_wrap_and_drift() {
        assert!(worst_error_us(0, 0) <= 1_500);
        assert!(worst_error_us(u32::MAX - 20_000_000, 0) <= 1_500);
        // 100 ppm make a millisecond in ten seconds.
        assert!(worst_error_us(0, 100) <= 2_500);
        assert!(worst_error_us(0, -100) <= 2_500);
    }

    #[test]
    fn a_board_that_starts_anew_is_believed_at_once() {
        let mut clock = BoardClock::default();
        let at = |us: u32| Instant::from_micros(us);
        clock.fired_ns(at(500_000_000), Micros::ZERO, START_NS);
        let later = START_NS + 3_000_000_000;
        assert_eq!(clock.fired_ns(at(1_000), Micros::new(500), later), later - 500_000);
    }
}
