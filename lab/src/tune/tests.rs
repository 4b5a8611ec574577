//! Tests of the search on a few courses, and of the source as it is printed.

use std::fs;
use std::path::{Path, PathBuf};

use eeruf_sim::experiments::set_two::{Pilots, SetTwoOptions, set_two, steered_as};
use eeruf_sim::{Entry, Method, Physics};

use super::draw::candidate;
use super::log::Log;
use super::print::{row, source};
use super::score::{ROUNDS, Round, Score};
use super::search::{Search, Tuned};

const SMALL: [Round; 2] = [Round { pilots: 3, courses: 1 }, Round { pilots: 2, courses: 2 }];

/// Makes an empty folder for this test.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("eeruf-tune-{}-{name}", std::process::id()));
    fs::remove_dir_all(&folder).ok();
    folder
}

fn search(rounds: &[Round], folder: &Path) -> Tuned {
    let mut log = Log::open(folder, rounds).unwrap();
    Search {
        rounds,
        options: &SetTwoOptions { physics: Physics::PLAIN, ..SetTwoOptions::default() },
        method: Method::Eeruf,
    }
    .run(&mut log)
    .unwrap()
}

// A small search takes the pilot that finishes most and prints it.
#[test]
fn small_search_takes_the_best_pilot() {
    let folder = folder("small");
    let tuned = search(&SMALL, &folder);
    // The same search by hand takes the two best of three on course 0, then the better of those on 1 and 2.
    let value = |pilot: usize, first: u64, seeds: u64| -> f64 {
        let places = [None, Some(eeruf_sim::experiments::set_two::SECOND_BEHIND)];
        let ahead = Some(eeruf_sim::experiments::set_two::SECOND_AHEAD);
        let each = places.into_iter().chain([ahead]).map(|second_robot| {
            let pilots = Pilots::Given(candidate(pilot).piloting());
            let methods = Entry::all([Method::Eeruf]);
            let physics = Physics::PLAIN;
            let asked =
                SetTwoOptions { first, seeds, methods, second_robot, pilots, physics, ..SetTwoOptions::default() };
            let found = set_two(&asked, &|_| true).unwrap();
            let finished =
                found.runs[0].iter().filter(|run| run.ending == eeruf_sim::experiments::set_two::Ending::Finished);
            finished.map(|run| 1.0 - run.time_s / 160.0).sum::<f64>()
        });
        each.sum()
    };
    let mut first: Vec<_> = (0..3).map(|pilot| (pilot, value(pilot, 0, 1))).collect();
    first.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    let best = first[..2].iter().map(|&(pilot, _)| (pilot, value(pilot, 1, 2)));
    let (number, _) = best.reduce(|a, b| if b.1 > a.1 { b } else { a }).unwrap();
    assert_eq!(tuned.number, number);
    let text = source(&SMALL, &[(Method::Eeruf, tuned)]);
    assert!(text.contains("//! 3 pilots on courses 0 to 0,\n//! the best 2 on courses 1 to 2. The best is taken.\n"));
    assert!(text.contains(&format!("[(Method, Piloting); 1] = [\n    {}\n];\n", row(Method::Eeruf, &tuned))), "{text}");
    // A second run drives nothing: it takes all scores from the log.
    let path = folder.join("set-two-3x1-2x2.tsv");
    let logged = fs::read_to_string(&path).unwrap();
    assert_eq!(logged.lines().count(), 5);
    assert_eq!(search(&SMALL, &folder), tuned);
    assert_eq!(fs::read_to_string(&path).unwrap(), logged);
    // A run that was cut short resumes there and repeats the broken line.
    let cut = logged.len() - 3;
    fs::write(&path, &logged[..cut]).unwrap();
    assert_eq!(search(&SMALL, &folder), tuned);
    fs::remove_dir_all(&folder).ok();
}

// The pilots in the source are printed by this program, and are the ones that are driven.
#[test]
fn pilots_in_the_source_are_as_printed() {
    let file = include_str!("../../../crates/eeruf-sim/src/experiments/set_two/own_pilots.rs");
    let rows: Vec<&str> = file.lines().filter(|line| line.starts_with("    (Method::")).collect();
    let methods: Vec<_> = Method::ALL.into_iter().filter(|&method| steered_as(method) == method).collect();
    assert_eq!(rows.len(), methods.len());
    let found: Vec<_> = methods.into_iter().zip(&rows).map(|(method, row)| (method, read(method, row))).collect();
    assert_eq!(file, source(&ROUNDS, &found));
    for (method, tuned) in found {
        let (drawn, driven) = (tuned.pilot.piloting(), Pilots::Own.of(method));
        assert_eq!(drawn, driven, "{method}");
    }
}

/// Reads a line of the source: the candidate, and how often it finished.
fn read(method: Method, line: &str) -> Tuned {
    let finished = line.rsplit_once("// ").unwrap().1.split(", ").map(|count| count.parse().unwrap());
    let finished: Vec<u32> = finished.collect();
    let score = Score { finished: [finished[0], finished[1], finished[2]], time_s: 0.0 };
    let tuned = |number| Tuned { number, pilot: candidate(number), score };
    let candidates = 0..ROUNDS[0].pilots;
    candidates.map(tuned).find(|tuned| line.trim() == row(method, tuned)).expect("a line that the search can print")
}

#[test]
fn only_the_line_of_the_constant_is_replaced() {
    let text = "impl A {\n    pub const TUNED: Self = Self { a: 1 };\n}\n";
    let with = super::with_line(text, "    pub const TUNED: Self = x;");
    assert_eq!(with, "impl A {\n    pub const TUNED: Self = x;\n}\n");
}
