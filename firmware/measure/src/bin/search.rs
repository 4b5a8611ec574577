//! The search of the paper's problem on the board: the one rearrangement of Table I that keeps 19 ms between any four
//! adjacent sensors, and the proof that there is no other. Prints nodes and instructions; for `-icount shift=6`.
#![no_std]
#![no_main]

use eeruf_board::say;
use eeruf_board::say::leave;
use eeruf_core::search::Outcome;
use eeruf_core::search::wait::{Budget, Problem, Search};
use eeruf_core::{Criterion, Layout};

eeruf_board::say_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, eeruf_board::clear_echo);

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    let lag: [u32; 12] = core::array::from_fn(|x| 25 * (x as u32 % 4));
    let pairs: [(u32, u32); 12] = core::array::from_fn(|x| (24, 2 * x as u32));
    let conflicts = Layout::Line(4).rows(12);
    let problem = Problem {
        period: 100,
        lag: &lag,
        wait_max: 24,
        separation: 2,
        interval: 19,
        conflicts: conflicts.get(..12).unwrap_or(&[]),
        criterion: Criterion::Paper,
    };
    let start = eeruf_board::now();
    let Ok(search) = Search::new(problem) else { leave(2) };
    let Ok(assignment) = search.assign(&pairs) else { leave(3) };
    let (mut a, mut b) = ([0; 12], [0; 12]);
    let Ok(Outcome::Found(())) = assignment.first(&mut Budget::unlimited(), &mut a, &mut b) else { leave(4) };
    let count = assignment.count(&mut Budget::unlimited());
    // 64 ns an instruction.
    let instructions = u64::from(eeruf_board::now().since(start).as_micros()) * 1000 / 64;
    if (count.outcome, count.count) != (Outcome::Exhausted, 1) || b != [22, 16, 10, 4, 20, 14, 8, 2, 18, 12, 6, 0] {
        leave(5);
    }
    say!("found and proven unique: nodes ", count.nodes as u32, ", instructions ", instructions as u32);
    leave(0)
}
