//! Steps of the search to its answers, the same on each machine: recorded in `tests/data/period-effort.txt`. A change
//! of the search shows there what it costs or saves. `EERUF_WRITE=1` rewrites the file.

use std::fmt::Write as _;

use crate::alike::{Alike, Layout, conflicts, conflicts_where};
use crate::common::{Random, random_problem};
use eeruf_period::engine::Problem;
use eeruf_period::engine::search::FiringTimes;
use eeruf_period::engine::shortest::shortest;
use eeruf_period::engine::spare::most_to_spare;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/period-effort.txt");

/// The nodes that a question may cost.
const BUDGET: u64 = 3000;

/// FNV-1a hash of the times, which identifies a schedule.
fn sum([a, b]: &FiringTimes) -> u32 {
    let add = |sum: u64, time: &u32| (sum ^ u64::from(*time)).wrapping_mul(0x0100_0000_01b3);
    a.iter().chain(b).fold(0xcbf2_9ce4_8422_2325, add) as u32
}

/// The shortest period, and the schedule with most to spare.
fn ask(record: &mut String, name: &str, problem: &Problem) {
    let mut polls = 0;
    let mut go_on = |_: &_| {
        polls += 1;
        true
    };
    let found = shortest(problem, BUDGET, &mut go_on).expect("there is a schedule");
    let (period, bound, nodes) = (found.period, found.bound, found.nodes);
    writeln!(record, "{name}: {period} >= {bound}; {nodes} nodes, {polls} polls, {:08x}", sum(&found.fire)).unwrap();
    let spare = most_to_spare(problem, period, found.fire, BUDGET, &mut |_| true);
    let (more, proven, nodes) = (spare.more, spare.proven, spare.nodes);
    writeln!(record, "{name} to spare: {more:?} {proven:?}; {nodes} nodes, {:08x}", sum(&spare.fire)).unwrap();
}

/// Asks about rings, lines and blocks of usual sizes in ticks of different lengths, random graphs, and small rings
/// whose sensors differ.
fn ask_all() -> String {
    let mut record = String::new();
    for (name, layout, sensors, neighbours, scale) in [
        ("line", Layout::Line, 4, 4, 1),
        ("line", Layout::Line, 8, 4, 10),
        ("line", Layout::Line, 9, 3, 1),
        ("line", Layout::Line, 12, 4, 1),
        ("line", Layout::Line, 10, 5, 1),
        ("ring", Layout::Ring, 8, 4, 1),
        ("ring", Layout::Ring, 8, 4, 30),
        ("ring", Layout::Ring, 12, 4, 1),
        ("ring", Layout::Ring, 13, 3, 2),
        ("ring", Layout::Ring, 20, 4, 1),
        ("blocks", Layout::Blocks, 12, 4, 1),
        ("blocks", Layout::Blocks, 8, 3, 4),
    ] {
        let rows = conflicts(layout, sensors, neighbours);
        for (window, extra, stale_echo) in [(30, 0, false), (15, 1, true)] {
            // With one tick more of separation no coarser tick measures all three.
            let (separation, interval, window) = (2 * scale + extra, 15 * scale, window * scale);
            let problem = Alike { conflicts: &rows, separation, interval, window, stale_echo }.problem();
            ask(&mut record, &format!("{name} {sensors}/{neighbours} x{scale} window {window}"), &problem);
        }
    }
    let mut random = Random(20_261_123);
    for case in 0..24 {
        let sensors = 3 + random.up_to(7) as usize;
        let density = 30 + random.up_to(60);
        let mut drawn = vec![false; sensors * sensors];
        drawn.fill_with(|| random.up_to(99) < density);
        let rows = conflicts_where(sensors, |x, y| drawn[x * sensors + y]);
        let scale = [1, 1, 2, 5][case % 4];
        let mut any = |least, most| least + random.up_to(most - least);
        let (separation, interval) = (any(1, 5) * scale, any(3, 20) * scale);
        let (window, stale_echo) = (any(2, 60) * scale, any(0, 3) == 0);
        let problem = Alike { conflicts: &rows, separation, interval, window, stale_echo }.problem();
        ask(&mut record, &format!("graph {case} of {sensors}"), &problem);
    }
    for seed in 0..24 {
        let problem = random_problem(&mut Random(20_000 + seed));
        if shortest(&problem, 0, &mut |_| true).is_some() {
            ask(&mut record, &format!("sensors that differ, {seed}"), &problem);
        }
    }
    record
}

#[test]
fn each_search_takes_the_steps_that_are_written_down() {
    let now = ask_all();
    if std::env::var_os("EERUF_WRITE").is_some() {
        std::fs::write(FILE, &now).unwrap();
    }
    let kept = std::fs::read_to_string(FILE).unwrap_or_default();
    for (kept, now) in kept.lines().zip(now.lines()) {
        assert_eq!(now, kept, "the search takes other steps than are written down; EERUF_WRITE=1 rewrites them");
    }
    assert_eq!(now.lines().count(), kept.lines().count(), "EERUF_WRITE=1 writes what is asked now");
}
