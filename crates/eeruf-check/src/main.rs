//! `eeruf-check FILE` checks a certificate; docs/reference/certificate.md has the format.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args_os().skip(1).collect();
    let [file] = arguments.as_slice() else {
        eprintln!("usage: eeruf-check FILE");
        return ExitCode::from(2);
    };
    let text = match std::fs::read_to_string(file) {
        Ok(text) => text,
        Err(error) => {
            eprintln!("{}: {error}", file.display());
            return ExitCode::from(2);
        }
    };
    match eeruf_check::check(&text) {
        Ok(certified) => {
            println!("{certified}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            println!("refused: {}: {error}", file.display());
            ExitCode::FAILURE
        }
    }
}
