//! Counts the tables of one wait-time problem, for comparison with other solvers: prints the count and the least time of ten runs.
//!
//! Arguments, times in ticks: sensors, period, longest wait, group of lags, separation, interval, neighbours, `paper` or `exact`, and
//! `line`, `ring` or `blocks`.

use eeruf_core::Criterion;
use eeruf_core::search::wait::{COUNT_WORDS, Control, Problem, Search};
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
    let close = |i: u32, j: u32| {
        let apart = i.abs_diff(j);
        match layout.as_str() {
            "blocks" => i / neighbours == j / neighbours,
            "ring" => apart.min(sensors - apart) < neighbours,
            _ => apart < neighbours,
        }
    };
    let lag: Vec<u32> = (0..sensors).map(|i| (i % group) * period / group).collect();
    let conflicts: Vec<u64> =
        (0..sensors).map(|i| (0..sensors).filter(|&j| i != j && close(i, j)).map(|j| 1 << j).sum()).collect();
    let criterion = if criterion == "exact" { Criterion::Exact } else { Criterion::Paper };
    let problem = Problem { period, lag: &lag, wait_max, separation, interval, conflicts: &conflicts, criterion };
    let search = Search::new(problem)?;
    let mut memory = vec![0; COUNT_WORDS];
    let (mut least, mut count) = (f64::INFINITY, 0);
    for _ in 0..10 {
        let start = Instant::now();
        count = search.count(None, &mut memory, &mut Control::unlimited()).count;
        least = least.min(start.elapsed().as_secs_f64());
    }
    println!("{count} {least:.9}");
    Ok(())
}
