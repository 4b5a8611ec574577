//! `eeruf licenses`: the licences of the program and of its dependencies.

use super::Answer;
use crate::console::print_line;
use crate::files::error::InputError;

/// The texts in the order of printing.
const TEXTS: [(&str, &str); 4] = [
    ("eeruf: MIT or Apache-2.0, at your option", include_str!("../../LICENSE-MIT")),
    ("Or Apache-2.0", include_str!("../../LICENSE-APACHE")),
    ("The letters in its pictures: Bitstream-Vera", include_str!("../report/draw/font/LICENSE")),
    ("What others wrote", include_str!(concat!(env!("OUT_DIR"), "/notices.txt"))),
];

/// Print the licences of this program and its dependencies
#[derive(clap::Args)]
pub(crate) struct Args {}

pub(crate) fn run(_: &Args) -> Result<Answer, InputError> {
    for (title, text) in TEXTS {
        let line = "=".repeat(title.chars().count());
        print_line(format_args!("{title}\n{line}\n\n{text}"))?;
    }
    Ok(Answer::Yes)
}
