//! Counts the tables of one wait-time problem, for comparison with other solvers: prints the count and the least time
//! of ten runs.
//!
//! Arguments, times in ticks: sensors, period, longest wait, group of lags, separation, interval, neighbours, `paper`
//! or `exact`, and `line`, `ring` or `blocks`.

use eeruf_core::search::{Budget, COUNT_WORDS, WaitProblem, WaitSearch};
use eeruf_core::{Criterion, Layout, Micros};
use std::time::Instant;

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let [numbers @ .., criterion, layout] = arguments else {
        return Err("nine arguments are expected".into());
    };
    let numbers = numbers.iter().map(|arg| arg.parse()).collect::<Result<Vec<u32>, _>>()?;
    let [sensors, period, wait_max, group, separation, interval, neighbours] = numbers[..] else {
        return Err("nine arguments are expected".into());
    };
    // A tick is 2 us, so that D ticks are what a `t_delta` of D - 1 us needs.
    let us = |ticks: u32| Micros::new(2 * ticks);
    let lag: Vec<Micros> = (0..sensors).map(|i| us((i % group) * period / group)).collect();
    let neighbours = u8::try_from(neighbours)?;
    let layout = match layout.as_str() {
        "blocks" => Layout::Blocks(neighbours),
        "ring" => Layout::Ring(neighbours),
        _ => Layout::Line(neighbours),
    };
    let criterion = if criterion == "exact" { Criterion::Exact } else { Criterion::Paper };
    let search = WaitSearch::new(&WaitProblem {
        sensors: lag.len(),
        period: us(period),
        wait_max: us(wait_max),
        tick: us(1),
        t_lag: Some(&lag),
        t_delta: Micros::new(separation.checked_sub(1).ok_or("a separation of 0; expected 1 or more")?),
        min_interval: us(interval),
        neighbours,
        layout,
        criterion,
    })?;
    let mut memory = vec![0; COUNT_WORDS];
    let (mut least, mut count) = (f64::INFINITY, 0);
    for _ in 0..10 {
        let start = Instant::now();
        (_, count) = search.count(None, &mut memory, &mut Budget::unlimited());
        least = least.min(start.elapsed().as_secs_f64());
    }
    println!("{count} {least:.9}");
    Ok(())
}
