//! Rates of detection of `diagnose`: of each of the simulator's faults by strength, and false alarms of healthy
//! rings, in alcoves of Set I and in other rooms, standing and driving:
//! `cargo lab fault-rates [FIRST [PLACES [PHYSICS [METHOD [ROBOTS]]]]]`,
//! where ROBOTS are those that `stand`, those that `drive`, or `both`.
//!
//! The simulator decides which logs count, before `diagnose` sees any: `truth.rs`.

mod cases;
mod oracle;
mod truth;

use cases::{Broken, Outcome};
pub(crate) use cases::{Place, Robots, world};
use eeruf_logs::Share;
use eeruf_sim::{Method, Physics, sweep};

/// Counts over the logs of one cell of the table.
#[derive(Clone, Copy, Default)]
struct Cell {
    logs: u32,
    left_out: u32,
    named: u32,
    /// Logs in which a sensor is named that has no fault, or another fault than it has.
    blamed: u32,
    /// Logs that cannot tell the fault from a healthy sensor; for a healthy ring, that have such a sensor.
    open: u32,
    /// Logs that tell the readers of `oracle.rs`.
    told: [u32; 2],
}

impl Cell {
    fn counted(&self) -> Share {
        Share { count: self.named, of: self.logs - self.left_out }
    }

    /// Counts a log; none for one that is left out.
    fn add(&mut self, outcome: Option<Outcome>) {
        self.logs += 1;
        self.left_out += u32::from(outcome.is_none());
        self.named += u32::from(outcome.is_some_and(|outcome| outcome.is_named));
        self.blamed += u32::from(outcome.is_some_and(|outcome| outcome.blames));
        self.open += u32::from(outcome.is_some_and(|outcome| outcome.is_open));
        for (sum, of) in self.told.iter_mut().zip(outcome.map_or([false; 2], |outcome| outcome.told)) {
            *sum += u32::from(of);
        }
    }
}

/// A share with its 95 % interval in percent.
fn percent(share: Share) -> String {
    if share.of == 0 {
        return "-".to_owned();
    }
    let (low, high) = share.interval_95();
    format!("{} of {} ({:.1}-{:.1} %)", share.count, share.of, 100.0 * low, 100.0 * high)
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let mut arguments = arguments.iter();
    let mut next = |default: &str| arguments.next().map_or_else(|| default.to_owned(), String::clone);
    let (first, places): (u64, u64) = (next("20000").parse()?, next("50").parse()?);
    let physics_name = next("plain");
    let (physics, method): (Physics, Method) = (physics_name.parse()?, next("flow").parse()?);
    let robots = next("both");
    let columns: Vec<_> = [
        ("alcove, stands", Place::Alcove, Robots::Stand),
        ("alcove, drives", Place::Alcove, Robots::Drive),
        ("room, stands", Place::Room, Robots::Stand),
        ("room, drives", Place::Room, Robots::Drive),
    ]
    .into_iter()
    .filter(|column| match robots.as_str() {
        "stand" => column.2 == Robots::Stand,
        "drive" => column.2 == Robots::Drive,
        _ => true,
    })
    .collect();
    let names: Vec<_> = columns.iter().map(|column| column.0).collect();
    let names = names.join(" | ");
    println!(
        "{places} alcoves and {places} rooms from {first} on, {method}, physics {physics_name}; 95 % intervals.\n"
    );
    let rows: Vec<_> = Broken::ALL.into_iter().filter(|broken| broken.applies(method)).collect();
    let mut table = vec![vec![Cell::default(); columns.len()]; rows.len()];
    for (column, &(_, place, robots)) in columns.iter().enumerate() {
        let numbers: Vec<_> = (first..first + places).collect();
        let all = sweep(&numbers, |&number| {
            let cases = cases::cases(number, place, robots, method, physics, &rows);
            let outcome = |case: Option<cases::Case>| case.map(|case| case.outcome());
            let outcomes = |cases: Vec<_>| cases.into_iter().map(outcome).collect::<Vec<_>>();
            cases.map(outcomes).map_err(|error| format!("place {number}: {error}"))
        });
        for outcomes in all {
            table.iter_mut().zip(outcomes?).for_each(|(row, outcome)| row[column].add(outcome));
        }
    }
    println!("| fault | {names} |");
    println!("|---|{}", "---|".repeat(columns.len()));
    for (broken, cells) in rows.iter().zip(&table) {
        let cells: Vec<_> = cells.iter().map(|cell| percent(cell.counted())).collect();
        println!("| {} | {} |", broken.name(), cells.join(" | "));
    }
    println!("\n| logs left out, with another sensor blamed, and that cannot tell | {names} |");
    println!("|---|{}", "---|".repeat(columns.len()));
    for (broken, cells) in rows.iter().zip(&table) {
        let blamed = |cell: &Cell| {
            format!("{}, {} and {} of {}", cell.left_out, cell.blamed, cell.open, cell.logs - cell.left_out)
        };
        let cells: Vec<_> = cells.iter().map(blamed).collect();
        println!("| {} | {} |", broken.name(), cells.join(" | "));
    }
    println!("\n| logs that tell a reader who knows the scene, and one who knows the paths | {names} |");
    println!("|---|{}", "---|".repeat(columns.len()));
    for (broken, cells) in rows.iter().zip(&table).filter(|(broken, _)| broken.shows_in_readings()) {
        let told = |cell: &Cell| {
            let of = cell.logs - cell.left_out;
            let (scene, paths) = (cell.told[0], Share { count: cell.told[1], of });
            format!("{scene} and {}", percent(paths))
        };
        let cells: Vec<_> = cells.iter().map(told).collect();
        println!("| {} | {} |", broken.name(), cells.join(" | "));
    }
    Ok(())
}
