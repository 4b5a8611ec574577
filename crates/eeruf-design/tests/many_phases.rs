//! Every ring of `rings/` with many phases, from its file to readings: the schedule keeps each limit and pair.

use std::f64::consts::TAU;

use eeruf_core::{
    Criterion, Instant, MAX_SENSORS, Micros, Phase, ReadingKind, Requirements, RingEvent, Uneven,
    adaptation::Adaptation,
    conditions::ViolationKind,
    hopping::{HoppingListening, HoppingRing, HoppingSettings},
    judge::TrackerSettings,
};
use eeruf_design::{PhaseFile, PhaseSchedule, RingSpec};
use eeruf_files::parse;
use eeruf_sim::{Air, Cause, Method, Noise, Options, Pose, Robot, Scene, Transducer, Wall, World, simulate};

/// Name, file, and the longest period that many phases may take, in microseconds.
const RINGS: [(&str, &str, u32); 8] = [
    ("paper-12", include_str!("../../../rings/paper-12.toml"), 132_000),
    ("ring-24", include_str!("../../../rings/ring-24.toml"), 250_000),
    ("round-16", include_str!("../../../rings/round-16.toml"), 99_100),
    ("car-12", include_str!("../../../rings/car-12.toml"), 55_000),
    ("hc-sr04-8", include_str!("../../../rings/hc-sr04-8.toml"), 63_400),
    ("hc-sr04-8-two-multiplexers", include_str!("../../../rings/hc-sr04-8-two-multiplexers.toml"), 70_000),
    ("labmate-8", include_str!("../../../rings/labmate-8.toml"), 49_700),
    ("mower-8-and-4", include_str!("../../../rings/mower-8-and-4.toml"), 69_000),
];

fn spec(text: &str) -> RingSpec {
    RingSpec::from_text(text).unwrap_or_else(|error| panic!("{error}"))
}

fn read(text: &str) -> PhaseSchedule {
    parse::<PhaseFile>(text).expect("a file").schedule().expect("a schedule")
}

/// A corridor of 3 m with the ring in it, where its file or its layout says, else on a circle, and no more jitter than
/// its `t_delta` is for.
fn corridor(spec: &RingSpec, period: Micros, t_delta: Micros) -> World {
    let circle = Robot::ring(Pose::identity(), spec.sensors, TAU / spec.sensors as f64, 0.2, Transducer::HC_SR04);
    let of_layout = || spec.robot_ring().robot(Pose::identity(), Some(circle.sensors)).expect("a robot");
    let mut robot = spec.room_robot().map_or_else(|_| of_layout(), |of_file| of_file.robot);
    robot.period = period;
    let walls = vec![Wall::new(-9.0, -1.5, 9.0, -1.5), Wall::new(9.0, 1.5, -9.0, 1.5)];
    let scene = Scene::new(walls, vec![], Air::default()).expect("a scene");
    let noise = Noise { jitter_us_rms: f64::from(t_delta.as_micros()) / 20.0, ..Noise::default() };
    World::new(scene, vec![robot], noise).expect("a world")
}

