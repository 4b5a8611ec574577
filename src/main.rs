//! The command-line program `eeruf`.
fn main() {}
