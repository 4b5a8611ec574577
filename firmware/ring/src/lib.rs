//! The main loop of a ring on bare metal: asleep between deadlines.
#![no_std]

use eeruf_board::fake_sensors::{Delay, Echo, Trigger};
use eeruf_core::{EdgeQueue, RingEvent, ScheduledRing};
use eeruf_hc_sr04::HcSr04Ring;

/// A ring on the pins of this board, whose edges come through a queue.
pub type BoardRing<const K: usize, const N: usize> =
    HcSr04Ring<ScheduledRing<'static, K>, Trigger, Echo, Delay, K, &'static EdgeQueue<N>>;

/// Runs a ring forever on its queue of edges, and passes each event to `on_event`.
pub fn run<const K: usize, const N: usize>(
    mut ring: BoardRing<K, N>,
    edges: &'static EdgeQueue<N>,
    mut on_event: impl FnMut(&BoardRing<K, N>, RingEvent),
) -> ! {
    loop {
        while let Some(event) = ring.poll(eeruf_board::now()) {
            on_event(&ring, event);
        }
        let deadline = ring.next_deadline();
        eeruf_board::set_alarm(deadline);
        // If the alarm goes off before we sleep, it does not wake us.
        eeruf_board::sleep_unless(|| !edges.is_empty() || eeruf_board::now().has_reached(deadline));
    }
}