#[test]
fn every_ring_hops_from_file_to_readings() {
    for (name, text, longest) in RINGS {
        let spec = spec(text);
        let design = spec.hopping(4, Criterion::Exact).unwrap_or_else(|error| panic!("{name}: {error}"));
        let requirements = spec.phase_requirements(Criterion::Exact);
        let file = design.phases().to_toml().expect("it hops");
        let schedule = read(&file);
        assert_eq!(schedule, design.phases(), "{name}");
        let report = schedule.verify(&requirements);
        assert_eq!(report.first_violation(), None, "{name}");
        let period = schedule.period().as_micros();
        assert!(period <= longest && schedule.period() >= design.period_bound, "{name}: {period} us");
        // The ring of core, under simulated time.
        let hops = schedule.hopping().copied().expect("it hops");
        // Each schedule that it adapts to keeps the same needs.
        for (num, den) in [(4, 3), (5, 3), (1_001, 1_000)] {
            let slower = hops.scaled(num, den).expect("a schedule");
            assert_eq!(slower.verify(&requirements).first_violation(), None, "{name}: {num}/{den}");
        }
        let t_delta = requirements.t_delta;
        let near = TrackerSettings::BALANCED.near.max(t_delta);
        let within = TrackerSettings::BALANCED.tentative_within.min(t_delta);
        let tracker = TrackerSettings::BALANCED.with_t_delta(t_delta).with_near(near).with_tentative_within(within);
        let hopping = HoppingSettings::BALANCED.with_tracker(tracker);
        let options = Options { hopping, hopping_schedule: Some(hops), ..Options::periods(60) };
        let readings = simulate(&corridor(&spec, schedule.period(), t_delta), Method::EerufHopping, &options)
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        let believed = |k: &usize| readings.is_accepted(*k);
        let accepted: Vec<_> = (0..readings.len()).filter(believed).collect();
        let foreign = accepted.iter().filter(|&&k| readings.cause[k] == Cause::Crosstalk).count();
        assert!(accepted.len() > readings.len() / 5, "{name}: {} of {}", accepted.len(), readings.len());
        assert!(foreign * 10 < accepted.len(), "{name}: {foreign} of {}", accepted.len());
        for k in 0..readings.len() {
            let window = requirements.window_of(readings.sensor[k].into()).as_micros();
            assert!(!(readings.t_echo_us[k] > f64::from(window)), "{name}: {}", readings.t_echo_us[k]);
        }
        if let [first, ..] = schedule.together() {
            // Those that fire together do so at the very same instants.
            let (x, y) = (first.trailing_zeros() as u8, 63 - first.leading_zeros() as u8);
            let times = |sensor: u8| -> Vec<f64> {
                (0..readings.len())
                    .filter(|&k| {
                        readings.sensor[k] == sensor && readings.weighed[k].is_some_and(|weighed| !weighed.solo)
                    })
                    .map(|k| readings.fired_s[k])
                    .collect()
            };
            let (of_x, of_y) = (times(x), times(y));
            assert!(of_x.iter().filter(|&at| of_y.contains(at)).count() > 30, "{name}");
        }
    }
}

/// No lags give a code a shorter period than this. Over a cycle the waits of any two sensors differ by every residue of
/// the code's prime once, as a positive number of steps or as a negative one, and by 0 at the mean: of half the phases
/// positive, so that one wait is longer than the other by half the phases or more, either way round. Of n neighbours
/// that take turns, each loses as much beside its interval.
fn lags_need(spec: &RingSpec, schedule: &PhaseSchedule) -> Micros {
    let requirements = spec.phase_requirements(Criterion::Exact);
    let sensors = spec.sensors;
    let gap = |x, y| requirements.gap_after(sensors, x, y).min(requirements.gap_after(sensors, y, x)).as_micros();
    let leads = |x: usize| (0..x).all(|other| !requirements.fire_together(other, x));
    let mut gaps: Vec<_> = (0..sensors).flat_map(|y| (0..y).map(move |x| (x, y))).map(|(x, y)| gap(x, y)).collect();
    gaps.retain(|&gap| gap > 0);
    let code = *schedule.hopping().expect("it hops").code();
    let loss = u32::from(code.phases() / 2) * code.step().as_micros();
    let members = |least: u32, from: usize| {
        let mut members = vec![from];
        for x in (0..sensors).filter(|&x| x != from && leads(x)) {
            if members.iter().all(|&member| gap(member, x) >= least) {
                members.push(x);
            }
        }
        members.len() as u32
    };
    let of = |&least: &u32| {
        let most = (0..sensors).filter(|&x| leads(x)).map(|from| members(least, from)).max().unwrap_or(0);
        most * (least + loss)
    };
    Micros::new(gaps.iter().map(of).max().unwrap_or(0))
}

// No period is shorter than its code needs, and those of the paper's ring and the ring of 24 are beyond 1.5 times that
// of two phases whatever the lags.
#[test]
fn long_periods_are_those_that_codes_need() {
    // Two phases, of docs/explanation/hopping.md, in microseconds.
    let two_phases = |name| match name {
        "paper-12" => Some(65_000),
        "ring-24" => Some(76_000),
        _ => None,
    };
    for (name, text, _) in RINGS {
        let spec = spec(text);
        let schedule = spec.hopping(4, Criterion::Exact).expect("a schedule").phases();
        let (needs, found) = (lags_need(&spec, &schedule), schedule.period());
        println!("{name}: found {found}, needs {needs}");
        assert!(found >= needs, "{name}: {found}, {needs}");
        assert!(two_phases(name).is_none_or(|us| 2 * needs.as_micros() > 3 * us), "{name}: {needs}");
    }
}

