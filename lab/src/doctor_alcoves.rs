//! Rates of the doctor of `eeruf logs`, on logs of alcoves of Set I, where the simulator knows whose sound
//! each reading is:
//! `cargo lab doctor-alcoves [FIRST [ALCOVES [PERIODS [PHYSICS]]]]`.
//!
//! Each alcove gives a log of each way of firing, once for a standing and once for a driving robot. Beside each is a
//! log in which every sensor is alone in the room, so that none hears another.

use std::error::Error;
use std::fmt::Write;

use eeruf_logs::{Doctor, Examination, LogVerdict, Options as ReadOptions, read_stream};
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::{Cause, Method, Motion, Noise, Options, Physics, Readings, Robot, Vector, World, simulate, sweep};

const WAYS: [(&str, &str); 4] = [
    ("at once", "simultaneous"),
    ("in turn", "sequential"),
    ("constant lags", "conventional"),
    ("alternating", "eeruf"),
];
const SENSORS: usize = 8;
/// Echoes that differ by less are the same.
const MOVED_US: f64 = 150.0;

/// One alcove's log and the doctor's answer on it.
#[derive(Clone, Default)]
struct Outcome {
    examination: Examination,
    /// Share of readings that are another sensor's sound and at least 150 us from the sensor's reading alone.
    wrong: f64,
    /// Foreign readings by receiver and sender.
    heard: [[u32; SENSORS]; SENSORS],
    /// Sensors that the log can show to be fooled.
    tells: [bool; SENSORS],
    /// The doctor's answer if every sensor heard only its own echoes, with the same firing times.
    alone: Examination,
}

/// Readings of one sensor, in order: the phase, the echo in microseconds, and the sender if it is another sensor.
type Truth = Vec<(u8, f64, Option<u8>)>;

/// Returns the sensors for which ranges and times alone could prove crosstalk to a reader who knows the sender of each
/// reading. Under alternating lags the share of foreign readings must differ between the lags by four standard
/// deviations, or one sender's readings must jump by more than 150 us 20 times. Under constant lags, if the robot
/// drives, two sensors must read each other in 20 periods.
fn tells(way: &str, drives: bool, truth: &[Truth]) -> [bool; SENSORS] {
    let mut told = [false; SENSORS];
    for (own, readings) in truth.iter().enumerate() {
        let count = |phase: u8, foreign: bool| {
            readings.iter().filter(|reading| reading.0 % 2 == phase && (!foreign || reading.2.is_some())).count() as f64
        };
        let [(a, in_a), (b, in_b)] = [0, 1].map(|phase| (count(phase, false), count(phase, true)));
        let all = (in_a + in_b) / (a + b);
        let deviations = (in_a / a - in_b / b).abs() / (all * (1.0 - all) * (1.0 / a + 1.0 / b)).sqrt();
        let moves = readings
            .chunks_exact(2)
            .filter(|two| two[0].2.is_some() && two[0].2 == two[1].2 && (two[0].1 - two[1].1).abs() > MOVED_US);
        let is_mutual = |other: usize| {
            let both = readings
                .iter()
                .zip(&truth[other])
                .filter(|(mine, theirs)| mine.2 == Some(other as u8) && theirs.2 == Some(own as u8));
            both.count() >= 20
        };
        told[own] = match way {
            "alternating" => deviations >= 4.0 || moves.count() >= 20,
            "constant lags" if drives => (0..SENSORS).any(|other| other != own && is_mutual(other)),
            _ => false,
        };
    }
    told
}

fn world(number: u64, drives: bool, physics: Physics, sensor: Option<usize>) -> Result<World, Box<dyn Error>> {
    let alcove = Alcove::random(number);
    let mut robot: Robot = alcove.robot();
    if let Some(sensor) = sensor {
        robot.sensors = vec![robot.sensors[sensor]];
    }
    if drives {
        let turn_rad_s = if number.is_multiple_of(2) { 0.04 } else { -0.04 };
        robot.motion = Motion::Constant { velocity: Vector::new(0.0, -0.015), turn_rad_s };
    }
    Ok(World::new(alcove.scene()?, vec![robot], Noise::default())?.with_physics(physics)?)
}

