//! Losses of a hopping ring to lateness, and how often paths that agree by accident are believed, in a naive world:
//! sound leaves when a sensor fires and arrives a fixed time later; each sensor reports the first.
//!
//! `cargo lab hopping-limits` prints the tables of `docs/explanation/hopping.md`.

#[expect(unreachable_pub, reason = "the tests share it")]
#[path = "../../crates/eeruf-core/tests/all/common/random.rs"]
mod random;

use eeruf_core::{
    Instant, Micros, ReadingKind, RingEvent,
    hopping::{HoppingCode, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings},
};
use random::Random;

const SENSORS: usize = 8;
const PERIOD: u32 = 60_000;
const WINDOW: u32 = 36_000;
const BLANKING: u32 = 2380;
/// Drawn for the published figures, as the simulator's worlds are.
const FIRST_SEED: u64 = 20_000;

/// Sound from one sensor to another, in microseconds.
#[derive(Clone, Copy)]
struct Path {
    from: u8,
    to: u8,
    length: u32,
}

/// Counts of the readings of some sensors.
#[derive(Clone, Copy, Default)]
struct Count {
    readings: u32,
    accepted: u32,
    tentative: u32,
    /// Accepted or tentative, and not the sensor's own echo.
    wrong: u32,
}

impl Count {
    fn add(&mut self, other: Self) {
        self.readings += other.readings;
        self.accepted += other.accepted;
        self.tentative += other.tentative;
        self.wrong += other.wrong;
    }
}

/// A ring in a world of these paths; each poll is up to `late` microseconds late.
fn run(paths: &[Path], step: u32, settings: HoppingSettings, late: u32, seed: u64, periods: u32) -> Count {
    let code = HoppingCode::new(SENSORS, 2, Micros::new(step)).expect("a step above 0");
    let schedule = HoppingSchedule::<SENSORS>::spread(code, Micros::new(PERIOD)).expect("room for the code");
    let listening = HoppingListening::new(Micros::new(WINDOW)).with_blanking(Micros::new(BLANKING));
    let (mut random, start) = (Random(seed), Instant::from_micros(0));
    let mut ring = HoppingRing::<SENSORS>::hopping(&schedule, settings, listening, seed as u32, start)
        .expect("settings that agree with the code");
    let own: [Option<u32>; SENSORS] =
        std::array::from_fn(|x| paths.iter().find(|path| path.from == path.to && path.to == x as u8).map(|p| p.length));
    let (mut count, mut arrivals, mut ended) = (Count::default(), Vec::<(u32, u8)>::new(), 0);
    while ended < periods {
        let now = ring.next_deadline().as_micros() + random.up_to(late);
        arrivals.sort_unstable();
        while let Some(&(at, to)) = arrivals.first().filter(|arrival| arrival.0 <= now) {
            ring.echo(to, Instant::from_micros(at)).expect("a sensor of the ring");
            arrivals.remove(0);
        }
        while let Some(event) = ring.poll(Instant::from_micros(now)) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let heard = paths.iter().filter(|path| path.from == sensor);
                    arrivals.extend(heard.map(|path| (now + path.length, path.to)));
                }
                RingEvent::Reading(reading) if paths.iter().any(|path| path.to == reading.sensor) => {
                    let (accepted, tentative) =
                        (reading.kind == ReadingKind::Accepted, reading.kind == ReadingKind::Tentative);
                    let is_own = own[usize::from(reading.sensor)]
                        .zip(reading.t_echo)
                        .is_some_and(|(own, t_echo)| t_echo.as_micros().abs_diff(own) <= 500);
                    count.add(Count {
                        readings: 1,
                        accepted: accepted.into(),
                        tentative: tentative.into(),
                        wrong: ((accepted || tentative) && !is_own).into(),
                    });
                }
                RingEvent::Reading(_) => {}
                RingEvent::PeriodEnded(_) => ended += 1,
            }
        }
    }
    count
}

/// Each sensor before a wall, and a path to it from each other one with this chance, in percent.
fn room(random: &mut Random, chance: u32) -> Vec<Path> {
    let mut paths = Vec::new();
    for to in 0..SENSORS as u8 {
        paths.push(Path { from: to, to, length: 3000 + random.up_to(20_000) });
        for from in (0..SENSORS as u8).filter(|&from| from != to) {
            if random.up_to(99) < chance {
                paths.push(Path { from, to, length: 3000 + random.up_to(WINDOW - 3000) });
            }
        }
    }
    paths
}