// Of a ring file come two schedules with one code; the ring changes to the slower one, and what it then believes is its
// own.
#[test]
fn ring_of_a_file_hops_and_adapts() {
    let (_, text, _) = RINGS.into_iter().find(|(name, ..)| *name == "hc-sr04-8").expect("it is there");
    let spec = spec(text);
    let requirements = spec.phase_requirements(Criterion::Exact);
    let schedule = spec.hopping(4, Criterion::Exact).expect("a schedule").phases();
    let fast = *schedule.hopping().expect("it hops");
    let slow = fast.scaled(2, 1).expect("a longer period");
    let rungs = [fast, slow];
    let mut adaptation = Adaptation::hopping(&rungs).expect("a ladder");
    let t_delta = requirements.t_delta;
    let near = TrackerSettings::BALANCED.near.max(t_delta);
    let within = TrackerSettings::BALANCED.tentative_within.min(t_delta);
    let tracker = TrackerSettings::BALANCED.with_t_delta(t_delta).with_near(near).with_tentative_within(within);
    let settings = HoppingSettings::BALANCED.with_tracker(tracker);
    let listening = HoppingListening::new(requirements.window_of(0));
    let mut ring =
        HoppingRing::<MAX_SENSORS>::hopping(&fast, settings, listening, 1, Instant::default()).expect("a ring");
    // Something else each time as long as the period is short, then a wall at 1.5 m.
    let (mut firings, mut accepted) = (0, [0; 8]);
    for _ in 0..20_000 {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    firings += 1;
                    let other = 1_000 + 1_900 * (firings * 7 % 10);
                    let t_echo = Micros::new(if adaptation.rung() == 0 { other } else { 8_700 });
                    ring.echo(sensor, now + t_echo).expect("a sensor of the ring");
                }
                RingEvent::Reading(reading) if reading.kind == ReadingKind::Accepted => {
                    assert_eq!(reading.t_echo, Some(Micros::new(8_700)), "{reading:?}");
                    accepted[usize::from(reading.sensor)] += 1;
                }
                RingEvent::Reading(_) => {}
                RingEvent::PeriodEnded(stats) => {
                    adaptation.adapt(&stats, |schedule| ring.change_hopping(schedule)).expect("the same code");
                }
            }
        }
        if accepted.iter().all(|&accepted| accepted > 20) {
            break;
        }
    }
    assert!(accepted.iter().all(|&accepted| accepted > 20), "{accepted:?}");
    assert_eq!(adaptation.rung(), 1);
}

/// The firing times of a schedule, to change one.
fn table(schedule: &PhaseSchedule) -> Vec<Vec<u32>> {
    let row = |phase| {
        let time = |sensor| schedule.t_fire(Phase(phase as u8), sensor).expect("it is there").as_micros();
        (0..schedule.sensors()).map(time).collect()
    };
    (0..schedule.phases()).map(row).collect()
}

/// The kinds of violations of a table whose sensor fires `later` in one phase.
fn broken(schedule: &PhaseSchedule, asked: &Requirements<'_>, at: (usize, usize), later: u32) -> Vec<ViolationKind> {
    let mut times = table(schedule);
    times[at.0][at.1] += later;
    let file = format!("period_us = {}\nt_fire_us = {times:?}", schedule.period().as_micros());
    read(&file).verify(asked).violations().map(|violation| violation.kind).collect()
}