/// Returns the doctor's findings on readings: sensor, firing in seconds and echo in microseconds.
fn examine(readings: &[(u8, f64, f64)], speed_of_sound: f64) -> Result<Examination, Box<dyn Error>> {
    let mut text = "time_us,sensor,range_m\n".to_owned();
    for (sensor, fired_s, echo_us) in readings {
        let range =
            if echo_us.is_nan() { "inf".to_owned() } else { format!("{:.5}", 0.5e-6 * echo_us * speed_of_sound) };
        writeln!(text, "{:.0},{sensor},{range}", 1e6 * fired_s)?;
    }
    let options = ReadOptions { speed_of_sound, no_echo_m: 20.0, ..ReadOptions::default() };
    let mut doctor = Doctor::new(speed_of_sound);
    let report = read_stream(text.as_bytes(), "log".as_ref(), &options, |_, reading| doctor.push(reading))?;
    // Labels are in the order in which they were met.
    let order: Vec<usize> = report.names().iter().map(|name| name.parse()).collect::<Result<_, _>>()?;
    let mut found = doctor.examine(&report.firing, &report.names());
    found.fooled.iter_mut().for_each(|sensor| *sensor = order[*sensor]);
    found.pairs.iter_mut().for_each(|(x, y)| (*x, *y) = (order[*x], order[*y]));
    Ok(found)
}

fn outcome(
    number: u64,
    way: &str,
    method: Method,
    drives: bool,
    periods: u32,
    physics: Physics,
) -> Result<Outcome, Box<dyn Error>> {
    let world_of_all = world(number, drives, physics, None)?;
    let readings = simulate(&world_of_all, method, &Options::periods(periods))?;
    let speed_of_sound = world_of_all.scene().air().speed_of_sound();
    let mut order: Vec<_> = (0..readings.len()).collect();
    order.sort_by(|&a, &b| readings.fired_s[a].total_cmp(&readings.fired_s[b]));
    let mut all = Outcome::default();
    let rows: Vec<_> =
        order.iter().map(|&k| (readings.sensor[k], readings.fired_s[k], readings.earliest_us[k])).collect();
    all.examination = examine(&rows, speed_of_sound)?;
    let mut truth = vec![Truth::new(); SENSORS];
    for &k in &order {
        let sensor = usize::from(readings.sensor[k]);
        let sender = readings.path_of(k).map(|path| path.emitter.sensor);
        let sender = sender.filter(|_| readings.cause[k] == Cause::Crosstalk);
        if let Some(sender) = sender {
            all.heard[sensor][usize::from(sender)] += 1;
        }
        truth[sensor].push((readings.phase[k], readings.earliest_us[k], sender));
    }
    all.tells = tells(way, drives, &truth);
    let options = Options { seed: Some(number), ..Options::periods(periods) };
    let lone = |sensor| -> Result<Readings, Box<dyn Error>> {
        Ok(simulate(&world(number, drives, physics, Some(sensor))?, "simultaneous".parse()?, &options)?)
    };
    let lone: Vec<_> = (0..SENSORS).map(lone).collect::<Result<_, _>>()?;
    // The reading of the sensor alone that is nearest in time.
    let alone: Vec<_> = rows
        .iter()
        .map(|&(sensor, fired_s, _)| {
            let of = &lone[usize::from(sensor)];
            let after = of.fired_s.partition_point(|&at| at < fired_s).min(of.len() - 1);
            (sensor, fired_s, of.earliest_us[after])
        })
        .collect();
    let is_wrong = |(&k, own): (&usize, &(u8, f64, f64))| {
        readings.cause[k] == Cause::Crosstalk && !((readings.earliest_us[k] - own.2).abs() < MOVED_US)
    };
    all.wrong = order.iter().zip(&alone).filter(|pair| is_wrong(*pair)).count() as f64 / order.len() as f64;
    all.alone = examine(&alone, speed_of_sound)?;
    Ok(all)
}

