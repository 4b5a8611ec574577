//! Counts the tables of one wait-time problem, for comparison with other solvers: prints the count and the least time
//! of ten runs.
//!
//! Arguments, times in ticks: sensors, period, longest wait, group of lags, separation, interval, neighbours, `paper`
//! or `exact`, and `line`, `ring` or `blocks`.

use eeruf_core::search::wait::{Budget, COUNT_WORDS, Problem, Search};
use eeruf_core::{Criterion, Layout};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [numbers @ .., criterion, layout] = args.as_slice() else {
        return Err("nine arguments are expected".into());
    };
    let numbers = numbers.iter().map(|arg| arg.parse()).collect::<Result<Vec<u32>, _>>()?;
    let [sensors, period, wait_max, group, separation, interval, neighbours] = numbers[..] else {
        return Err("nine arguments are expected".into());
    };
    let lag: Vec<u32> = (0..sensors).map(|i| (i % group) * period / group).collect();
    let neighbours = u8::try_from(neighbours)?;
    let rows = match layout.as_str() {
        "blocks" => Layout::Blocks(neighbours),
        "ring" => Layout::Ring(neighbours),
        _ => Layout::Line(neighbours),
    }
    .rows(lag.len());
    let conflicts = rows.get(..lag.len()).unwrap_or(&rows);
    let criterion = if criterion == "exact" { Criterion::Exact } else { Criterion::Paper };
    let problem = Problem { period, lag: &lag, wait_max, separation, interval, conflicts, criterion };
    let search = Search::new(problem)?;
    let mut memory = vec![0; COUNT_WORDS];
    let (mut least, mut count) = (f64::INFINITY, 0);
    for _ in 0..10 {
        let start = Instant::now();
        count = search.count(None, &mut memory, &mut Budget::unlimited()).count;
        least = least.min(start.elapsed().as_secs_f64());
    }
    println!("{count} {least:.9}");
    Ok(())
}
