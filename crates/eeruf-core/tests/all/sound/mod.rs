//! The promise of a ring, at any firing times: one path of sound, audible for no longer than R and changing by no more
//! than P, is never accepted, and a reading that nothing foreign explains always is. [`world`] performs every operation
//! on a ring; [`model`] applies the rule and forgets nothing.
//!
//! The long run: `EERUF_SOUND=10000000 cargo test --release -p eeruf-core --test all -- sound`.

mod model;
mod world;

use eeruf_core::tables::{TABLE_I_B, TABLE_I_D};
use eeruf_core::{
    Instant, Layout, Micros, ReadingKind, Requirements, Ring, RingConfig, RingEvent, Schedule, VerifiedSchedule,
};

use eeruf_period::PeriodProblem;

use crate::common::random::Random;
use model::Sound;
use world::{Count, Course, Heard, ROOM, STEPS, World};

/// A table, verified or not, and the largest `t_delta` that it serves.
struct Table {
    schedule: Schedule<ROOM>,
    verified: Option<VerifiedSchedule<ROOM>>,
    t_delta: u32,
}

/// A copy of a table with capacity for more sensors.
fn roomy<const K: usize>(table: &Schedule<K>) -> Schedule<ROOM> {
    let of = |phase| -> Vec<Micros> { (0..table.sensors()).map(|x| table.t_fire(phase, x).unwrap()).collect() };
    let lags = vec![Micros::ZERO; table.sensors()];
    let [a, b] = [eeruf_core::Phase::A, eeruf_core::Phase::B].map(of);
    Schedule::from_slices(table.period(), &lags, [&a, &b]).unwrap()
}

/// A table of random firing times, which need not meet (13a), (13b).
fn random_table(random: &mut Random) -> Table {
    let sensors = 2 + random.up_to(22) as usize;
    let period = 40_000 + random.up_to(80_000);
    let width = 1 + random.up_to(period / 3);
    let lag: Vec<u32> = (0..sensors).map(|_| random.up_to(period - 1 - width)).collect();
    let mut phase = || -> Vec<Micros> { lag.iter().map(|&lag| Micros::new(lag + random.up_to(width))).collect() };
    let (a, b) = (phase(), phase());
    let lags = vec![Micros::ZERO; sensors];
    let schedule = Schedule::from_slices(Micros::new(period), &lags, [&a, &b]).unwrap();
    Table { schedule, verified: None, t_delta: 100 + random.up_to(1500) }
}

/// A table that `design` returns for random needs.
fn designed_table(random: &mut Random) -> Table {
    let sensors = 2 + random.up_to(22) as usize;
    let requirements = Requirements {
        min_interval: Micros::new(500 * random.up_to(30)),
        layout: Layout::Line(2 + random.up_to(3) as u8),
        window: Micros::new(20_000 + 1000 * random.up_to(20)),
        stale_echo: random.up_to(1) == 0,
        ..Requirements::new(Micros::new(150 + random.up_to(850)))
    };
    let problem = PeriodProblem { sensors, requirements, tick: Micros::new(500) };
    let schedule = roomy(&problem.shortest(300, &mut ()).unwrap().schedule);
    let verified = schedule.verified(&requirements).unwrap();
    Table { schedule, verified: Some(verified), t_delta: requirements.t_delta.as_micros() }
}

/// Tables of both kinds and the paper's, drawn from a seed.
fn tables(count: usize, random: &mut Random) -> Vec<Table> {
    let mut tables: Vec<_> = [TABLE_I_B, TABLE_I_D]
        .iter()
        .map(|table| {
            let schedule = roomy(table);
            let verified = schedule.verified(&Requirements::new(Micros::new(999))).ok();
            Table { schedule, verified, t_delta: 999 }
        })
        .collect();
    while tables.len() < count {
        let table = if tables.len() % 2 == 0 { random_table(random) } else { designed_table(random) };
        tables.push(table);
    }
    tables
}

