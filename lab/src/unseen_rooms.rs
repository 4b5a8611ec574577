//! Random rings in rooms that `eeruf design` has not seen, against its words: sound from an earlier firing that is
//! believed, the number of blind sensors, which ones they are, and the factor beside one by one.
//!
//! `cargo lab unseen-rooms [RINGS [FIRST [PLACES]]]`: 100 rings, rooms from
//! number 20,000 on, 3 places in each of the eight kinds.

use std::ops::Range;

use eeruf_design::RingSpec;
use eeruf_sim::Random;
use eeruf_sim::acoustics::Physics;
use eeruf_sim::experiments::rooms::{JudgedWay, RoomGroup, RoomKind, RoomPlan, RoomWay, RoomsOptions, judge};
use eeruf_sim::results::{Cause, Readings, quantile};
use eeruf_sim::scene::Room;
use eeruf_sim::simulation::{Options, simulate};
use eeruf_sim::threads::sweep;

const MODULES: [&str; 5] = ["hc-sr04", "polaroid-6500", "us-100", "jsn-sr04t", "ping"];
/// As long as `eeruf design` simulates each room, in seconds.
const STANDING_S: f64 = 20.0;
/// The tolerance of what is right, in microseconds.
const TOLERANCE_US: f64 = 500.0;
/// The share of right readings under which a sensor is blind.
const BLIND: f64 = 0.05;
/// Shares in another run under which a sensor is called blind.
const FORETOLD: [f64; 3] = [0.05, 0.1, 0.2];

fn pick(random: &mut Random, of: usize) -> usize {
    (random.between(0.0, of as f64) as usize).min(of - 1)
}

/// A ring of 2 to 24 sensors in a line or all round, with modules of one kind or of two in turn: its name and its file.
fn ring(random: &mut Random) -> (String, String) {
    let sensors = 2 + pick(random, 23);
    let kinds = [(); 2].map(|()| MODULES[pick(random, MODULES.len())]);
    let mixed = pick(random, 2) == 1;
    let module = |sensor: usize| kinds[if mixed { sensor % 2 } else { 0 }];
    let modules: Vec<_> = (0..sensors).map(module).collect();
    let layout = if pick(random, 3) == 0 { "line" } else { "ring" };
    let name = if module(0) == module(1) { kinds[0].to_owned() } else { kinds.join(" and ") };
    let file = format!("sensors = {sensors}\nmodule = {modules:?}\nlayout = \"{layout}\"\nspeed_m_s = 0.5\n");
    (format!("{sensors} {name}, {layout}"), file)
}

/// Figures of one way in one room.
struct Seen {
    right_echoes_per_s: f64,
    believed: usize,
    stale: usize,
    /// The share of each sensor's readings that was believed and right, of the first robot.
    right: Vec<f64>,
    /// Their number, of one robot.
    blind_of_one: f64,
}

fn seen(room: &RoomPlan, way: &RoomWay, seed: u64) -> Seen {
    let world = room.world(&way.robot, 0.0).expect("a room for this robot");
    let world =
        world.with_room(Some(Room::DEFAULT)).expect("a height").with_physics(Physics::DEFAULT).expect("physics");
    let periods = (1e6 * STANDING_S / f64::from(way.robot.period.as_micros())).ceil() as u32;
    let options = Options { periods, seed: Some(seed), ..way.options };
    let readings = simulate(&world, way.method, &options).expect("a run");
    let robots = world.robots().len() as f64;
    let summary = readings.summary();
    let believed = (0..readings.len()).filter(|&reading| readings.is_accepted(reading));
    Seen {
        right_echoes_per_s: summary.right_echoes_per_s / robots,
        believed: summary.accepted,
        stale: believed.filter(|&reading| readings.cause[reading] == Cause::Stale).count(),
        right: (0..way.robot.sensors.len()).map(|sensor| right_share(&readings, sensor)).collect(),
        blind_of_one: summary.blind as f64 / robots,
    }
}

