//! `eeruf design --program`: the recommended way of firing, or another, as a folder that builds.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use clap::builder::PossibleValue;
use eeruf_design::{RingDesign, Way};
use eeruf_files::Kind;
use eeruf_sim::Robot;

use super::Answer;
use super::rooms::{self, RoomArgs};
use crate::console::tell;
use crate::files::error::InputError;
use crate::files::write::{make_folder, write};
use crate::program::{Board, Language, Wanted, fitting, program};
use crate::report::watch::Watch;

/// Options of a program.
#[derive(clap::Args)]
pub(crate) struct ProgramArgs {
    /// Write a folder with a program that fires the ring in the recommended way: a sketch, a crate, ..; by default none
    #[arg(long, value_enum, value_name = "LANGUAGE",
          conflicts_with_all = ["emit", "json", "svg", "certificate", "period", "curve"])]
    pub(crate) program: Option<Language>,
    /// The board that the program is for; by default the usual one of its language
    #[arg(long, value_enum, value_name = "BOARD", requires = "program")]
    board: Option<Board>,
    /// Let the program send MAVLink over the board's serial line to an autopilot instead of printing, and write
    /// ArduPilot's parameters too
    #[arg(long, hide_short_help = true, requires = "program")]
    mavlink: bool,
    /// The program's folder; by default one with the ring file's name
    #[arg(long, value_name = "DIR", requires = "program")]
    out: Option<PathBuf>,
    /// The way of firing, for --program and --emit; by default the recommended one
    #[arg(long, value_enum, value_name = "WAY", conflicts_with_all = ["json", "period", "curve", "period_only"])]
    way: Option<Named>,
}

/// A way of firing as an option.
#[derive(Clone, Copy)]
struct Named(Way);

impl ValueEnum for Named {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self(Way::ALL[0]), Self(Way::ALL[1]), Self(Way::ALL[2]), Self(Way::ALL[3])]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.name()))
    }
}

impl ProgramArgs {
    /// The way of firing with the robot that fires so: the one asked for, else the one that is recommended; or why
    /// that cannot be said.
    pub(crate) fn fires(
        &self,
        design: &RingDesign,
        in_rooms: &RoomArgs,
        watch: &Watch,
    ) -> Result<Result<(Way, Robot), String>, InputError> {
        // The node fires by flow alone.
        let of_node = (self.program == Some(Language::Ros2)).then_some(Named(Way::Flow));
        if let Some(Named(way)) = self.way.or(of_node) {
            return Ok(design.spec.room_robot().map(|of| (way, of.robot)));
        }
        let none = || "no way can fire this ring; `eeruf design` says why".to_owned();
        Ok(rooms::judged(in_rooms, &design.spec, Some(design), false, watch)?.and_then(|answer| {
            let best = answer.best.ok_or_else(none)?;
            Ok((Way::of(&best).ok_or_else(none)?, best.robot))
        }))
    }
}

/// Writes the program, and says what it is and what to do with it.
pub(crate) fn run(
    args: &ProgramArgs,
    (file, language): (&Path, Language),
    design: &RingDesign,
    in_rooms: &RoomArgs,
    watch: &Watch,
) -> Result<Answer, InputError> {
    let bad = |why: String| InputError::new(file, why);
    // Before rooms are judged, which takes a while.
    fitting(&design.spec, language, args.board, args.mavlink).map_err(bad)?;
    let (way, robot) = args.fires(design, in_rooms, watch)?.map_err(bad)?;
    let folder = args.out.clone().unwrap_or_else(|| PathBuf::from(file.file_stem().unwrap_or_default()));
    let name = plain(&folder);
    let (text, shown) = (Kind::Ring.read(file)?, file.file_name().unwrap_or_default().to_string_lossy());
    let wanted = Wanted { file: (&shown, &text), design, robot: &robot, way, mavlink: args.mavlink, name: &name };
    let program = program(&wanted, language, args.board).map_err(bad)?;
    // Files that somebody may have changed by hand stay.
    let there = program.files.iter().map(|(path, _)| folder.join(path)).find(|path| path.exists());
    if let Some(there) = there {
        return Err(InputError::new(&there, "it is there already; expected a new folder, by --out DIR"));
    }
    for (path, text) in &program.files {
        let path = folder.join(path);
        if let Some(parent) = path.parent() {
            make_folder(parent)?;
        }
        write(&path, text)?;
    }
    let (count, folder) = (program.files.len(), folder.display());
    tell(format!("{folder}: {count} files of a ring that fires {}; {}\n", way.title(), program.next))?;
    Ok(Answer::Yes)
}

/// Returns the folder's name in a form allowed for a sketch and a crate.
fn plain(folder: &Path) -> String {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let name: String = name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("ring_{name}") }
}
