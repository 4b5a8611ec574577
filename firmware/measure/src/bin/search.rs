//! Searches on the board for the paper's table: the waits with the largest interval between any four adjacent sensors
//! of twelve, with the proof that none has a larger one. Prints nodes and instructions; run it with `-icount shift=6`.
#![no_std]
#![no_main]

use eeruf_board::say;
use eeruf_board::say::leave;
use eeruf_core::search::{Budget, WaitProblem, WaitSearch, memory_words};
use eeruf_core::{Criterion, Layout, Micros};

eeruf_board::say_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, eeruf_board::clear_echo);

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    let problem = WaitProblem {
        sensors: 12,
        period: Micros::from_millis(100),
        wait_max: Micros::from_millis(24),
        tick: Micros::from_millis(1),
        t_lag: None,
        t_delta: Micros::new(999),
        min_interval: Micros::from_millis(15),
        neighbours: 4,
        layout: Layout::Line(4),
        criterion: Criterion::Exact,
    };
    let start = eeruf_board::now();
    let Ok(search) = WaitSearch::new(&problem) else { leave(2) };
    let mut memory = [0; memory_words(12)];
    let Ok(best) = search.best_interval::<12>(&mut memory, &mut Budget::unlimited()) else { leave(3) };
    // 64 ns per instruction.
    let instructions = u64::from(eeruf_board::now().since(start).as_micros()) * 1000 / 64;
    if (best.value, best.proven) != (Some(Micros::from_millis(19)), true) {
        leave(4);
    }
    say!("19 ms found and proven best: nodes ", best.nodes as u32, ", instructions ", instructions as u32);
    leave(0)
}
