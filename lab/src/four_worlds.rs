//! Set I in four worlds, flat or in a room, with the constant gain or with the Polaroid's own.
//!
//! ```text
//! cargo lab four-worlds [interference]
//! ```
//!
//! With `interference`, sounds that arrive within a burst of each other add up.

use eeruf_sim::experiments::set_one::{SetOneOptions, set_one};
use eeruf_sim::*;

const METHODS: [Method; 5] = [Method::Sequential, Method::Conventional, Method::Eeruf, Method::Flow, Method::MultiEcho];
const WORLDS: [(&str, Option<Room>, GainProfile); 4] = [
    ("flat, constant", None, GainProfile::Constant),
    ("flat, polaroid_6500", None, GainProfile::Polaroid6500),
    ("room, constant", Some(Room::DEFAULT), GainProfile::Constant),
    ("room, polaroid_6500", Some(Room::DEFAULT), GainProfile::Polaroid6500),
];
const ALCOVES: u64 = 100;

/// Prints a table with a row for each method and a column for each world.
fn table(columns: &[Vec<String>]) {
    println!("| method | {} |", WORLDS.map(|(name, ..)| name).join(" | "));
    println!("|---|{}", "---:|".repeat(WORLDS.len()));
    for (place, method) in METHODS.iter().enumerate() {
        let cells: Vec<_> = columns.iter().map(|column| column[place].as_str()).collect();
        println!("| {method} | {} |", cells.join(" | "));
    }
    println!();
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let percent = |share: Option<f64>| share.map_or("-".to_owned(), |share| format!("{:.1}", 100.0 * share));
    let interference = arguments.first().is_some_and(|word| word == "interference");
    let physics = Physics { interference, ..Physics::DEFAULT };
    let mut alcoves = Vec::new();
    for (_, room, gain) in WORLDS {
        let transducer = Transducer { gain, ..Transducer::POLAROID_6500 };
        let methods = Entry::all(METHODS);
        let asked =
            SetOneOptions { seeds: ALCOVES, steps: 0, methods, room, transducer, physics, ..SetOneOptions::default() };
        let found = set_one(&asked, &|_| true)?;
        let cell = |figures: &experiments::set_one::Figures| {
            let [wrong, lost] = [figures.wrong_of_all, figures.good_lost].map(|spread| spread.map(|it| it.median));
            format!("{} / {}", percent(wrong), percent(lost))
        };
        alcoves.push(found.methods.iter().map(|(_, figures)| cell(figures)).collect());
    }
    println!("Set I, {ALCOVES} alcoves: wrong, % of all / good lost %, medians:\n");
    table(&alcoves);
    Ok(())
}
