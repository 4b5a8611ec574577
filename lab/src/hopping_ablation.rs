//! Worth of each part of time hopping in Set I, as the table of `docs/explanation/hopping.md`: every row leaves one
//! part out.
//!
//! `cargo lab hopping-ablation [SEEDS [FIRST [PHYSICS]]]`

use eeruf_core::{Micros, hopping::HoppingSettings, judge::TrackerSettings};
use eeruf_sim::experiments::Spread;
use eeruf_sim::experiments::set_one::{Latency, SetOneOptions, set_one};
use eeruf_sim::{Entry, Method, Physics};

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let mut arguments = arguments.iter();
    let mut number = |default| arguments.next().map_or(Ok(default), |argument| argument.parse::<u64>());
    let (seeds, first) = (number(200)?, number(20_000)?);
    let physics = arguments.next().map_or(Ok(Physics::DEFAULT), |name| name.parse())?;
    print!("| | belief right % | phantom % | wrong, % of all | confirmed | good lost % | blind | age 99 %, ms ");
    println!("| accepted/s | nearer | farther |");
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for (name, hopping) in rows() {
        let methods = Entry::all([Method::EerufHopping]);
        let asked = SetOneOptions { seeds, first, methods, hopping, physics, ..SetOneOptions::default() };
        let table = set_one(&asked, &|_| true)?;
        for (_, figures) in &table.methods {
            println!(
                "| {name} | {} | {} | {} | {} | {} | {:.2} | {} | {} | {} | {} |",
                mean(figures.belief_right),
                mean(figures.phantom),
                percents(figures.wrong_of_all),
                percents(figures.confirmed_wrong_of_all),
                percents(figures.good_lost),
                figures.blind,
                median(figures.age_p99_ms),
                median(figures.readings_per_s),
                latency(figures.nearer),
                latency(figures.farther),
            );
        }
    }
    Ok(())
}

fn rows() -> [(&'static str, HoppingSettings); 8] {
    const ALL: HoppingSettings = HoppingSettings::BALANCED;
    const TRACKER: TrackerSettings = TrackerSettings::BALANCED;
    [
        ("balanced", ALL),
        ("lags that move, 8 ms apart", ALL.with_shift_after(5)),
        ("lags that move freely", ALL.with_shift_after(5).with_shift_interval(Micros::ZERO)),
        ("no solo periods: `driving`", HoppingSettings::DRIVING),
        ("confirmed alone", ALL.with_tracker(TRACKER.with_tentative_votes(0))),
        ("3 votes confirm", ALL.with_tracker(TRACKER.with_votes(3).with_score_limit(4))),
        ("accepted within t_delta alone", ALL.with_tracker(TRACKER.with_near(Micros::new(150)))),
        ("a contradiction takes 1", ALL.with_tracker(TRACKER.with_contradiction(1))),
    ]
}

fn percents(spread: Option<Spread>) -> String {
    spread.map_or_else(String::new, |spread| format!("{:.1} / {:.1}", 100.0 * spread.median, 100.0 * spread.p90))
}

fn mean(share: Option<Spread>) -> String {
    share.map_or_else(String::new, |spread| {
        let [low, high] = spread.mean_95.map(|mean| 100.0 * mean);
        format!("{:.2} ({low:.2}-{high:.2})", 100.0 * spread.mean)
    })
}

fn median(spread: Option<Spread>) -> String {
    spread.map_or_else(String::new, |spread| format!("{:.0}", spread.median))
}

fn latency(latency: Option<Latency>) -> String {
    let periods = |periods: Option<u32>| periods.map_or_else(|| "never".to_owned(), |periods| periods.to_string());
    latency.map_or_else(String::new, |Latency { median, p90, never, .. }| {
        format!("{} / {}, {:.1} %", periods(median), periods(p90), 100.0 * never)
    })
}
