//! The program `eeruf`; the library of the same name is all of it.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(eeruf::run(std::env::args_os()))
}
