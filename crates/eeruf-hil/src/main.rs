//! `eeruf-hil SCENE --board NAME EMULATOR .. [--board ..]`: hardware in the loop, without a fault and with each of six.
//!
//! Prints two Markdown tables: the agreement of the boards' rings with the host's, and the effect of each fault. Exits
//! with 1 if anything is wrong.
//!
//! `eeruf-hil SCENE --flow --board NAME EMULATOR .. [--board ..]`: tests boards whose rings fire by flow, and prints
//! one table.
//!
//! `eeruf-hil SCENE --one FAULT PERIODS --board NAME EMULATOR ..`: one run in real time, for tests of programs that
//! listen to the board's serial line. Prints the readings as CSV.
//!
//! `eeruf-hil SCENE --lines LINES PERIODS --board NAME EMULATOR ..`: a run like `--one` in which the lines play given
//! edges instead of the scene's: for each sensor its pin and edges, in us after its trigger, as `2 +450 -6280*`.

mod control;
mod emulator;
mod lines;
mod played;
mod reference;
mod run;

use std::path::Path;
use std::process::ExitCode;

use eeruf_core::ReadingKind;
use eeruf_sim::{Method, Options, Readings, World, simulate, sweep};

use crate::lines::FAULTY;
use crate::played::PlayedLines;
use crate::run::{Fault, PERIODS, Pace, Run, run, run_flow, run_played};

/// Least share of believed readings for any sensor of the flow ring in this scene.
const LEAST_BELIEVED: f64 = 0.5;

/// A board's name, and the command that emulates it.
type Board<'a> = (&'a str, &'a [String]);

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut parts = arguments.split(|argument| argument == "--board");
    let scene = parts.next().and_then(<[String]>::first);
    let boards: Vec<Board<'_>> =
        parts.filter_map(<[String]>::split_first).map(|(name, emulator)| (&**name, emulator)).collect();
    let Some(scene) = scene.filter(|_| !boards.is_empty()) else {
        eprintln!(
            "usage: eeruf-hil SCENE [--flow | --one FAULT PERIODS | --lines LINES PERIODS] --board NAME EMULATOR \
             [ARGUMENT ..] [--board ..]"
        );
        return ExitCode::from(2);
    };
    let outcome = match (arguments.get(1..4), &boards[..]) {
        (Some([one, fault, periods]), &[(_, emulator)]) if one == "--one" => one_run(scene, fault, periods, emulator),
        (Some([option, lines, periods]), &[(_, emulator)]) if option == "--lines" => {
            played_run(scene, lines, periods, emulator)
        }
        _ if arguments.get(1).is_some_and(|argument| argument == "--flow") => flow_table(scene, &boards),
        _ => tables(scene, &boards),
    };
    match outcome {
        Ok(tables) => {
            print!("{tables}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("hardware in the loop: {error}");
            ExitCode::FAILURE
        }
    }
}

fn one_run(scene: &str, fault: &str, periods: &str, emulator: &[String]) -> Result<String, String> {
    let known = Fault::named(fault).ok_or_else(|| {
        format!("fault {fault}; expected none, missing, stuck, chatters, interrupts-lost, stall or wrap")
    })?;
    let (world, periods) = (world_of(scene)?, number_of(periods)?);
    Ok(csv(&run(&world, known, periods, Pace::Wall, emulator)?))
}

fn played_run(scene: &str, lines: &str, periods: &str, emulator: &[String]) -> Result<String, String> {
    let (lines, world) = (PlayedLines::read(lines)?, world_of(scene)?);
    Ok(csv(&run_played(&world, lines, number_of(periods)?, emulator)?))
}

fn world_of(scene: &str) -> Result<World, String> {
    World::from_toml(Path::new(scene)).map_err(|error| error.to_string())
}

fn number_of(periods: &str) -> Result<u32, String> {
    periods.parse().map_err(|_| format!("{periods} periods; expected a number"))
}

fn csv(run: &Run) -> String {
    let rows = run.read.iter().flatten().map(|reading| {
        let t_echo = reading.t_echo.map(|t_echo| t_echo.as_micros().to_string()).unwrap_or_default();
        format!("{},{},{},{t_echo}\n", reading.sensor, reading.period, reading.kind)
    });
    format!("sensor,period,reading,t_echo_us\n{}", rows.collect::<String>())
}

/// One row without a fault, and the rows of all faults.
type Rows = (String, String);

