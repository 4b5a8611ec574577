//! `survey` on rings whose paths are known: fired by core's own plan, in a world in which each pair has two paths.

use eeruf_core::{Micros, survey::SurveyPlan};
use eeruf_logs::{Firing, FiringLog, McapWriter, PathSettings, survey};

use crate::random::Random;

const SENSORS: usize = 5;
const DEAD: i64 = 1_500;
const WINDOW: i64 = 30_000;

/// Travel times of sound from the first index to the second.
type Travel = [[Vec<i64>; SENSORS]; SENSORS];

fn room(random: &mut Random) -> Travel {
    let mut travel = Travel::default();
    for x in 0..SENSORS {
        for y in x..SENSORS {
            let first = 4_000 + random.below(4_000);
            let both = if x == y { vec![7_000 + random.below(2_000)] } else { vec![first, first + 4_000] };
            (travel[x][y], travel[y][x]) = (both.clone(), both);
        }
    }
    // Two that do not hear each other.
    (travel[1][3], travel[3][1]) = (vec![], vec![]);
    travel
}

/// The log of a survey; this many of a hundred firings meet a stray noise first.
fn log(travel: &Travel, random: &mut Random, strays: i64) -> FiringLog {
    let plan = SurveyPlan::new(SENSORS as u8).with_leads(24, Micros::new(500));
    let mut firings = vec![];
    for slot in 0..plan.slots() {
        let begins = 110_000 * i64::from(slot);
        let after = |(sensor, after): (u8, Micros)| (sensor, begins + i64::from(after.as_micros()));
        let fired: Vec<_> = plan.firings(slot).map(after).collect();
        for &(sensor, at) in &fired {
            let edges = fired.iter().flat_map(|&(other, sent)| {
                travel[usize::from(other)][usize::from(sensor)].iter().map(move |travel| sent + travel - at)
            });
            let mut edges: Vec<_> = edges.map(|edge| edge + random.below(41) - 20).collect();
            if random.below(100) < strays {
                edges.push(random.below(WINDOW));
            }
            let first = edges.into_iter().filter(|edge| (DEAD..WINDOW).contains(edge)).min();
            let t_echo_us = first.map(|edge| edge as u32);
            firings.push(Firing {
                sensor,
                fired_us: at,
                period: slot,
                phase: 0,
                t_echo_us,
                reading: None,
                g_us_ms: None,
            });
        }
    }
    FiringLog::new("test", firings)
}

/// Returns true if the room has this path.
fn is_there(travel: &Travel, sender: u8, receiver: u8, travel_us: f64) -> bool {
    travel[usize::from(sender)][usize::from(receiver)].iter().any(|&us| (us as f64 - travel_us).abs() < 60.0)
}

#[test]
fn survey_finds_who_hears_whom_among_strays() {
    for (seed, strays) in [(1, 0), (2, 0), (3, 10), (4, 10), (5, 20)] {
        let random = &mut Random(seed);
        let travel = room(random);
        let found = survey(&log(&travel, random, strays), &PathSettings::default());
        for path in &found.paths {
            assert!(is_there(&travel, path.sender, path.receiver, path.travel_us), "seed {seed}: {path:?}");
            assert!(path.accidents <= 0.01 && path.offsets.0 >= 2 && path.travel_error_us < 30.0, "{path:?}");
        }
        let mut missed = 0;
        for x in 0..SENSORS as u8 {
            for y in 0..SENSORS as u8 {
                // The first path is what matters; the second one's end is hidden by the own echo at times.
                let first = travel[usize::from(x)][usize::from(y)].first();
                let seen = |us: &i64| found.between(x, y).any(|path| (path.travel_us - *us as f64).abs() < 60.0);
                missed += u32::from(first.is_some_and(|us| !seen(us)));
            }
        }
        assert!(missed <= u32::from(strays > 10), "seed {seed}: {missed} of 23 first paths missed");
        let conflicts: Vec<_> = found.conflicts(30_000).iter().map(|&(x, y, _)| (x, y)).collect();
        assert!(!conflicts.contains(&(1, 3)) && conflicts.len() >= 8, "{conflicts:?}");
    }
}

