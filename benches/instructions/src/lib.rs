//! Instruction counts of `eeruf-core`, which repeat exactly: `cargo bench -p eeruf-instructions`.
//!
//! Needs valgrind and the runner: `cargo install gungraun-runner --version 0.20.0`.
