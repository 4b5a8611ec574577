//! Success of `diagnose` at naming the senders of foreign readings, where the simulator knows them: `cargo lab
//! diagnose-places [FIRST [PLACES [METHOD [PERIODS [PHYSICS [WHERE]]]]]]`. Robots stand if WHERE is `alcoves` (Set I).
//! They drive in `alcoves-driving`, `rooms-driving` and `courses` (Set II), where a pilot steers until the course ends.

use std::error::Error;

use eeruf_logs::{Settings, diagnose};
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::experiments::set_two::{SetTwoOptions, drive};
use eeruf_sim::{Cause, Entry, Method, Options, Physics, Readings, quantile, simulate, sweep};

use crate::driving::{Place, world};

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
    /// 1 if the robot is said to have moved.
    moved: usize,
}

/// The places, and the robots' motion there.
#[derive(Clone, Copy, PartialEq)]
enum Where {
    Alcoves,
    Courses,
    Driving(Place),
}

impl Where {
    const ALL: [(&'static str, Self); 4] = [
        ("alcoves", Self::Alcoves),
        ("courses", Self::Courses),
        ("alcoves-driving", Self::Driving(Place::Alcove)),
        ("rooms-driving", Self::Driving(Place::Room)),
    ];

    /// Returns the readings there, and the speed of sound.
    fn readings(
        self,
        number: u64,
        method: Method,
        periods: u32,
        physics: Physics,
    ) -> Result<(Readings, f64), Box<dyn Error>> {
        let world = match self {
            Self::Courses => {
                let options = SetTwoOptions { physics, ..SetTwoOptions::default() };
                let driven = drive(&options, &Entry::from(method), number, &|_| true)?;
                return Ok((driven.readings, driven.world.scene().air().speed_of_sound()));
            }
            Self::Alcoves => Alcove::random(number).world()?.with_physics(physics)?,
            Self::Driving(place) => world(number, place, physics)?,
        };
        let readings = simulate(&world, method, &Options::periods(periods))?;
        Ok((readings, world.scene().air().speed_of_sound()))
    }
}

fn count(number: u64, place: Where, method: Method, periods: u32, physics: Physics) -> Result<Counts, String> {
    let read = place.readings(number, method, periods, physics);
    let (readings, c) = read.map_err(|error| format!("place {number}: {error}"))?;
    // Readings come in the order in which windows end; a log is in the order of firings.
    let mut order: Vec<_> = (0..readings.len()).filter(|&k| readings.robot[k] == 0).collect();
    let at_us = |k: usize| (1e6 * readings.fired_s[k]).round() as i64;
    order.sort_by_key(|&k| at_us(k));
    let diagnosis = diagnose(&eeruf::firing_log(&readings), &Settings::default());
    let mut counts = Counts {
        paths: diagnosis.paths.len(),
        faults: diagnosis.faults.len(),
        moved: diagnosis.moved.into(),
        ..Counts::default()
    };
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
    let name = next("alcoves");
    let place = Where::ALL.iter().find(|(known, _)| *known == name).map(|(_, place)| *place);
    let place = place.ok_or_else(|| format!("WHERE is {name}; expected alcoves, courses or a place with -driving"))?;
    let numbers: Vec<_> = (first..first + places).collect();
    let all = sweep(&numbers, |&number| count(number, place, method, periods, effects))
        .into_iter()
        .collect::<Result<Vec<_>, _>>()?;
    let sum = |of: fn(&Counts) -> usize| all.iter().map(of).sum::<usize>();
    let (foreign, right, named) = (sum(|c| c.foreign), sum(|c| c.right), sum(|c| c.named));
    let percent = |part: usize, of: usize| 100.0 * part as f64 / of.max(1) as f64;
    let each = if place == Where::Courses { String::new() } else { format!(", {periods} periods each") };
    println!("{places} {name} from {first} on, {method}{each}, physics {physics}");
    println!("readings: {}, of which foreign sound caused {foreign}", sum(|c| c.readings));
    println!("named rightly: {right}, {:.1} % of those", percent(right, foreign));
    println!("named: {named}, of which rightly {:.2} %", percent(right, named));
    let mut shares: Vec<_> = all.iter().filter(|c| c.foreign >= 50).map(|c| percent(c.right, c.foreign)).collect();
    let shares: Vec<_> = [0.1, 0.5, 0.9].map(|share| format!("{:.0}", quantile(&mut shares, share))).into();
    println!("share named rightly, 10 % / median / 90 % of the places: {} %", shares.join(" / "));
    let mut wrong: Vec<_> = all.iter().map(|c| c.named - c.right).collect();
    wrong.sort_unstable();
    println!("wrong names in a place: median {}, most {}", wrong[wrong.len() / 2], wrong[wrong.len() - 1]);
    if place == Where::Alcoves {
        println!("paths: {}, of which no sound took {}", sum(|c| c.paths), sum(|c| c.accidental));
    } else {
        println!("said to have moved: {} of {places}; paths: {}", sum(|c| c.moved), sum(|c| c.paths));
    }
    println!("said to be broken, where nothing is: {}", sum(|c| c.faults));
    Ok(())
}
