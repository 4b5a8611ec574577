//! Set I over random alcoves: one line for each method with the medians, and how fast it was.
//!
//! `cargo run --release -p eeruf-sim --example set_one_table -- [ALCOVES] [PERIODS]`

use std::time::Instant;

use eeruf_sim::{Method, Options, experiments::set_one::Alcove, quantile, simulate, sweep};

/// What stands over the medians.
const HEADINGS: [&str; 9] =
    ["crosst. %", "of acc.", "before", "rejected", "lost", "age ms", "p99 ms", "acc./s", "readings/s"];

fn main() {
    let argument = |place, default| std::env::args().nth(place).and_then(|text| text.parse().ok()).unwrap_or(default);
    let alcoves: Vec<u64> = (0..argument(1, 80)).collect();
    let options = Options::periods(argument(2, 1000) as u32);
    println!(
        "{:16} {:>20}{}",
        "method",
        "wrong % p10 med p90",
        HEADINGS.map(|heading| format!("{heading:>9}")).concat()
    );
    for method in Method::ALL {
        let start = Instant::now();
        let summaries = sweep(&alcoves, |&number| {
            let world = Alcove::random(number).world().expect("every random alcove has room");
            simulate(&world, method, &options).expect("Set I fits every method").summary()
        });
        let seconds = start.elapsed().as_secs_f64();
        let of = |share: f64, value: &dyn Fn(&eeruf_sim::Summary) -> f64| {
            quantile(&mut summaries.iter().map(value).collect::<Vec<_>>(), share)
        };
        let median = |value: &dyn Fn(&eeruf_sim::Summary) -> f64| of(0.5, value);
        let wrong = |s: &eeruf_sim::Summary| 100.0 * s.wrong_of_all;
        let readings: usize = summaries.iter().map(|summary| summary.readings).sum();
        println!(
            "{:16} {:6.2} {:6.2} {:6.2} {:8.2} {:8.2} {:8.2} {:8.2} {:8.2} {:8.1} {:8.1} {:8.1} {:10.0}",
            method.as_str(),
            of(0.1, &wrong),
            median(&wrong),
            of(0.9, &wrong),
            median(&|s| 100.0 * s.crosstalk_of_all),
            median(&|s| 100.0 * s.wrong_of_accepted.unwrap_or(0.0)),
            median(&|s| 100.0 * s.wrong_before_filter),
            median(&|s| 100.0 * s.rejected),
            median(&|s| 100.0 * s.good_lost.unwrap_or(0.0)),
            median(&|s| s.age_ms.median),
            median(&|s| s.age_ms.p99),
            median(&|s| s.readings_per_s),
            readings as f64 / seconds,
        );
    }
}
