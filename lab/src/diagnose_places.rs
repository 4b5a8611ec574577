//! Success of `diagnose` at naming the senders of foreign readings, where the simulator knows them: `cargo lab
//! diagnose-places [FIRST [PLACES [METHOD [PERIODS [PHYSICS]]]]]`. Robots stand in alcoves of Set I.

use eeruf_logs::{Settings, diagnose};
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::{Cause, Method, Options, Physics, quantile, simulate, sweep};

/// Counts for one alcove, or for all.
#[derive(Clone, Copy, Default)]
struct Counts {
    /// Readings caused by foreign sound.
    foreign: usize,
    /// Pairs for which the right sender is named.
    right: usize,
    /// Readings called foreign.
    named: usize,
    /// Readings with an edge.
    readings: usize,
    /// Numbers of paths reported, and of reported paths that no sound took.
    paths: usize,
    accidental: usize,
    /// Number of reported faults, all of them false.
    faults: usize,
}

fn count(number: u64, method: Method, periods: u32, physics: Physics) -> Result<Counts, String> {
    let world = Alcove::random(number).world().and_then(|world| world.with_physics(physics));
    let world = world.map_err(|error| error.to_string())?;
    let readings = simulate(&world, method, &Options::periods(periods)).map_err(|error| error.to_string())?;
    let c = world.scene().air().speed_of_sound();
    // Readings come in the order in which windows end; a log is in the order of firings.
    let mut order: Vec<_> = (0..readings.len()).filter(|&k| readings.robot[k] == 0).collect();
    let at_us = |k: usize| (1e6 * readings.fired_s[k]).round() as i64;
    order.sort_by_key(|&k| at_us(k));
    let diagnosis = diagnose(&eeruf::firing_log(&readings), &Settings::default());
    let mut counts = Counts { paths: diagnosis.paths.len(), faults: diagnosis.faults.len(), ..Counts::default() };
    for (&k, named) in order.iter().zip(&diagnosis.named) {
        counts.readings += usize::from(!readings.earliest_us[k].is_nan());
        let sender = readings.path_of(k).map(|path| path.emitter.sensor);
        let foreign = readings.cause[k] == Cause::Crosstalk;
        counts.foreign += usize::from(foreign);
        if let Some(named) = named.filter(|named| named.sender != readings.sensor[k]) {
            counts.named += 1;
            counts.right += usize::from(foreign && sender == Some(named.sender));
        }
    }
    let is_real = |path: &&eeruf_logs::FoundPath| {
        readings.paths.iter().any(|heard| {
            let travel_us = 1e6 * heard.length_m / c;
            (heard.emitter.sensor, heard.receiver.sensor) == (path.sender, path.receiver)
                && (travel_us - path.travel_us).abs() < 75.0
        })
    };
    counts.accidental = counts.paths - diagnosis.paths.iter().filter(is_real).count();
    Ok(counts)
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let mut arguments = arguments.iter();
    let mut next = |default: &str| arguments.next().map_or_else(|| default.to_owned(), String::clone);
    let (first, places): (u64, u64) = (next("20000").parse()?, next("200").parse()?);
    let (method, periods): (Method, u32) = (next("flow").parse()?, next("1000").parse()?);
    let physics = next("plain");
    let effects: Physics = physics.parse()?;
    let numbers: Vec<_> = (first..first + places).collect();
    let all = sweep(&numbers, |&number| count(number, method, periods, effects))
        .into_iter()
        .collect::<Result<Vec<_>, _>>()?;
    let sum = |of: fn(&Counts) -> usize| all.iter().map(of).sum::<usize>();
    let (foreign, right, named) = (sum(|c| c.foreign), sum(|c| c.right), sum(|c| c.named));
    let percent = |part: usize, of: usize| 100.0 * part as f64 / of.max(1) as f64;
    println!("{places} alcoves from {first} on, {method}, {periods} periods each, physics {physics}");
    println!("readings: {}, of which foreign sound caused {foreign}", sum(|c| c.readings));
    println!("named rightly: {right}, {:.1} % of those", percent(right, foreign));
    println!("named: {named}, of which rightly {:.2} %", percent(right, named));
    let mut shares: Vec<_> = all.iter().filter(|c| c.foreign >= 50).map(|c| percent(c.right, c.foreign)).collect();
    let shares: Vec<_> = [0.1, 0.5, 0.9].map(|share| format!("{:.0}", quantile(&mut shares, share))).into();
    println!("share named rightly, 10 % / median / 90 % of the places: {} %", shares.join(" / "));
    let mut wrong: Vec<_> = all.iter().map(|c| c.named - c.right).collect();
    wrong.sort_unstable();
    println!("wrong names in a place: median {}, most {}", wrong[wrong.len() / 2], wrong[wrong.len() - 1]);
    println!("paths: {}, of which no sound took {}", sum(|c| c.paths), sum(|c| c.accidental));
    println!("said to be broken, where nothing is: {}", sum(|c| c.faults));
    Ok(())
}
