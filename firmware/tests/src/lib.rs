//! A test harness for boards: runs named functions, prints the name of each, and fails by panic.
#![no_std]

use eeruf_board::{say, say::leave};

/// A test and its name.
pub type Test = (&'static str, fn());

/// Runs the tests one after the other and exits with 0 if all pass, or with 101 from the panic of the first that fails.
pub fn run(tests: &[Test]) -> ! {
    for (name, test) in tests {
        say!("test ", *name, " ..");
        test();
    }
    say!(eeruf_board::NAME, ": ", tests.len() as u32, " passed");
    leave(0)
}

/// Makes a list of tests with the names of their functions.
#[macro_export]
macro_rules! tests {
    ($($test:ident),* $(,)?) => {
        &[$((stringify!($test), $test as fn())),*]
    };
}