/// Runs a table once: each sensor hears one path, while every operation is performed on the ring.
fn run_paths(table: &Table, others: &[VerifiedSchedule<ROOM>], random: &mut Random, compared: u64) -> Vec<Count> {
    let start = (1_u64 << 32) - u64::from(random.up_to(3_000_000));
    let most = table.verified.map_or(table.schedule.min_refire(), |verified| verified.window());
    let window = most.as_micros().min(20_000 + random.up_to(40_000));
    let t_delta = table.t_delta.min(window - 1);
    let path_change = [3 * STEPS, 100, t_delta.max(3 * STEPS)][random.up_to(2) as usize];
    let period = table.schedule.period().as_micros();
    let audible = [period / 2, period, 2 * period][random.up_to(2) as usize].max(window + 501 + path_change);
    let uncertain = [0, 0, 200, 900][random.up_to(3) as usize];
    let config = RingConfig::new()
        .with_t_delta(Micros::new(t_delta))
        .with_window(Micros::new(window))
        .with_path_change(Micros::new(path_change))
        .with_audible(Micros::new(audible));
    let now = Instant::from_wide(start);
    let ring = match &table.verified {
        Some(verified) => Ring::new(verified, config, now),
        None => Ring::unverified(&table.schedule, config, now),
    };
    let sensors = table.schedule.sensors() as u32;
    let heard = (0..sensors)
        .map(|receiver| {
            let emitter = random.up_to(sensors - 1);
            // Its own sound is foreign when it comes back after the window.
            let shortest = if emitter == receiver { window + 1 + uncertain / 2 } else { 300 };
            let longest = audible - path_change;
            let least = if random.up_to(3) == 0 { longest } else { shortest + random.up_to(longest - shortest) };
            Heard::Path { emitter: emitter as u8, least }
        })
        .collect();
    let course = Course {
        late: [0, 0, 30, 300, 1000, 3000][random.up_to(5) as usize],
        handling: [0, 0, 50, 500][random.up_to(3) as usize],
        operations: [0, 20, 200][random.up_to(2) as usize],
        fired: [0, 1, 5][random.up_to(2) as usize],
        clock_steps: [0, 50][random.up_to(1) as usize],
        // Up to 3 m/s towards a wall or away from it; exact, noisy, and wrong.
        expected: [0, i64::from(random.up_to(36_000)) - 18_000][random.up_to(1) as usize],
        noise: [0, 0, 100, 1500][random.up_to(3) as usize],
        uncertain,
    };
    let sound = Sound { t_delta: t_delta.into(), path_change: path_change.into(), audible: audible.into() };
    World::new(ring.unwrap(), start, heard, course, sound, random.next(), others).run(compared)
}

#[test]
fn no_single_path_is_accepted_whatever_happens() {
    let asked = std::env::var("EERUF_SOUND").ok().map(|count| count.parse::<u64>().expect("a number of readings"));
    let wanted = asked.unwrap_or(1_000_000);
    let seed = std::env::var("EERUF_SOUND_SEED").map_or(20_000, |seed| seed.parse().expect("a number"));
    println!("seed {seed}");
    let mut random = Random(seed);
    let (mut compared, mut ambiguous) = (0, 0);
    while compared < wanted {
        let tables = tables(24, &mut random);
        let others: Vec<_> = tables.iter().filter_map(|table| table.verified).collect();
        for table in &tables {
            let alike: Vec<_> =
                others.iter().filter(|other| other.sensors() == table.schedule.sensors()).copied().collect();
            for _ in 0..4 {
                let counts = run_paths(table, &alike, &mut random, 2000);
                let accepted: u64 = counts.iter().map(|count| count.accepted).sum();
                assert_eq!(accepted, 0, "after {compared} readings from seed {seed}: {:?}", table.schedule);
                compared += counts.iter().map(|count| count.compared).sum::<u64>();
                ambiguous += counts.iter().map(|count| count.ambiguous).sum::<u64>();
            }
        }
    }
    println!("{compared} readings compared, {ambiguous} of them ambiguous, none accepted");
    // Sound that agrees is what the test is about.
    assert!(ambiguous > compared / 100, "{ambiguous} ambiguous of {compared}");
}

