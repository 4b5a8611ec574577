//! One path of foreign sound, under any operations on the ring. The long run, of some ten million readings:
//! `RINGS=50000 cargo test -p eeruf-core --test all -- one_path_of`.

use eeruf_core::{
    Instant, Micros, Ring,
    flow::{Belief, BeliefSettings, FlowRing, InTurn, TurnSettings},
};

use super::world::{Dice, Operates, Seen, World};
use super::{BEGIN, CONFIG, DEFAULT};

/// The value to which doubt is held, if any.
#[derive(Clone, Copy, Debug)]
enum Doubt {
    Free,
    AtLeast,
    AtMost,
}

/// Runs a ring under random operations in which receivers without a wall hear one path each, from one sensor, with up
/// to `E` echoes per firing. Returns the numbers of readings compared and believed.
fn one_path<const E: usize>(seed: u32, speed_mm_s: u16, changes: bool, doubt: Doubt) -> (u32, u32) {
    let mut dice = Dice { state: u64::from(seed) << 20 | 77, travel: 0 };
    let sensors = 2 + dice.below(11) as usize;
    let late = [0, 50, 1000, 5000][dice.below(4) as usize];
    let top_mm_s = changes.then_some(speed_mm_s.into());
    let belief = BeliefSettings { top_speed_mm_s: speed_mm_s, ..DEFAULT };
    let turns = TurnSettings::new(seed);
    let (least, most) = match doubt {
        Doubt::Free => (turns.least, turns.most),
        Doubt::AtLeast => (turns.least, turns.least),
        Doubt::AtMost => (turns.most, turns.most),
    };
    let begin = Instant::from_micros(BEGIN);
    let plan =
        InTurn::<24>::new(sensors, TurnSettings { least, most, ..turns }, Micros::from_millis(25), begin).unwrap();
    let config = CONFIG.with_audible(turns.most).with_path_change(belief.path_change).with_echoes::<E>();
    let mut ring: FlowRing<24, E> = Ring::judged_by(plan, Belief::new(belief).unwrap(), config, begin).unwrap();
    ring.set_seed(seed ^ 0x5eed_0000).unwrap();
    let mut world = World::<_, E>::of(ring, seed, late, 1);
    world.operates =
        Some(Operates { speed_mm_s: speed_mm_s.into(), top_mm_s, told: 0, asleep_until: 0, paused: false });
    world.uncertain = [0, 0, 80, 160, 900][dice.below(5) as usize];
    let all = dice.below(4) > 0;
    let one = dice.below(sensors as u32) as usize;
    let paths = (0..sensors).map(|receiver| {
        let emitter = dice.below(sensors as u32) as u8;
        // Own second echoes count as foreign only after the window.
        let shortest = if usize::from(emitter) == receiver { 25_950_000 } else { 1_000_000 };
        let any = 1_000_000 + i64::from(dice.below(32_000)) * 1000;
        let length = if dice.below(4) == 0 { LONGEST } else { any.max(shortest) };
        (all || receiver == one).then_some(Path { emitter, shortest, length, travelled: 0, direction: 1 })
    });
    let mut paths: Vec<_> = paths.collect();
    let others: Vec<_> = (0..sensors).map(|_| 2_000 + dice.below(20_000)).collect();
    let mut seen = vec![Seen::default(); sensors];
    world.run(4_000_000, &mut seen, |now, sensor, dice| {
        let mut edges = vec![];
        for (receiver, path) in (0..).zip(&mut paths) {
            match path {
                Some(path) if path.emitter == sensor => edges.push((now + path.heard_after(dice), receiver)),
                None if receiver == sensor => edges.push((now + u64::from(others[usize::from(sensor)]), sensor)),
                _ => {}
            }
        }
        edges
    });
    let heard = seen.iter().zip(&paths).filter(|(_, path)| path.is_some());
    heard.fold((0, 0), |sum, (seen, _)| (sum.0 + seen.compared, sum.1 + seen.accepted))
}

/// The longest path, in nanoseconds: with its change it stays within R.
const LONGEST: i64 = 33_350_000;

/// A path of sound to a receiver. Times are in nanoseconds.
struct Path {
    emitter: u8,
    shortest: i64,
    length: i64,
    /// The accumulated change that the path might have shown when it was last heard.
    travelled: u64,
    direction: i64,
}

impl Path {
    /// Returns the time after which sound arrives along the path, in microseconds. Between two consecutive readings it
    /// changes by at most P and what the motion allows.
    fn heard_after(&mut self, dice: &mut Dice) -> u64 {
        let most = (dice.travel - self.travelled) as i64;
        self.travelled = dice.travel;
        self.length = (self.length + self.direction * most).clamp(self.shortest, LONGEST);
        if dice.below(20) == 0 || self.length <= self.shortest || self.length >= LONGEST {
            self.direction = -self.direction;
        }
        // The jitter takes up the rest of P.
        let most = 147;
        let jitter = if dice.below(2) == 0 { dice.below(most + 1) } else { most * dice.below(2) };
        self.length as u64 / 1000 + u64::from(jitter)
    }
}

#[test]
fn one_path_of_foreign_sound_is_never_believed() {
    let rings = std::env::var("RINGS").ok().and_then(|rings| rings.parse().ok()).unwrap_or(800);
    let (mut all, mut wrong) = (0, 0);
    for doubt in [Doubt::Free, Doubt::AtLeast, Doubt::AtMost] {
        for (speed, changes) in [(0, false), (500, false), (1000, true), (3600, false), (3600, true)] {
            let (mut compared, mut believed) = (0, 0);
            for seed in 1..=rings {
                let (of, accepted) = match seed % 4 {
                    0 => one_path::<3>(seed, speed, changes, doubt),
                    _ => one_path::<1>(seed, speed, changes, doubt),
                };
                compared += of;
                believed += accepted;
            }
            println!("{doubt:?}, {speed} mm/s, changes {changes}: {compared} readings compared, {believed} believed");
            all += compared;
            wrong += believed;
        }
    }
    println!("{all} readings compared, {wrong} believed");
    // With the most quiet, a sensor that has fired hears nothing foreign.
    assert!(all > 100 * rings, "{all}");
    assert_eq!(wrong, 0, "of {all}");
}
