//! The queue of edges between two threads: the only type in the core that two threads use at once.
//!
//! Miri replays it under many interleavings, with stores that other threads see late, as on ARM:
//! `MIRIFLAGS=-Zmiri-many-seeds=0..200 cargo +nightly miri test -p eeruf-core --test all edges_pass`.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use eeruf_core::{Edge, EdgeQueue, Instant};

use crate::common::random::Random;

/// An edge whose fields all depend on this number.
fn edge(n: u32) -> Edge {
    Edge { sensor: (n * 37 % 128) as u8, high: n % 3 == 0, at: Instant::from_micros(n.wrapping_mul(0x9e37_79b1)) }
}

/// Pushes edges on one thread while another pops them; returns how many were lost.
fn pass<const N: usize>(edges: u32, seed: u64) -> u8 {
    let queue = EdgeQueue::<N>::new();
    let done = AtomicBool::new(false);
    let mut popped = 0;
    thread::scope(|scope| {
        scope.spawn(|| {
            let mut random = Random(seed);
            for n in 0..edges {
                queue.push(edge(n));
                // Outside Miri the next turn may be far off.
                if cfg!(miri) && random.up_to(2) == 0 {
                    thread::yield_now();
                }
            }
            done.store(true, Ordering::Release);
        });
        let mut next = 0;
        loop {
            // Read before the queue, which then holds all edges pushed before.
            let is_last = done.load(Ordering::Acquire);
            while let Some(found) = queue.pop() {
                // Some may have been lost between.
                let n = (next..edges).find(|&n| edge(n) == found);
                next =
                    1 + n.unwrap_or_else(|| panic!("{found:?} was never pushed, or comes out of order after {next}"));
                popped += 1;
            }
            if is_last {
                break;
            }
            std::hint::spin_loop();
        }
    });
    assert_eq!(popped + u32::from(queue.lost()), edges, "an edge is taken out or counted as lost");
    queue.lost()
}

// Edges pass from one thread to another whole and in order, and every lost edge is counted.
#[test]
fn edges_pass_between_threads_in_order() {
    let (rounds, edges) = if cfg!(miri) { (1, 40) } else { (4, 250) };
    for seed in 1..=rounds {
        pass::<2>(edges, seed);
        pass::<4>(edges, seed);
        // There is room for all of them.
        assert_eq!(pass::<128>(edges.min(128), seed), 0);
    }
}