// On time, crosstalk of a verified table moves by more than T_delta, but seen between looks it may move less.
#[test]
fn edges_between_two_looks_let_no_path_in_on_time() {
    let (mut random, mut agree) = (Random(7), 0);
    for (schedule, t_delta) in [(TABLE_I_B, 999), (TABLE_I_D, 999)] {
        let verified = roomy(&schedule).verified(&Requirements::new(Micros::new(t_delta))).unwrap();
        let (window, audible) = (40_000, 100_000);
        let sound = Sound { t_delta: t_delta.into(), path_change: t_delta.into(), audible: audible.into() };
        for _ in 0..24 {
            let config = RingConfig::new().with_window(Micros::new(window)).with_audible(Micros::new(audible));
            let ring = Ring::new(&verified, config, Instant::from_micros(0)).unwrap();
            let mut path = |receiver: u8| {
                let emitter = (receiver + 1 + random.up_to(10) as u8) % 12;
                Heard::Path { emitter, least: 1_000 + random.up_to(audible - 2_000) }
            };
            let heard = (0..12).map(&mut path).collect();
            let course = Course { uncertain: 600, ..Course::PUNCTUAL };
            for count in World::new(ring, 0, heard, course, sound, random.next(), &[]).run(4_000) {
                assert_eq!(count.accepted, 0);
                agree += count.ambiguous;
            }
        }
    }
    println!("{agree} agree");
    assert!(agree > 1_000, "{agree}");
}

/// Random walls, one within each sensor's window.
fn walls(sensors: usize, window: u32, random: &mut Random) -> Vec<Heard> {
    (0..sensors).map(|_| Heard::Wall { t_echo: 1_000 + random.up_to(window - 2_000) }).collect()
}

#[test]
fn walls_that_nothing_explains_are_accepted() {
    let mut random = Random(20_000);
    let (mut all, mut worst) = (Count::default(), 1.0_f64);
    for table in tables(16, &mut random) {
        for late in [0, 100, 1000, 3000] {
            let window = table.schedule.min_refire().as_micros().min(20_000);
            let t_delta = table.t_delta.min(window - 1);
            let path_change = 100;
            let audible = table.schedule.period().as_micros();
            let config = RingConfig::new()
                .with_t_delta(Micros::new(t_delta))
                .with_window(Micros::new(window))
                .with_path_change(Micros::new(path_change));
            let ring = Ring::unverified(&table.schedule, config, Instant::from_micros(0)).unwrap();
            let heard = walls(table.schedule.sensors(), window, &mut random);
            let course = Course { late, ..Course::PUNCTUAL };
            let sound = Sound { t_delta: t_delta.into(), path_change: path_change.into(), audible: audible.into() };
            let counts = World::new(ring, 0, heard, course, sound, random.next(), &[]).run(4000);
            for count in counts {
                all.unexplained += count.unexplained;
                all.unexplained_accepted += count.unexplained_accepted;
                assert_eq!(count.explained_accepted, 0, "{:?}", table.schedule);
                if count.unexplained > 50 {
                    worst = worst.min(count.unexplained_accepted as f64 / count.unexplained as f64);
                }
            }
        }
    }
    println!("{} of {} accepted, worst sensor {worst:.3}", all.unexplained_accepted, all.unexplained);
    assert!(all.unexplained_accepted * 100 >= 98 * all.unexplained && worst >= 0.98, "{all:?}, worst {worst}");
}

/// A main loop.
struct Loop {
    /// Longest time between two rounds of the loop in microseconds; 0 if it sleeps until something is due.
    round: u32,
    /// Microseconds that each event takes.
    handling: u32,
    /// The length of the run, in microseconds.
    lasts: u32,
}

/// For each sensor, the share of accepted readings in a main loop, if each sees its own wall.
fn in_a_loop(schedule: &Schedule<ROOM>, t_delta: u32, path_change: u32, course: &Loop, seed: u64) -> Vec<f64> {
    let (sensors, window) = (schedule.sensors(), 20_000);
    let config = RingConfig::new()
        .with_t_delta(Micros::new(t_delta))
        .with_window(Micros::new(window))
        .with_path_change(Micros::new(path_change));
    let mut ring = Ring::unverified(schedule, config, Instant::from_micros(0)).unwrap();
    let mut random = Random(seed);
    let t_echo: Vec<u32> = (0..sensors).map(|_| 1_000 + random.up_to(window - 2_000)).collect();
    let mut edges: Vec<(u32, u8)> = vec![];
    let (mut readings, mut accepted) = (vec![0_u32; sensors], vec![0_u32; sensors]);
    let mut now = 0_u32;
    while now < course.lasts {
        now = if course.round > 0 {
            now + random.up_to(course.round).max(1)
        } else {
            let due = ring.next_deadline().since(Instant::from_micros(0)).as_micros();
            edges.iter().fold(due, |due, &(at, _)| due.min(at)).max(now + 1)
        };
        loop {
            edges.retain(|&(at, sensor)| {
                if at <= now {
                    ring.echo(sensor, Instant::from_micros(at)).unwrap();
                }
                at > now
            });
            match ring.poll(Instant::from_micros(now)) {
                Some(RingEvent::Fire { sensor, .. }) => {
                    edges.push((now + t_echo[usize::from(sensor)] + random.up_to(30), sensor));
                }
                Some(RingEvent::Reading(reading)) => {
                    readings[usize::from(reading.sensor)] += 1;
                    accepted[usize::from(reading.sensor)] += u32::from(reading.kind == ReadingKind::Accepted);
                }
                Some(RingEvent::PeriodEnded(_)) => {}
                None => break,
            }
            now += course.handling;
        }
    }
    readings.iter().zip(accepted).map(|(&read, accepted)| f64::from(accepted) / f64::from(read)).collect()
}