#[test]
fn a_conflict_lasts_as_long_as_the_longest_path_in_time() {
    let mut travel = Travel::default();
    for (sensor, row) in travel.iter_mut().enumerate() {
        row[sensor] = vec![9_000];
    }
    travel[0][1] = vec![3_000, 8_000];
    travel[1][0] = vec![3_000];
    travel[2][4] = vec![14_000];
    let found = survey(&log(&travel, &mut Random(1), 0), &PathSettings::default());
    let [(x, y, longest)] = found.conflicts(10_000)[..] else { panic!("{:?}", found.conflicts(10_000)) };
    assert_eq!((x, y), (0, 1));
    assert!((longest - 8_000.0).abs() < 30.0, "{longest}");
    assert_eq!(found.conflicts(15_000).len(), 2);
    assert_eq!(found.conflicts(2_900), []);
    // Nearly all travel times would be seen, by a sender that fires earlier or later; of one that does not exist, none.
    let visible = [(1, 15_000), (1, 128_000), (9, 15_000)].map(|(sender, until)| found.visible(0, sender, until));
    assert!(visible[0] > 0.7 && visible[1] < 0.5 && visible[2] == 0.0, "{visible:?}");
    assert_eq!((found.slots(0, 1), found.slots(0, 0), found.slots(0, 9)), (48, 3 + 2 * 4 * 24, 0));
}

// Modules that can listen without sending are surveyed in one pass.
#[test]
fn listening_modules_are_surveyed_in_one_pass() {
    let random = &mut Random(7);
    let travel = room(random);
    let (mut firings, mut listened) = (vec![], vec![]);
    for slot in 0..SENSORS as u32 * 8 {
        let (sender, at) = ((slot as usize % SENSORS), 100_000 * i64::from(slot));
        for receiver in 0..SENSORS {
            let first = travel[sender][receiver].iter().map(|us| us + random.below(41) - 20).min();
            let (sensor, t_echo_us) = (receiver as u8, first.map(|us| us as u32));
            let row = Firing { sensor, fired_us: at, period: slot, phase: 0, t_echo_us, reading: None, g_us_ms: None };
            if receiver == sender { &mut firings } else { &mut listened }.push(row);
        }
    }
    let log = FiringLog { listened, ..FiringLog::new("test", firings) };
    let mut text = Vec::new();
    log.write(&mut text).unwrap();
    let read = FiringLog::read_from(&text[..], "log".as_ref()).unwrap();
    assert_eq!(read, log);
    let found = survey(&read, &PathSettings::default());
    // Each pair but one hears the other's first path, and each sensor itself.
    assert_eq!(found.paths.len(), 25 - 2, "{:?}", found.paths);
    assert!(found.paths.iter().all(|path| is_there(&travel, path.sender, path.receiver, path.travel_us)));
}

// A firing log in mcap is the same as in csv and a cut one says so.
#[test]
fn firing_log_in_mcap_equals_csv() {
    let random = &mut Random(3);
    let log = log(&room(random), random, 5);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("log.mcap");
    let mut out = McapWriter::create(&file).unwrap();
    for firing in &log.firings {
        out.firing("/ring/firings", "test", firing.fired_us as u64 * 1000, firing).unwrap();
    }
    out.transforms("/else", 1, &[]).unwrap();
    out.finish().unwrap();
    assert_eq!(FiringLog::read(&file).unwrap(), log);

    let whole = std::fs::read(&file).unwrap();
    std::fs::write(&file, &whole[..whole.len() / 2]).unwrap();
    match FiringLog::read(&file) {
        Ok(part) => assert!(part.damage.is_some() && part.firings.len() < log.firings.len()),
        Err(error) => assert!(error.to_string().contains("0 firings"), "{error}"),
    }

    let mut out = McapWriter::create(&file).unwrap();
    out.firing("/a", "test", 1, &log.firings[0]).unwrap();
    out.firing("/b", "test", 1, &log.firings[1]).unwrap();
    out.finish().unwrap();
    let said = FiringLog::read(&file).unwrap_err().to_string();
    assert!(said.ends_with("firings of several rings: /a, /b; expected one topic"), "{said}");
    let mut out = McapWriter::create(&file).unwrap();
    out.firing("/a", "test", 1, &Firing { sensor: 64, ..log.firings[0].clone() }).unwrap();
    out.finish().unwrap();
    let said = FiringLog::read(&file).unwrap_err().to_string();
    assert!(said.contains("expected sensor (0 to 63), fired_us, period, phase and t_echo_us"), "{said}");
}
