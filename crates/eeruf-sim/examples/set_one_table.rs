//! Set I over random alcoves: one line for each method.
//!
//! `cargo run --release -p eeruf-sim --example set_one_table -- [ALCOVES]`

use std::time::Instant;

use eeruf_sim::{
    Method,
    best::best_for,
    experiments::{
        Spread,
        set_one::{Alcove, READINGS, set_one},
    },
};

fn main() {
    let seeds = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(200);
    let best = best_for(&Alcove::random(0).robot(), 300_000, |_| true).expect("eight sensors are not too many");
    println!("best: {} (proven: {})", best.schedule.period(), best.proven);
    let start = Instant::now();
    let table = set_one(seeds, READINGS, &Method::ALL, Some(&best), &|_| true).expect("Set I fits every method");
    let seconds = start.elapsed().as_secs_f64();
    println!("{seeds} alcoves of {READINGS} readings in {seconds:.1} s; 10 % / median / 90 %");
    println!(
        "{:16}{:>20}{:>20}{:>20}{:>20}{:>9}{:>9}{:>8}{:>8}",
        "method",
        "wrong of all %",
        "wrong of accepted %",
        "rejected %",
        "good lost %",
        "age ms",
        "99 %",
        "per s",
        "starved"
    );
    let three = |spread: Option<Spread>| {
        spread
            .map_or_else(String::new, |s| format!("{:.2} {:.2} {:.2}", 100.0 * s.p10, 100.0 * s.median, 100.0 * s.p90))
    };
    let median = |spread: Option<Spread>| spread.map_or(f64::NAN, |s| s.median);
    for (method, figures) in &table.methods {
        println!(
            "{:16}{:>20}{:>20}{:>20}{:>20}{:>9.0}{:>9.0}{:>8.1}{:>8.2}",
            method.as_str(),
            three(figures.wrong_of_all),
            three(figures.wrong_of_accepted),
            three(figures.rejected),
            three(figures.good_lost),
            median(figures.age_ms),
            median(figures.age_p99_ms),
            median(figures.readings_per_s),
            figures.starved
        );
    }
}
