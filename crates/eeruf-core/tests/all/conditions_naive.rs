//! Compares the conditions and the verifier with plain formulas, pair by pair, on seeded pseudo-random schedules.

use eeruf_core::{
    Criterion, Instant, Layout, Micros, Phase, ReadingKind, Requirements, Schedule, SpeedOfSound,
    conditions::{Least, ViolationKind},
};

use crate::common::random::Random;

const SENSORS: usize = 5;

fn draw_schedule<const M: usize>(random: &mut Random, period: u32) -> Schedule<SENSORS, M> {
    let lag = [(); SENSORS].map(|()| random.up_to(period / 2));
    let wait = [(); M].map(|()| lag.map(|lag| random.up_to(period - 1 - lag)));
    Schedule::new(Micros::new(period), lag.map(Micros::new), wait.map(|wait| wait.map(Micros::new))).unwrap()
}

fn draw_layout(random: &mut Random) -> Layout<'static> {
    match random.up_to(3) {
        0 => Layout::Line(random.up_to(5) as u8),
        1 => Layout::Ring(random.up_to(4) as u8),
        2 => Layout::Blocks(random.up_to(4) as u8),
        _ => Layout::Graph(&[0b10010, 0, 0b01000, 0, 0]),
    }
}

/// `T_x,phase`, the paper's wait.
fn wait<const M: usize>(schedule: &Schedule<SENSORS, M>, phase: usize, x: usize) -> i64 {
    schedule.t_wait(Phase(phase as u8))[x].as_micros().into()
}

fn fire<const M: usize>(schedule: &Schedule<SENSORS, M>, phase: usize, x: usize) -> i64 {
    schedule.t_lag()[x].as_micros() as i64 + wait(schedule, phase, x)
}

/// The left sides of (13a) and (13b) as the documentation writes them.
fn left_sides(schedule: &Schedule<SENSORS>, criterion: Criterion, x: usize, y: usize) -> [i64; 2] {
    let (xa, xb) = (wait(schedule, 0, x), wait(schedule, 1, x));
    let (ya, yb) = (wait(schedule, 0, y), wait(schedule, 1, y));
    match criterion {
        Criterion::Paper => [((xa - ya).abs() - (xb - yb).abs()).abs(), ((xa - yb).abs() - (xb - ya).abs()).abs()],
        Criterion::Exact | Criterion::Margin(_) => [((xa - xb) - (ya - yb)).abs(), ((xa - xb) + (ya - yb)).abs()],
    }
}

/// Two sensors, the phases in which they fire, and the time between the firings.
type Apart = ((u8, u8), (Phase, Phase), i64);

/// All intervals between neighbours.
fn intervals<const M: usize>(schedule: &Schedule<SENSORS, M>, layout: Layout<'_>) -> Vec<Apart> {
    let mut intervals = vec![];
    for phase in 0..M {
        for x in 0..SENSORS {
            for y in (0..SENSORS).filter(|&y| layout.neighbours(SENSORS, x, y)) {
                let (sensors, next) = ((x as u8, y as u8), (phase + 1) % M);
                let (here, there) = (Phase(phase as u8), Phase(next as u8));
                if x < y {
                    let within = (fire(schedule, phase, x) - fire(schedule, phase, y)).abs();
                    intervals.push((sensors, (here, here), within));
                }
                let period = i64::from(schedule.period().as_micros());
                let across = period + fire(schedule, next, y) - fire(schedule, phase, x);
                intervals.push((sensors, (here, there), across));
            }
        }
    }
    intervals
}

fn refires<const M: usize>(schedule: &Schedule<SENSORS, M>) -> Vec<(u8, usize, i64)> {
    let period = i64::from(schedule.period().as_micros());
    let refire = |phase, x| period + fire(schedule, (phase + 1) % M, x) - fire(schedule, phase, x);
    (0..M).flat_map(|phase| (0..SENSORS).map(move |x| (x as u8, phase, refire(phase, x)))).collect()
}

