//! The program `eeruf`: it only calls the library of the same name.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(eeruf::run(std::env::args_os()))
}
