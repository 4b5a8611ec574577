//! `eeruf man`: the pages for `man`, one for the program and one for each verb, or one document.

use std::path::PathBuf;

use eeruf_files::FileError;

use super::Answer;
use super::program;
use crate::console::print;
use crate::files::error::InputError;
use crate::files::write::make_folder;

/// Write man pages, one for the program and one for each verb.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder for the pages, such as ~/.local/share/man/man1
    #[arg(value_name = "DIR", required_unless_present = "markdown")]
    folder: Option<PathBuf>,
    /// Print all verbs and options as one document in Markdown
    #[arg(long, conflicts_with = "folder")]
    markdown: bool,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    if let Some(folder) = &args.folder {
        make_folder(folder)?;
        clap_mangen::generate_to(program(), folder).map_err(|error| FileError::writing(folder, &error))?;
    }
    if args.markdown {
        let options = clap_markdown::MarkdownOptions::new().show_footer(false).title("Verbs and options".to_owned());
        print(clap_markdown::help_markdown_command_custom(&program(), &options))?;
    }
    Ok(Answer::Yes)
}