fn tables(scene: &str, boards: &[Board<'_>]) -> Result<String, String> {
    let world = world_of(scene)?;
    let simulated = simulate(&world, Method::Eeruf, &Options::periods(PERIODS)).map_err(|error| error.to_string())?;
    let rows = |&(board, emulator): &Board<'_>| -> Result<Rows, String> {
        rows(&world, &simulated, board, emulator).map_err(|error| format!("{board}: {error}"))
    };
    let rows: Vec<Rows> = sweep(boards, rows).into_iter().collect::<Result<_, _>>()?;
    let (fault_free, faults): (Vec<_>, Vec<_>) = rows.into_iter().unzip();
    Ok(format!(
        "| board | readings | as the host's ring | accepted | rejected | kind as simulated | echo time within \
         | edge noticed within | latest firing |\n|---|---:|---|---:|---:|---:|---:|---:|---:|\n{}\n\
         | board | fault | readings | as the host's ring | others of another kind | others' time moved by | named |\n\
         |---|---|---:|---|---:|---:|---|\n{}",
        fault_free.concat(),
        faults.concat()
    ))
}

fn rows(world: &World, simulated: &Readings, board: &str, emulator: &[String]) -> Result<Rows, String> {
    let in_run = |fault: Fault| move |error: String| format!("{fault}: {error}");
    let fault_free = run(world, Fault::None, PERIODS, Pace::Free, emulator).map_err(in_run(Fault::None))?;
    let count = |kind: ReadingKind| fault_free.read.iter().flatten().filter(|reading| reading.kind == kind).count();
    let (same, within) = fault_free.as_simulated(simulated)?;
    let row = format!(
        "| {board} | {} | all | {} | {} | {same} | {within} us | {} | {} |\n",
        fault_free.count(),
        count(ReadingKind::Accepted),
        count(ReadingKind::Rejected),
        fault_free.latest_edge,
        fault_free.max_late,
    );
    let mut rows = String::new();
    for fault in Fault::ALL {
        let faulty = run(world, fault, PERIODS, Pace::Free, emulator).map_err(in_run(fault))?;
        rows += &fault_row(board, fault, &faulty, &fault_free).map_err(in_run(fault))?;
    }
    Ok((row, rows))
}

fn fault_row(board: &str, fault: Fault, faulty: &Run, fault_free: &Run) -> Result<String, String> {
    let named = faulty.report(fault)?;
    let change = faulty.change_from(fault_free, fault)?;
    let count = faulty.count();
    Ok(format!("| {board} | {fault} | {count} | all | {} | {} | {named} |\n", change.kinds, change.moved))
}

fn flow_table(scene: &str, boards: &[Board<'_>]) -> Result<String, String> {
    let world = world_of(scene)?;
    let rows = |&(board, emulator): &Board<'_>| -> Result<String, String> {
        let mut rows = String::new();
        for fault in [Fault::None].into_iter().chain(Fault::ALL) {
            rows += &flow_row(&world, board, fault, emulator).map_err(|error| format!("{board}: {fault}: {error}"))?;
        }
        Ok(rows)
    };
    let rows: Vec<String> = sweep(boards, rows).into_iter().collect::<Result<_, _>>()?;
    Ok(format!(
        "| board | fault | as the host's ring | believed of each other sensor | named |\n|---|---|---|---|---|\n{}",
        rows.concat()
    ))
}

/// Makes a row for a flow ring. A microsecond may decide what is believed, and so when the next sensor fires, and
/// interrupts vary by microseconds between runs: so the table has neither counts nor lateness, and the counts go to
/// standard error.
fn flow_row(world: &World, board: &str, fault: Fault, emulator: &[String]) -> Result<String, String> {
    let run = run_flow(world, fault, PERIODS, emulator)?;
    let report = run.report_flow(fault)?;
    // The time until a line is named depends on how often its sensor fires.
    let named = report.split(" after ").next().unwrap_or_default();
    let named = if fault == Fault::Stall { "a late firing" } else { named };
    let but = matches!(fault, Fault::Line(_)).then_some(FAULTY);
    let least = run.least_believed(but);
    let counted = [ReadingKind::Accepted, ReadingKind::Ambiguous, ReadingKind::Rejected];
    let [accepted, ambiguous, rejected] = counted.map(|kind| run.of(kind, but));
    eprintln!(
        "{board}, {fault}: {} readings; of the other sensors {accepted} accepted, {ambiguous} ambiguous, {rejected} \
         rejected, and of the worst-off one {:.1} % believed; {report}",
        run.count(),
        100.0 * least,
    );
    // No sensor may be blind, whatever is wrong with another.
    if least < LEAST_BELIEVED {
        return Err(format!("of a sensor {:.1} % of the readings are believed; expected half", 100.0 * least));
    }
    Ok(format!("| {board} | {fault} | all | over half | {named} |\n"))
}