fn percent(part: u32, whole: u32) -> f64 {
    100.0 * f64::from(part) / f64::from(whole.max(1))
}

fn lateness() {
    const ROOMS: u64 = 100;
    const STEPS: [u32; 4] = [240, 301, 460, 652];
    println!(
        "Lateness: {ROOMS} rooms from {FIRST_SEED} on, 8 sensors before a wall each, 400 periods of 60 ms, from each \
         sensor to each other a path with a chance of 30 %; believed, in % of the readings / of it wrong.\n"
    );
    println!("| each poll is late by up to |{}", STEPS.map(|step| format!(" d = {step} us |")).concat());
    println!("|---:|{}", "---:|".repeat(STEPS.len()));
    for late in [0, 10, 30, 44, 60, 90, 150, 250] {
        print!("| {late} us |");
        for step in STEPS {
            let mut all = Count::default();
            for seed in FIRST_SEED..FIRST_SEED + ROOMS {
                let paths = room(&mut Random(seed), 30);
                all.add(run(&paths, step, HoppingSettings::BALANCED, late, seed, 400));
            }
            let believed = all.accepted + all.tentative;
            print!(" {:.1} / {:.2} |", percent(believed, all.readings), percent(all.wrong, believed));
        }
        println!();
    }
}

/// `C(n, k) (2 T / S)^(k - 1)`: how many sets of k of n readings spread over S agree within T, in a cycle.
fn agreeing(n: u32, k: u32, within: f64, spread: f64) -> f64 {
    let choose = (0..k).fold(1.0, |product, i| product * f64::from(n - i) / f64::from(i + 1));
    choose * (2.0 * within / spread).powi(k as i32 - 1)
}

fn chance() {
    const WORLDS: u64 = 4000;
    println!(
        "\nChance: {WORLDS} worlds from {FIRST_SEED} on, 110 periods; some paths of random lengths, from different \
         sensors, to one that hears nothing else.\n"
    );
    println!(
        "| paths | settings | worlds with any believed % | readings confirmed % | estimate | tentative % | estimate |"
    );
    println!("|---:|---|---:|---:|---:|---:|---:|");
    let (phases, spread) = (11, f64::from(WINDOW - BLANKING));
    for number in [1, 2, 3, 7] {
        for (name, settings) in [("balanced", HoppingSettings::BALANCED), ("quick", HoppingSettings::QUICK)] {
            let (mut all, mut worlds) = (Count::default(), 0);
            for seed in FIRST_SEED..FIRST_SEED + WORLDS {
                let mut random = Random(seed);
                // All of them to sensor 0, which has nothing of its own to hear.
                let mut from: Vec<u8> = (1..SENSORS as u8).collect();
                let paths: Vec<Path> = (0..number)
                    .map(|_| {
                        let from = from.remove(random.up_to(from.len() as u32 - 1) as usize);
                        Path { from, to: 0, length: BLANKING + random.up_to(WINDOW - BLANKING) }
                    })
                    .collect();
                let count = run(&paths, 240, settings, 0, seed, 110);
                worlds += u32::from(count.wrong > 0);
                all.add(count);
            }
            // Sets of readings that agree, a cycle, for each of whose readings one of the phases counts.
            let tracker = settings.tracker;
            let share = |votes: u8, within: Micros| {
                let sets = agreeing(phases, votes.into(), f64::from(within.as_micros()), spread);
                100.0 * (sets * f64::from(votes) / f64::from(phases)).min(1.0)
            };
            println!(
                "| {number} | {name} | {:.1} | {:.4} | {:.4} | {:.2} | {:.1} |",
                percent(worlds, WORLDS as u32),
                percent(all.accepted, all.readings),
                share(tracker.votes, tracker.t_delta),
                percent(all.tentative, all.readings),
                share(tracker.tentative_votes, tracker.tentative_within),
            );
        }
    }
}

pub(crate) fn main(_: &[String]) -> crate::Answer {
    lateness();
    chance();
    Ok(())
}