// Each limit by itself, tightened by a microsecond beyond what the schedule has, is refused.
#[test]
fn each_limit_of_car_and_mower_is_kept_in_every_phase() {
    for (name, text, _) in RINGS.into_iter().filter(|(name, ..)| ["car-12", "mower-8-and-4"].contains(name)) {
        let spec = spec(text);
        let schedule = spec.hopping(4, Criterion::Exact).expect("a schedule").phases();
        let asked = spec.phase_requirements(Criterion::Exact);
        let uneven = asked.uneven.expect("it is uneven");
        assert_eq!(schedule.verify(&asked).violations().count(), 0, "{name}");
        let rows = table(&schedule);
        let period = schedule.period().as_micros();
        let phases = rows.len();
        let refires = |x: usize| (0..phases).map(move |m| (m, (m + 1) % phases)).map(move |(m, n)| (x, m, n));
        for x in 0..spec.sensors {
            // The window of one sensor alone.
            let shortest = refires(x).map(|(x, m, n)| rows[n][x] + period - rows[m][x]).min().expect("phases");
            let mut windows = uneven.window.to_vec();
            windows[x] = Micros::new(shortest + 1);
            let wider = Requirements { uneven: Some(Uneven { window: &windows, ..uneven }), ..asked };
            let kinds: Vec<_> = schedule.verify(&wider).violations().map(|found| found.kind).collect();
            assert!(kinds.contains(&ViolationKind::Window), "{name} {x}: {kinds:?}");
            // The time until it may be triggered again.
            let mut refire = vec![Micros::ZERO; spec.sensors];
            refire[x] = Micros::new(shortest + 1);
            let later = Requirements { uneven: Some(Uneven { refire: &refire, ..uneven }), ..asked };
            let kinds: Vec<_> = schedule.verify(&later).violations().map(|found| found.kind).collect();
            assert_eq!(kinds, [ViolationKind::Refire], "{name} {x}");
            // Its t_delta: crosstalk moves by the step of the code, and by no more.
            let step = schedule.hopping().expect("it hops").code().step().as_micros();
            let mut t_deltas = uneven.t_delta.to_vec();
            t_deltas[x] = Micros::new(step.div_ceil(2));
            let coarser = Requirements { uneven: Some(Uneven { t_delta: &t_deltas, ..uneven }), ..asked };
            let kinds: Vec<_> = schedule.verify(&coarser).violations().map(|found| found.kind).collect();
            assert!(kinds.contains(&ViolationKind::Crosstalk), "{name} {x}: {kinds:?}");
        }
        // The interval of each pair that has one of its own, in the phase in which it is shortest.
        let apart = |x: usize, y: usize| {
            let of = |m: usize| {
                let next = (m + 1) % phases;
                let across = [rows[next][y] + period - rows[m][x], rows[next][x] + period - rows[m][y]];
                across.into_iter().chain([rows[m][x].abs_diff(rows[m][y])])
            };
            (0..phases).flat_map(of).min().expect("phases")
        };
        for (at, &(x, y, interval)) in uneven.intervals.iter().enumerate() {
            let shortest = apart(x.into(), y.into());
            assert!(shortest >= interval.as_micros(), "{name}: {x} {y}");
            let mut intervals = uneven.intervals.to_vec();
            intervals[at].2 = Micros::new(shortest + 1);
            let longer = Requirements { uneven: Some(Uneven { intervals: &intervals, ..uneven }), ..asked };
            let kinds: Vec<_> = schedule.verify(&longer).violations().map(|found| found.kind).collect();
            assert_eq!(kinds, [ViolationKind::Interval], "{name}: {x} {y}");
        }
        // A sensor of a group that fires 1 us later in one phase.
        if let Some(set) = uneven.together.first() {
            let kinds = broken(&schedule, &asked, (3, set.trailing_zeros() as usize), 1);
            assert!(kinds.contains(&ViolationKind::Together), "{name}: {kinds:?}");
        }
    }
}

#[test]
fn sensors_on_a_shared_line_wait_for_its_window_in_every_phase() {
    let (_, text, _) = RINGS.into_iter().find(|(name, ..)| name.ends_with("multiplexers")).expect("it is there");
    let spec = spec(text);
    let schedule = spec.hopping(4, Criterion::Exact).expect("a schedule").phases();
    let asked = spec.phase_requirements(Criterion::Exact);
    assert_eq!(schedule.verify(&asked).first_violation(), None);
    // 0 and 4 are no neighbours, and share a line.
    let rows = table(&schedule);
    let after = |m: usize| rows[m][4].abs_diff(rows[m][0]);
    let (phase, apart) = (0..rows.len()).map(|m| (m, after(m))).min_by_key(|&(_, apart)| apart).expect("phases");
    assert!(apart >= asked.window_of(0).min(asked.window_of(4)).as_micros());
    let (first, later) = if rows[phase][0] < rows[phase][4] { (0, 4) } else { (4, 0) };
    let short = apart - asked.window_of(first).as_micros() + 1;
    let kinds = broken(&schedule, &asked, (phase, first), short);
    assert!(kinds.contains(&ViolationKind::SharedLine), "{first} {later}: {kinds:?}");
}