#[test]
fn a_loop_of_a_millisecond_loses_few_walls() {
    let table = roomy(&TABLE_I_D);
    let (mut all, mut worst) = (0.0, 1.0_f64);
    for seed in 20_000..20_010 {
        let shares = in_a_loop(&table, 999, 100, &Loop { round: 1_000, handling: 0, lasts: 60_000_000 }, seed);
        all += shares.iter().sum::<f64>() / shares.len() as f64 / 10.0;
        worst = shares.into_iter().fold(worst, f64::min);
    }
    println!("accepted {all:.3}, worst sensor {worst:.3}");
    assert!(all >= 0.97 && worst >= 0.90, "accepted {all:.3}, worst sensor {worst:.3}");
}

/// The Arduino library's ready tables with the `t_delta` that each was verified for.
fn ready_tables() -> Vec<(String, Schedule<ROOM>, u32)> {
    let text = include_str!("../../../../../c/arduino/src/EerufTables.h");
    let numbers = |start: &str| -> Vec<u32> {
        let (_, rest) = text.split_once(start).expect("a table");
        let (_, rest) = rest.split_once('{').unwrap();
        let (list, _) = rest.split_once("};").unwrap();
        let words = list.lines().map(|line| line.split("/*").next().unwrap()).flat_map(|line| line.split(','));
        words.filter_map(|word| word.trim().trim_end_matches('u').parse().ok()).collect()
    };
    let names = text.lines().filter_map(|line| line.strip_prefix("static const EerufSchedule ")?.split(' ').next());
    names
        .map(|name| {
            let (order, gaps) = (numbers(&format!("{name}_order[]")), numbers(&format!("{name}_gap_us[]")));
            // The version, sensors, phases, then the times.
            let fields = numbers(&format!("EerufSchedule {name} "));
            let (sensors, period, t_delta) = (fields[1] as usize, fields[3], fields[5]);
            let phase = |order: &[u32], gaps: &[u32]| {
                let mut at = 0;
                let mut t_fire = vec![Micros::ZERO; sensors];
                for (&sensor, &gap) in order.iter().zip(gaps) {
                    at += gap;
                    t_fire[sensor as usize] = Micros::new(at);
                }
                t_fire
            };
            let (a, b) = (phase(&order[..sensors], &gaps), phase(&order[sensors..], &gaps[sensors + 1..]));
            let lags = vec![Micros::ZERO; sensors];
            let schedule = Schedule::from_slices(Micros::new(period), &lags, [&a, &b]).unwrap();
            (name.to_owned(), schedule, t_delta)
        })
        .collect()
}

#[test]
fn handling_of_half_a_millisecond_loses_few_walls() {
    let tables = ready_tables();
    assert_eq!(tables.len(), 3);
    let course = Loop { round: 0, handling: 500, lasts: 30_000_000 };
    for (name, schedule, t_delta) in tables {
        let shares = in_a_loop(&schedule, t_delta, 100, &course, 20_000);
        let (all, worst) =
            (shares.iter().sum::<f64>() / shares.len() as f64, shares.into_iter().fold(1.0_f64, f64::min));
        println!("{name}: accepted {all:.4}, worst sensor {worst:.3}");
        assert!(all >= 0.98 && worst >= 0.98, "{name}: accepted {all:.4}, worst sensor {worst:.3}");
    }
}