fn assert_is_smallest<const M: usize>(schedule: &Schedule<SENSORS, M>, layout: Layout<'_>) {
    let all = intervals(schedule, layout);
    let smallest = all.iter().map(|&(_, _, value)| value).min();
    match schedule.min_interval(layout) {
        Some(Least { value, sensors, phases, .. }) => {
            assert_eq!(Some(i64::from(value.as_micros())), smallest, "{layout:?} {schedule:?}");
            assert!(all.contains(&(sensors, phases, value.as_micros().into())));
        }
        None => assert_eq!(smallest, None, "{layout:?} {schedule:?}"),
    }
    let shortest = refires(schedule).iter().map(|&(_, _, value)| value).min();
    assert_eq!(Some(i64::from(schedule.min_refire().as_micros())), shortest);
}

// The smallest interval and refire time are the smallest over all of one, two or three phases.
#[test]
fn smallest_interval_is_the_smallest_of_all_phases() {
    let mut random = Random(1);
    for _ in 0..1000 {
        let (period, layout) = (10 + random.up_to(90), draw_layout(&mut random));
        assert_is_smallest(&draw_schedule::<1>(&mut random, period), layout);
        assert_is_smallest(&draw_schedule::<2>(&mut random, period), layout);
        assert_is_smallest(&draw_schedule::<3>(&mut random, period), layout);
    }
}

#[test]
fn the_separation_is_the_smallest_left_side_of_all_pairs() {
    let mut random = Random(2);
    for _ in 0..2000 {
        let schedule = draw_schedule::<2>(&mut random, 50);
        for criterion in [Criterion::Exact, Criterion::Paper] {
            let pairs = (0..SENSORS).flat_map(|y| (0..y).map(move |x| (x, y)));
            let least = pairs.flat_map(|(x, y)| left_sides(&schedule, criterion, x, y)).min().unwrap();
            let Least { value, sensors: (x, y), .. } = schedule.separation(criterion).unwrap();
            assert_eq!(i64::from(value.as_micros()), least, "{criterion} {schedule:?}");
            assert!(x < y);
            let sides = left_sides(&schedule, criterion, x.into(), y.into());
            // Under the stronger criterion the two come from the closest waits; only some sides are that close.
            assert!(criterion == Criterion::Paper || sides.contains(&least), "{criterion} {schedule:?}");
        }
    }
    let alone = Schedule::<1>::from_firing(Micros::new(9), [[Micros::new(1)], [Micros::new(4)]]).unwrap();
    assert_eq!((alone.separation(Criterion::Exact), alone.shift_us(0), alone.shift_us(1)), (None, -3, 0));
}

