//! `eeruf completions`: completion of verbs and options for a shell.

use clap_complete::Shell;

use super::Answer;
use super::program;
use crate::console::print;
use crate::files::error::InputError;

/// Print a shell's completions of verbs and options
///
/// bash: eeruf completions bash > ~/.local/share/bash-completion/completions/eeruf
///
/// fish: eeruf completions fish > ~/.config/fish/completions/eeruf.fish
///
/// zsh: eeruf completions zsh > _eeruf, in a folder of $fpath
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct Args {
    /// The shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program(), "eeruf", &mut script);
    print(String::from_utf8_lossy(&script))?;
    Ok(Answer::Yes)
}