/// Returns a share with Wilson's 95 % interval in per cent.
fn share(part: usize, of: usize) -> String {
    if of == 0 {
        return "-".to_owned();
    }
    let (n, z2) = (of as f64, 1.96_f64 * 1.96);
    let p = part as f64 / n;
    let (middle, half) = (p + 0.5 * z2 / n, 1.96 * (p * (1.0 - p) / n + 0.25 * z2 / (n * n)).sqrt());
    let [low, high] = [-half, half].map(|half| 100.0 * (middle + half) / (1.0 + z2 / n));
    format!("{part} of {of} ({:.1}-{high:.1} %)", low.max(0.0))
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let mut arguments = arguments.iter();
    let mut next = |default: &str| arguments.next().map_or_else(|| default.to_owned(), String::clone);
    let (first, alcoves): (u64, u64) = (next("20000").parse()?, next("25").parse()?);
    let periods: u32 = next("1000").parse()?;
    let physics_name = next("plain");
    let physics: Physics = physics_name.parse()?;
    println!("{alcoves} alcoves from {first} on, {periods} periods, physics {physics_name}; 95 % intervals.\n");
    print!("| firing | robot | crosstalk | none seen | cannot tell ");
    println!("| fooled: named, of all | of those that tell | alone: none seen |");
    println!("|---|---|--:|--:|--:|--:|---|---|");
    let (mut sum, mut telling, mut verdicts) = ([[0; 2]; 4], 0, 0);
    for (way, method) in WAYS {
        for drives in [false, true] {
            let method: Method = method.parse()?;
            let numbers: Vec<_> = (first..first + alcoves).collect();
            let all = sweep(&numbers, |&number| {
                outcome(number, way, method, drives, periods, physics)
                    .map_err(|error| format!("alcove {number}: {error}"))
            });
            let all = all.into_iter().collect::<Result<Vec<_>, _>>()?;
            let logs = |is: &dyn Fn(&Outcome) -> bool| all.iter().filter(|outcome| is(outcome)).count();
            let of = |verdict| logs(&|outcome: &Outcome| outcome.examination.verdict == verdict);
            let well = |outcome: &Outcome| outcome.examination.verdict == LogVerdict::NoneSeen;
            let sums = |outcome: &Outcome| outcome.heard.map(|row| row.iter().sum::<u32>());
            let fooled = |o: &Outcome| -> Vec<usize> { (0..SENSORS).filter(|&s| sums(o)[s] >= 20).collect() };
            let named = |o: &Outcome, s: &usize| o.examination.fooled.contains(s);
            let sensors = |is: &dyn Fn(&Outcome, &usize) -> bool| -> usize {
                all.iter().map(|o| fooled(o).iter().filter(|s| is(o, s)).count()).sum()
            };
            let counts = [
                (logs(&|o| well(o) && o.wrong > 0.05), logs(&|o| o.wrong > 0.05)),
                (logs(&|o| o.examination.fooled.iter().any(|&s| sums(o)[s] == 0)), all.len()),
                (
                    logs(&|o| o.examination.pairs.iter().any(|&(x, y)| o.heard[x][y] < 5 && o.heard[y][x] < 5)),
                    all.len(),
                ),
                (logs(&|o| o.alone.verdict == LogVerdict::Crosstalk), all.len()),
            ];
            sum.iter_mut().zip(counts).for_each(|(sum, (part, of))| *sum = [sum[0] + part, sum[1] + of]);
            if drives || !["at once", "constant lags"].contains(&way) {
                (telling, verdicts) = (telling + all.len(), verdicts + all.len() - of(LogVerdict::CannotTell));
            }
            println!(
                "| {way} | {} | {} | {} | {} | {} of {} | {} | {} |",
                if drives { "drives" } else { "stands" },
                of(LogVerdict::Crosstalk),
                of(LogVerdict::NoneSeen),
                of(LogVerdict::CannotTell),
                sensors(&named),
                sensors(&|_, _| true),
                share(sensors(&|o, s| o.tells[*s] && named(o, s)), sensors(&|o, s| o.tells[*s])),
                share(logs(&|o| o.alone.verdict == LogVerdict::NoneSeen), all.len()),
            );
        }
    }
    let [well, sensor, pair, alone] = sum.map(|[part, of]| share(part, of));
    println!("\n- None seen where more than 5 % of the readings are wrong: {well}");
    println!("- Logs with a sensor named that heard no other: {sensor}");
    println!("- Logs with a pair named of which neither heard the other 5 times: {pair}");
    println!("- Crosstalk named where each sensor was alone: {alone}");
    println!("- Verdicts where lags change, sensors fire in turn, or the robot drives: {}", share(verdicts, telling));
    let is_rare = |[part, of]: [usize; 2]| 100 * part <= of;
    if !is_rare(sum[0]) || !is_rare(sum[2]) || 10 * verdicts < 6 * telling {
        return Err("expected well above 5 % and false pairs in at most 1 % of the logs, and verdicts in 60 %".into());
    }
    Ok(())
}
