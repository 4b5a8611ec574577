//! The board's clock and alarm as embassy's time driver.

use core::cell::{Cell, RefCell};
use core::task::Waker;

use critical_section::{CriticalSection, Mutex};
use eeruf_core::{Instant, Micros};
use embassy_time_driver::Driver;
use embassy_time_queue_utils::Queue;

struct BoardTime {
    /// The 64-bit clock that embassy needs, at the last reading.
    clock_us: Mutex<Cell<u64>>,
    queue: Mutex<RefCell<Queue>>,
}

embassy_time_driver::time_driver_impl!(static TIME: BoardTime = BoardTime {
    clock_us: Mutex::new(Cell::new(0)),
    queue: Mutex::new(RefCell::new(Queue::new())),
});

/// Returns the current time in 64 bits: the board's clock wraps every 71 minutes, and is read more often than that.
fn now_us(token: CriticalSection<'_>) -> u64 {
    let clock = TIME.clock_us.borrow(token);
    let before = clock.get();
    let passed = eeruf_board::now().since(Instant::from_micros(before as u32));
    clock.set(before + u64::from(passed.as_micros()));
    clock.get()
}

fn set_alarm(token: CriticalSection<'_>, at_us: u64) {
    // An alarm further ahead than half a turn of the clock is set again when this one has gone off.
    let wait = at_us.saturating_sub(now_us(token)).min(1 << 30);
    eeruf_board::set_alarm(eeruf_board::now() + Micros::new(wait as u32));
}

impl Driver for BoardTime {
    fn now(&self) -> u64 {
        critical_section::with(now_us)
    }

    fn schedule_wake(&self, at: u64, waker: &Waker) {
        critical_section::with(|token| {
            let mut queue = self.queue.borrow_ref_mut(token);
            if queue.schedule_wake(at, waker) {
                let next = queue.next_expiration(now_us(token));
                set_alarm(token, next);
            }
        });
    }
}

/// Handles the alarm's interrupt: wakes the tasks that are due.
pub(crate) fn alarm() {
    eeruf_board::clear_alarm();
    critical_section::with(|token| {
        let next = TIME.queue.borrow_ref_mut(token).next_expiration(now_us(token));
        set_alarm(token, next);
    });
}