#[test]
fn the_verifier_names_every_violation_and_no_other() {
    let mut random = Random(3);
    let mut by_kind = [0; 5];
    for _ in 0..3000 {
        let schedule = draw_schedule::<2>(&mut random, 200);
        let requirements = Requirements {
            criterion: if random.up_to(1) == 0 { Criterion::Exact } else { Criterion::Paper },
            min_interval: Micros::new(random.up_to(20)),
            layout: draw_layout(&mut random),
            window: Micros::new(random.up_to(120)),
            stale_echo: random.up_to(1) == 0,
            ..Requirements::new(Micros::new(random.up_to(4)))
        };
        let separation = 2 * i64::from(requirements.t_delta.as_micros()) + 1;
        let (interval, window) = (requirements.min_interval.as_micros().into(), requirements.window.as_micros().into());
        let mut expected = vec![];
        let mut expect = |kind, sensors, phases, value, required| {
            if value < required {
                expected.push((kind, sensors, phases, value, required));
            }
        };
        let (both_a, mut least) = ((Phase::A, Phase::A), i64::MAX);
        for side in [0, 1] {
            for x in 0..SENSORS {
                for y in x + 1..SENSORS {
                    let value = left_sides(&schedule, requirements.criterion, x, y)[side];
                    let kind = [ViolationKind::CrosstalkA, ViolationKind::CrosstalkB][side];
                    expect(kind, (x as u8, y as u8), both_a, value, separation);
                    least = least.min(value);
                }
            }
        }
        for x in (0..SENSORS).filter(|_| requirements.stale_echo) {
            let value = 2 * (wait(&schedule, 0, x) - wait(&schedule, 1, x)).abs();
            expect(ViolationKind::StaleEcho, (x as u8, x as u8), both_a, value, separation);
            least = least.min(value);
        }
        for (sensors, phases, value) in intervals(&schedule, requirements.layout) {
            expect(ViolationKind::Interval, sensors, phases, value, interval);
        }
        for (x, phase, value) in refires(&schedule) {
            let phases = (Phase(phase as u8), Phase(1 - phase as u8));
            expect(ViolationKind::Window, (x, x), phases, value, window);
        }
        let report = schedule.verify(&requirements);
        let mut found: Vec<_> = report
            .violations()
            .map(|v| (v.kind, v.sensors, v.phases, v.value.as_micros().into(), v.required.as_micros().into()))
            .collect();
        for violation in &found {
            by_kind[violation.0 as usize] += 1;
        }
        // For a window, the phase after which it is too long counts; the second phase may be anything.
        let order = |v: &(ViolationKind, (u8, u8), (Phase, Phase), i64, i64)| (v.0 as u8, v.1, v.2);
        for list in [&mut found, &mut expected] {
            for violation in list.iter_mut().filter(|violation| violation.0 == ViolationKind::Window) {
                violation.2.1 = violation.2.0;
            }
            list.sort_by_key(order);
        }
        assert_eq!(found, expected, "{requirements:?} {schedule:?}");
        assert_eq!(report.ok(), expected.is_empty());
        assert_eq!(report.separation(), schedule.separation(requirements.criterion));
        assert_eq!(report.min_interval(), schedule.min_interval(requirements.layout));
        assert_eq!(report.min_refire(), schedule.min_refire());
        let max_t_delta = report.max_t_delta().map(|t_delta| i64::from(t_delta.as_micros()));
        assert_eq!(max_t_delta, (least > 0).then(|| (least - 1) / 2));
    }
    assert!(by_kind.iter().all(|&often| often > 100), "{by_kind:?}");
}

#[test]
fn neighbours_stand_less_than_so_many_steps_apart() {
    for sensors in 1..=13_usize {
        for n in 0..=14_u8 {
            for x in 0..sensors {
                for y in 0..sensors {
                    let other = x != y;
                    // By this many steps to either side.
                    let line = (1..n.into()).any(|step| x + step == y || y + step == x);
                    let ring = (1..n.into()).any(|step| (x + step) % sensors == y || (y + step) % sensors == x);
                    let block = (0..sensors).any(|first| {
                        let members = first..first + usize::from(n);
                        n > 0 && first % usize::from(n) == 0 && members.contains(&x) && members.contains(&y)
                    });
                    let answers =
                        [Layout::Line(n), Layout::Ring(n), Layout::Blocks(n)].map(|of| of.neighbours(sensors, x, y));
                    assert_eq!(answers, [line, ring, block].map(|near| near && other), "{sensors} {n} {x} {y}");
                }
            }
        }
    }
    for layout in [Layout::Line(9), Layout::Ring(9), Layout::Blocks(9), Layout::Graph(&[6, 5, 3])] {
        assert!(layout.neighbours(3, 0, 2));
        assert!(!layout.neighbours(2, 0, 2) && !layout.neighbours(2, 2, 0) && !layout.neighbours(2, 5, 9));
    }
    // Missing words and bits name no sensor.
    assert!(!Layout::Graph(&[0b10]).neighbours(3, 1, 2) && !Layout::Graph(&[1]).neighbours(65, 0, 64));
}

