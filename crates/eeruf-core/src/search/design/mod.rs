//! The shortest period for a ring of sensors, proven.

mod control;
mod frame;
mod network;
mod packing;
mod problem;
mod propagate;
mod random;
mod symmetry;
mod tree;

pub use control::{Control, Flow, POLL, Progress};
pub use problem::{MAX_SENSORS, MAX_TICKS, Problem, ProblemError};

#[doc(hidden)]
pub fn probe(problem: &Problem<'_>, period: u32, memory: &mut [i32], seed: Option<u64>, budget: u64) -> (i32, u64, [u32; 64], [u32; 64]) {
    let needs = problem.needs().unwrap();
    let mut tree = tree::Tree::new(&needs, period as i32, memory);
    tree.restart(seed.map(random::Random::new));
    let o = tree.run(budget);
    match o {
        tree::Outcome::Found(t) => (1, tree.nodes(), t.a, t.b),
        tree::Outcome::Exhausted => (0, tree.nodes(), [0; 64], [0; 64]),
        tree::Outcome::Spent => (-1, tree.nodes(), [0; 64], [0; 64]),
    }
}
#[doc(hidden)]
pub const fn words(k: usize) -> usize { tree::words(k) }
