//! Core's own ring in sound made of paths alone: each sensor hears several equally loud paths from four others. Also
//! measures the distance by which fitting readings lead a belief away after its wall is gone.

use eeruf_core::flow::{BeliefSettings, FlowRing, InTurn, TurnSettings, Votes};
use eeruf_core::judge::{Judge, MedianFilter};
use eeruf_core::{Instant, Micros, ReadingKind, Ring, RingConfig, RingError, RingEvent, Silence};
use eeruf_sim::{Random, sweep};

use super::{Asked, Cell, Table};

const SENSORS: usize = 8;
const BLANKING_US: u64 = 300;
const WINDOW_US: u64 = 25_000;
/// The longest travel time of foreign sound, in us: less than R.
const LONGEST_US: f64 = 33_000.0;
/// A ring with a judge that knows no motion.
type AnyRing<J> = Ring<InTurn<SENSORS>, J, SENSORS, 1, 3>;

/// Travel time of a path in us, and its change in us per ms; the change reverses at the shortest and longest time.
struct Path {
    us: f64,
    rate: f64,
    longest_us: f64,
}

impl Path {
    fn random(random: &mut Random, longest_us: f64, rate: f64) -> Self {
        Self { us: random.between(1_000.0, longest_us), rate: random.between(-rate, rate), longest_us }
    }

    fn at(&self, now: u64) -> f64 {
        let span = self.longest_us - 1_000.0;
        let off = (self.us - 1_000.0 + 1e-3 * self.rate * now as f64).rem_euclid(2.0 * span);
        1_000.0 + off.min(2.0 * span - off)
    }
}

/// The paths of each sensor's own echo, and the paths from others.
struct Sound {
    own: Vec<Path>,
    foreign: Vec<(u8, u8, Path)>,
    /// Time when sensor 0's wall disappears.
    gone: u64,
}

impl Sound {
    fn random(random: &mut Random, paths: u32, rate: f64, gone: u64) -> Self {
        let own = (0..SENSORS).map(|_| Path::random(random, 24_000.0, rate)).collect();
        let mut foreign = vec![];
        for receiver in 0..SENSORS as u8 {
            let mut others: Vec<u8> = (0..SENSORS as u8).filter(|&other| other != receiver).collect();
            for _ in 0..4 {
                let emitter = others.swap_remove(random.bits() as usize % others.len());
                foreign.extend((0..paths).map(|_| (emitter, receiver, Path::random(random, LONGEST_US, rate))));
            }
        }
        Self { own, foreign, gone }
    }

    /// Runs for some seconds and passes each reading, with the time of its firing, to `seen`.
    fn run<J: Judge>(
        &self,
        mut ring: AnyRing<J>,
        mut random: Random,
        seconds: u64,
        mut seen: impl FnMut(u64, u8, Option<u64>, &AnyRing<J>),
    ) {
        ring.set_silence(Silence::Trusted);
        let instant = |now: u64| Instant::from_micros(now as u32);
        let (mut now, mut fired, mut heard) = (0_u64, [0_u64; SENSORS], [true; SENSORS]);
        let mut arrivals: Vec<(u64, u8)> = vec![];
        while now < 1_000_000 * seconds {
            let ahead = u64::from(ring.next_deadline().since(instant(now)).as_micros());
            let wakes = now + if ahead > 1 << 30 { 0 } else { ahead } + random.bits() % 50;
            arrivals.sort_unstable();
            let next = arrivals.first().copied().filter(|&(at, _)| at <= wakes);
            now = next.map_or(wakes, |(at, _)| at).max(now);
            if let Some((at, sensor)) = next {
                arrivals.remove(0);
                let place = usize::from(sensor);
                let since = at.saturating_sub(fired[place]);
                if !heard[place] && (BLANKING_US..=WINDOW_US).contains(&since) {
                    heard[place] = ring.echo(sensor, instant(at)).is_ok();
                }
            }
            while let Some(event) = ring.poll(instant(now)) {
                match event {
                    RingEvent::Fire { sensor, .. } => {
                        (fired[usize::from(sensor)], heard[usize::from(sensor)]) = (now, false);
                        let own = Some((sensor, &self.own[usize::from(sensor)]));
                        let own = own.filter(|_| sensor > 0 || now < self.gone);
                        let foreign = self.foreign.iter().filter(|path| path.0 == sensor).map(|path| (path.1, &path.2));
                        for (receiver, path) in own.into_iter().chain(foreign) {
                            // One echo in ten fades away.
                            let off = path.at(now) + random.between(-15.0, 15.0);
                            if !random.bits().is_multiple_of(10) {
                                arrivals.push((now + off as u64, receiver));
                            }
                        }
                    }
                    RingEvent::Reading(reading) => {
                        let accepted = reading.t_echo.filter(|_| reading.kind == ReadingKind::Accepted);
                        let t_echo = accepted.map(|echo| u64::from(echo.as_micros()));
                        seen(fired[usize::from(reading.sensor)], reading.sensor, t_echo, &ring);
                    }
                    RingEvent::PeriodEnded(_) => {}
                }
            }
        }
    }
}

/// Change of a good reading in a millisecond, in us, and the corresponding speed, in mm/s.
const RATES: [(f64, u16); 5] = [(0.0, 0), (1.0, 170), (2.0, 340), (3.0, 500), (6.0, 1_000)];

fn config() -> RingConfig {
    let ms = Micros::from_millis;
    RingConfig::new().with_window(ms(25)).with_blanking(Micros::new(BLANKING_US as u32)).with_t_delta(Micros::new(150))
}