#[test]
fn a_violation_says_who_when_how_much_and_what_is_expected() {
    let us = |us: [u32; 2]| us.map(Micros::new);
    let schedule = Schedule::from_firing(Micros::new(100), [us([10, 20]), us([30, 45])]).unwrap();
    let requirements = Requirements {
        min_interval: Micros::new(86),
        window: Micros::new(86),
        stale_echo: true,
        ..Requirements::new(Micros::new(25))
    };
    let said: Vec<_> = schedule
        .verify(&requirements)
        .violations()
        .map(|violation| format!("{}: {violation}", violation.kind.as_str()))
        .collect();
    let crosstalk = "from one reading to the next; to be rejected it needs at least 51 us";
    let own = "(Eq. (13b) with x = y)";
    let neighbours = "neighbours need at least 86 us (Sec. 3.1 c)";
    assert_eq!(
        said,
        [
            format!("crosstalk_a: crosstalk between sensors 1 and 2 moves by 5 us {crosstalk} (Eq. (13a))"),
            format!("crosstalk_b: crosstalk between sensors 1 and 2 moves by 45 us {crosstalk} (Eq. (13b))"),
            format!("stale_echo: an echo of sensor 1 from the period before moves by 40 us {crosstalk} {own}"),
            format!("stale_echo: an echo of sensor 2 from the period before moves by 50 us {crosstalk} {own}"),
            format!("interval: sensors 1 and 2 fire 10 us apart in phase a; {neighbours}"),
            format!("interval: sensors 1 and 2 fire 15 us apart in phase b; {neighbours}"),
            format!("interval: sensors 2 and 1 fire 65 us apart between phases b and a; {neighbours}"),
            "window: sensor 1 fires again 80 us after phase b; it listens for 86 us (T_wind)".to_owned(),
            "window: sensor 2 fires again 75 us after phase b; it listens for 86 us (T_wind)".to_owned(),
        ]
    );
}

#[test]
fn a_reading_is_printed_by_its_name() {
    let names = [
        "first",
        "accepted",
        "rejected",
        "repeated",
        "no_echo",
        "clear",
        "too_early",
        "late",
        "stuck",
        "tentative",
        "ambiguous",
        "unanswered",
    ];
    assert_eq!(ReadingKind::ALL.map(ReadingKind::as_str), names);
    assert_eq!(format!("{:>9}|{}", ReadingKind::Clear, ReadingKind::Late), "    clear|late");
}

#[test]
fn times_add_and_subtract_as_far_as_they_go_and_instants_wrap() {
    let (one, two, most) = (Micros::new(1), Micros::new(2), Micros::MAX);
    assert_eq!((one.checked_add(two), most.checked_add(one)), (Some(Micros::new(3)), None));
    assert_eq!((two.checked_sub(one), one.checked_sub(two)), (Some(one), None));
    let mut now = Instant::from_micros(u32::MAX);
    now += two;
    assert_eq!((now.as_micros(), Instant::from_micros(7).as_micros()), (1, 7));
    assert!(now.has_reached(Instant::from_micros(u32::MAX)));
}

// Echo times and distances are rounded to the nearest and end at the largest.
#[test]
fn echo_times_and_distances_are_rounded() {
    let mut random = Random(4);
    let to_most = |exact: u128| u32::try_from(exact).unwrap_or(u32::MAX);
    for _ in 0..5000 {
        let bits = random.up_to(31);
        let (speed, number) = (1 + random.up_to(u32::MAX >> 1 >> bits), random.up_to(u32::MAX));
        let c = SpeedOfSound::from_mm_per_s(speed);
        assert_eq!(c.mm_per_s(), speed);
        let (s, n) = (u128::from(speed), u128::from(number));
        assert_eq!(c.distance_mm(Micros::new(number)), to_most((s * n + 1_000_000) / 2_000_000));
        assert_eq!(c.echo_time(number), Micros::new(to_most((n * 2_000_000 + s / 2) / s)));
    }
    let silent = SpeedOfSound::from_mm_per_s(0);
    assert_eq!((silent.echo_time(0), silent.distance_mm(Micros::MAX)), (Micros::MAX, 0));
}

#[test]
fn the_speed_of_sound_follows_the_root_of_the_temperature() {
    for tenths in [-2731, -2000, -400, 0, 1, 200, 850, i16::MAX] {
        let exact = 343_200.0 * ((273.15 + f64::from(tenths) / 10.0) / 293.15).sqrt();
        assert_eq!(SpeedOfSound::at_celsius_tenths(tenths).mm_per_s(), exact as u32, "{tenths}");
    }
    for tenths in [-2732, i16::MIN] {
        assert_eq!(SpeedOfSound::at_celsius_tenths(tenths).mm_per_s(), 0);
    }
}