fn right_share(readings: &Readings, sensor: usize) -> f64 {
    let of_it = |&reading: &usize| readings.robot[reading] == 0 && usize::from(readings.sensor[reading]) == sensor;
    let is_right = |&reading: &usize| readings.is_accepted(reading) && !readings.is_wrong(reading, TOLERANCE_US);
    let of_it: Vec<usize> = (0..readings.len()).filter(of_it).collect();
    of_it.iter().copied().filter(is_right).count() as f64 / of_it.len().max(1) as f64
}

/// A ring in rooms that its judgement has not seen.
struct Unseen {
    /// Figures of the recommended way in each, and the right echoes of one by one.
    rooms: Vec<(Seen, f64)>,
    /// The same shares in a run with other noise.
    foretold: Vec<Vec<f64>>,
    /// Rooms of each kind.
    places: usize,
}

impl Unseen {
    fn of(best: &JudgedWay, base: &JudgedWay, numbers: Range<u64>) -> Self {
        let radius_m = best.way.robot.radius_m();
        let of_kind = |kind| numbers.clone().map(move |number| RoomPlan::random(kind, number, radius_m));
        let plans: Vec<_> = RoomKind::ALL.into_iter().flat_map(of_kind).collect();
        let seed = numbers.end;
        Self {
            rooms: sweep(&plans, |room| (seen(room, &best.way, seed), seen(room, &base.way, seed).right_echoes_per_s)),
            foretold: sweep(&plans, |room| seen(room, &best.way, seed + 1).right),
            places: (numbers.end - numbers.start) as usize,
        }
    }

    /// The factor of right echoes in these of the rooms, as the program has it: the geometric mean over kinds of rooms.
    fn times(&self, drawn: &[usize]) -> f64 {
        let mean = |kind: &[usize], of: &dyn Fn(&(Seen, f64)) -> f64| {
            kind.iter().map(|&room| of(&self.rooms[room])).sum::<f64>() / kind.len() as f64 + 0.1
        };
        let of_kind =
            |kind: &[usize]| (mean(kind, &|room| room.0.right_echoes_per_s) / mean(kind, &|room| room.1)).ln();
        let logs: Vec<f64> = drawn.chunks(self.places).map(of_kind).collect();
        (logs.iter().sum::<f64>() / logs.len() as f64).exp()
    }

    /// The factor, and between which it lies with 95 % confidence, by rooms drawn again.
    fn measured(&self, random: &mut Random) -> (f64, [f64; 2]) {
        let all: Vec<usize> = (0..self.rooms.len()).collect();
        let mut again = |_| {
            let draw = |&room: &usize| room / self.places * self.places + pick(random, self.places);
            self.times(&all.iter().map(draw).collect::<Vec<_>>())
        };
        let mut drawn: Vec<f64> = (0..400).map(&mut again).collect();
        (self.times(&all), [0.025, 0.975].map(|share| quantile(&mut drawn, share)))
    }
}

#[derive(Default)]
struct Counts {
    rings: usize,
    rooms: usize,
    in_interval: usize,
    believed: usize,
    stale: usize,
    blind: usize,
    /// By [`FORETOLD`]: sensors called blind, and those of them that are.
    foretold: [(usize, usize); FORETOLD.len()],
    /// Rings whose factor's interval is above what is measured, and above the interval of that.
    above: usize,
    too_high: usize,
    /// The factor that is said over the one that is measured, of each ring that another way than one by one is
    /// recommended for.
    ratios: Vec<f64>,
}

impl Counts {
    fn add(&mut self, best: &JudgedWay, unseen: &Unseen) {
        let [least, most] = best.blind_90;
        self.rings += 1;
        for ((seen, _), foretold) in unseen.rooms.iter().zip(&unseen.foretold) {
            self.rooms += 1;
            self.in_interval += usize::from((least..=most).contains(&seen.blind_of_one));
            self.believed += seen.believed;
            self.stale += seen.stale;
            for (&right, &other) in seen.right.iter().zip(foretold) {
                let blind = right < BLIND;
                self.blind += usize::from(blind);
                for (&limit, (called, hits)) in FORETOLD.iter().zip(&mut self.foretold) {
                    *called += usize::from(other < limit);
                    *hits += usize::from(other < limit && blind);
                }
            }
        }
    }