fn believing(
    turns: TurnSettings,
    votes: Votes,
    top_speed_mm_s: u16,
) -> Result<AnyRing<eeruf_core::flow::Belief<SENSORS>>, RingError> {
    let belief = BeliefSettings { top_speed_mm_s, votes, ..BeliefSettings::DEFAULT };
    FlowRing::flow(SENSORS, turns, belief, config(), Instant::from_micros(0))
}

/// Returns the number of accepted echoes, and the number of these more than 0.5 ms from the sensor's own.
fn wrong<J: Judge>(sound: &Sound, random: Random, ring: AnyRing<J>) -> [u32; 2] {
    let mut counts = [0; 2];
    sound.run(ring, random, 10, |fired, sensor, t_echo, _| {
        if let Some(t_echo) = t_echo {
            let off = t_echo as f64 - sound.own[usize::from(sensor)].at(fired);
            counts[0] += 1;
            counts[1] += u32::from(off.abs() > 500.0);
        }
    });
    counts
}

pub(super) fn table(asked: &Asked) -> Result<Table, Box<dyn std::error::Error>> {
    let mut table = Table::new("paths", 2, &["wrong of accepted %", "accepted/s"]);
    for (paths, (rate, speed)) in [0, 4].into_iter().flat_map(|of| [1, 3, 8].map(|paths| (paths, RATES[of]))) {
        for way in ["one by one", "one by one, median", "one by one, 15 ms", "flow", "1 of 1"] {
            let run = |&number: &u64| -> Result<[u32; 2], RingError> {
                let random = Random::new(number);
                let sound = Sound::random(&mut random.of(1), paths, rate, u64::MAX);
                let turns = TurnSettings::new(random.of(2).bits() as u32 | 1);
                let short = TurnSettings { least: Micros::from_millis(15), most: Micros::from_millis(15), ..turns };
                let votes = if way == "flow" { Votes::TwoInARow } else { Votes::EveryEcho };
                let turns = match way {
                    "one by one, 15 ms" => short,
                    "flow" | "1 of 1" => turns,
                    _ => turns.one_by_one(),
                };
                if way == "one by one, median" {
                    let now = Instant::from_micros(0);
                    let plan = InTurn::new(SENSORS, turns, Micros::from_millis(25), now)?;
                    let median = MedianFilter::<SENSORS, 3>::new(3, Micros::new(150))?;
                    return Ok(wrong(&sound, random.of(3), Ring::judged_by(plan, median, config(), now)?));
                }
                Ok(wrong(&sound, random.of(3), believing(turns, votes, speed)?))
            };
            let runs = sweep(&asked.numbers(), run).into_iter().collect::<Result<Vec<_>, _>>()?;
            let share = runs.iter().map(|[all, wrong]| 100.0 * f64::from(*wrong) / f64::from((*all).max(1)));
            let rate = runs.iter().map(|[all, _]| f64::from(*all) / 10.0);
            let words = if speed > 0 { "g = 6" } else { "standing" };
            table.row(format!("{paths} paths a pair, {words}"), way, vec![Cell::mean(share), Cell::mean(rate)]);
        }
    }
    Ok(table)
}

/// Time when the wall disappears, in us.
const GOES: u64 = 3_000_000;

/// Returns the distance in mm by which readings that fit lead sensor 0's belief after its wall has gone, and the time
/// in ms for which they do; `None` if the belief never was right.
fn lead(number: u64, rate: f64, speed: u16) -> Result<Option<[f64; 2]>, RingError> {
    let random = Random::new(number);
    let sound = Sound::random(&mut random.of(1), 3, rate, GOES);
    let turns = TurnSettings::new(random.of(2).bits() as u32 | 1);
    // The belief with its firing time, the lead so far, and the last reading of the wall.
    let (mut believed, mut lead, mut left): (_, [f64; 2], _) = (None, [0.0; 2], 0.0);
    sound.run(believing(turns, Votes::TwoInARow, speed)?, random.of(3), 8, |fired, sensor, t_echo, ring| {
        if sensor > 0 {
            return;
        }
        let Some(t_echo) = t_echo.map(|echo| echo as f64) else {
            if ring.judge().believed(0).is_none() {
                believed = None;
            }
            return;
        };
        if fired < GOES {
            let own = (t_echo - sound.own[0].at(fired)).abs() < 100.0;
            (believed, left) = (own.then_some((t_echo, fired)), t_echo);
        } else if let Some((before, at)) = believed {
            let most = 152.0 + 1e-3 * rate * (fired - at) as f64;
            let fits = (t_echo - before).abs() <= most;
            believed = fits.then_some((t_echo, fired));
            if fits {
                lead = [lead[0].max(0.1716 * (t_echo - left).abs()), 1e-3 * (fired - GOES) as f64];
            }
        }
    });
    Ok((left > 0.0).then_some(lead))
}

pub(super) fn leads(asked: &Asked) -> Result<Table, Box<dyn std::error::Error>> {
    let head = &["outlives its wall %", "led by, mm: mean", "90 % place", "most", "for, ms: 90 % place", "most"];
    let mut table = Table::new("leads", 0, head);
    for (rate, speed) in RATES {
        let runs = sweep(&asked.numbers(), |&number| lead(number, rate, speed));
        let runs: Vec<[f64; 2]> = runs.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect();
        let outlives = Cell::mean(runs.iter().map(|run| if run[1] > 0.0 { 100.0 } else { 0.0 }));
        let most = |of: usize| Cell::new(runs.iter().map(|run| run[of]).fold(0.0, f64::max), [f64::NAN; 2]);
        let column = |of: usize| runs.iter().map(move |run| run[of]);
        let cells = vec![outlives, Cell::mean(column(0)), Cell::p90(column(0)), most(0), Cell::p90(column(1)), most(1)];
        table.row(format!("g = {rate}"), "flow", cells);
    }
    Ok(table)
}