    fn tell(&mut self) {
        let share = |part: usize, whole: usize| 100.0 * part as f64 / whole.max(1) as f64;
        println!("\n- {} rings, {} rooms", self.rings, self.rooms);
        println!("- stale: {} of {} believed, {:.3} %", self.stale, self.believed, share(self.stale, self.believed));
        println!("- blind: as many as was said in {:.1} % of rooms", share(self.in_interval, self.rooms));
        for (limit, (called, hits)) in FORETOLD.iter().zip(self.foretold) {
            println!(
                "- blind, called so where under {:.0} % are right with other noise: {hits} of {} ({:.1} %), and {:.1} \
                 % of {called} are",
                100.0 * limit,
                self.blind,
                share(hits, self.blind),
                share(hits, called)
            );
        }
        let factors = self.ratios.len();
        let (above, too_high) = (self.above, self.too_high);
        println!(
            "- times: interval above what is measured for {above} of {factors} rings, above its interval for {too_high}"
        );
        println!("- times, said over measured: median {:.2}", quantile(&mut self.ratios, 0.5));
    }
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let mut arguments = arguments.iter();
    let mut number = |default| arguments.next().map_or(Ok(default), |argument| argument.parse::<u64>());
    let (rings, first, places) = (number(100)?, number(20_000)?, number(3)?);
    let mut counts = Counts::default();
    println!("| ring | way | blind: said | in unseen rooms | most | times: said | measured | stale |");
    println!("|---|---|---|---:|---:|---:|---:|---:|");
    for number in 0..rings {
        let mut random = Random::new(first + number);
        let (name, text) = ring(&mut random);
        let spec = RingSpec::from_text(&text).expect("a ring file");
        let design = spec.shortest_to_study().expect("needs in range");
        let robot = design.as_ref().map_or(&spec, |design| &design.spec).room_robot().expect("places").robot;
        let ways = RoomWay::all(&robot, design.as_ref().map(|design| &design.schedule));
        let known = RoomKind::ALL.map(|kind| RoomGroup::of_kind(kind, 0..6, robot.radius_m()));
        let judgement = judge(&ways, &known, &RoomsOptions::default(), &|_| true).expect("a judgement");
        let (Some(best), Some(base)) = (judgement.best(), judgement.ways.first()) else {
            println!("| {name} | none |");
            continue;
        };
        let unseen = Unseen::of(best, base, first..first + places);
        counts.add(best, &unseen);
        let [least, most] = best.blind_90;
        let blind: Vec<f64> = unseen.rooms.iter().map(|(seen, _)| seen.blind_of_one).collect();
        let stale: usize = unseen.rooms.iter().map(|(seen, _)| seen.stale).sum();
        print!(
            "| {name} | {} | {least} to {most} | {:.2} | {} |",
            best.way.name,
            blind.iter().sum::<f64>() / blind.len() as f64,
            blind.iter().copied().fold(0.0, f64::max)
        );
        if best.way == base.way {
            println!(" | | {stale} |");
            continue;
        }
        let (measured, [low, high]) = unseen.measured(&mut random);
        let said = best.echoes_against(base).unwrap_or(1.0);
        let [least, most] = best.times_95.unwrap_or([said; 2]);
        counts.above += usize::from(least > measured);
        counts.too_high += usize::from(least > high);
        counts.ratios.push(said / measured);
        println!(" {said:.2} ({least:.2} to {most:.2}) | {measured:.2} ({low:.2} to {high:.2}) | {stale} |");
    }
    counts.tell();
    Ok(())
}
