//! Needs of single sensors and pairs in small rings, checked against a judge that compares all firings of five periods
//! on one time line.

use eeruf_core::{
    EachSensor, Layout, Micros, Requirements, Schedule, Uneven, VerifiedSchedule,
    conditions::{RequirementsError, Verification, ViolationKind},
    schedule,
    tables::TABLE_I_D,
};

use crate::common::random::Random;

/// A small ring with every kind of uneven need.
struct Ring {
    t_delta: Vec<Micros>,
    window: Vec<Micros>,
    refire: Vec<Micros>,
    intervals: Vec<(u8, u8, Micros)>,
    shared_lines: Vec<u64>,
    together: Vec<u64>,
}

impl Ring {
    fn random(random: &mut Random, sensors: usize) -> Self {
        let mut each = |most: u32| (0..sensors).map(|_| Micros::new(random.up_to(most))).collect();
        let (t_delta, window, refire) = (each(2), each(9), each(12));
        let pair = |random: &mut Random| {
            let x = random.up_to(sensors as u32 - 2) as u8;
            (x, x + 1 + random.up_to(sensors as u32 - 2 - u32::from(x)) as u8)
        };
        let set = |(x, y): (u8, u8)| 1_u64 << x | 1 << y;
        let (one, other) = (pair(random), pair(random));
        let mut intervals = vec![(one.1, one.0, Micros::new(random.up_to(4)))];
        if one != other {
            intervals.push((other.0, other.1, Micros::new(random.up_to(4))));
        }
        let (shared_lines, together) = (vec![set(pair(random))], vec![set(pair(random))]);
        Self { t_delta, window, refire, intervals, shared_lines, together }
    }

    fn uneven(&self) -> Uneven<'_> {
        let Self { t_delta, window, refire, intervals, shared_lines, together } = self;
        Uneven { t_delta, window, refire, intervals, shared_lines, together }
    }

    fn pairs(sets: &[u64], x: usize, y: usize) -> bool {
        sets.iter().any(|set| set >> x & 1 == 1 && set >> y & 1 == 1)
    }

    /// The kinds of violation, with the sensors concerned, lower first.
    fn violated(&self, schedule: &Schedule<4>, min_interval: i64, neighbours: usize) -> Vec<(ViolationKind, u8, u8)> {
        let period = i64::from(schedule.period().as_micros());
        let fires = |phase: usize, x: usize| {
            let phase = if phase == 0 { eeruf_core::Phase::A } else { eeruf_core::Phase::B };
            i64::from(schedule.t_fire(phase, x).unwrap().as_micros())
        };
        let line = |x: usize| (0..5).map(|n| n as i64 * period + fires(n % 2, x)).collect::<Vec<_>>();
        let d = |x: usize| fires(0, x) - fires(1, x);
        let us = |time: Micros| i64::from(time.as_micros());
        let mut found = Vec::new();
        for x in 0..schedule.sensors() {
            if line(x).windows(2).any(|two| two[1] - two[0] < us(self.window[x])) {
                found.push((ViolationKind::Window, x as u8, x as u8));
            }
            if line(x).windows(2).any(|two| two[1] - two[0] < us(self.refire[x])) {
                found.push((ViolationKind::Refire, x as u8, x as u8));
            }
            for y in x + 1..schedule.sensors() {
                let mut add = |kind, is_violated: bool| {
                    if is_violated {
                        found.push((kind, x as u8, y as u8));
                    }
                };
                let together = Self::pairs(&self.together, x, y);
                let apart = 2 * us(self.t_delta[x].max(self.t_delta[y]));
                add(ViolationKind::CrosstalkA, !together && (d(x) - d(y)).abs() <= apart);
                add(ViolationKind::CrosstalkB, !together && (d(x) + d(y)).abs() <= apart);
                let named = self.intervals.iter().find(|&&(p, q, _)| {
                    (usize::from(p), usize::from(q)) == (x, y) || (usize::from(q), usize::from(p)) == (x, y)
                });
                let near = if y - x < neighbours { min_interval } else { 0 };
                let interval = named.map_or(near, |&(_, _, interval)| us(interval));
                let closest = |first: usize, second: usize| {
                    let (first, second) = (line(first), line(second));
                    let gaps = first.iter().flat_map(|p| second.iter().map(move |q| q - p));
                    gaps.filter(|gap| *gap >= 0).min().unwrap()
                };
                add(ViolationKind::Interval, closest(x, y).min(closest(y, x)) < interval);
                let listening = closest(x, y) < us(self.window[x]) || closest(y, x) < us(self.window[y]);
                add(ViolationKind::SharedLine, Self::pairs(&self.shared_lines, x, y) && listening);
                add(ViolationKind::Together, together && line(x) != line(y));
            }
        }
        found
    }
}

fn kinds(report: &Verification<'_, 4>) -> Vec<(ViolationKind, u8, u8)> {
    let lower_first = |(x, y): (u8, u8)| (x.min(y), x.max(y));
    let mut found: Vec<_> = report
        .violations()
        .map(|violation| {
            let (x, y) = lower_first(violation.sensors);
            (violation.kind, x, y)
        })
        .collect();
    found.sort_by_key(|&(kind, x, y)| (x, y, kind.as_str()));
    found.dedup();
    found
}

// The violations of an uneven ring are exactly those that firings on a time line show.
#[test]
fn uneven_violations_are_those_of_a_time_line() {
    let mut random = Random(7);
    let (mut sound, mut seen) = (0, std::collections::BTreeMap::new());
    for _ in 0..20_000 {
        let sensors = 2 + random.up_to(2) as usize;
        let ring = Ring::random(&mut random, sensors);
        let period = 8 + random.up_to(30);
        // Sometimes let sensors fire together, which random times would hardly ever do.
        let mut times: [Vec<Micros>; 2] =
            [0, 1].map(|_| (0..sensors).map(|_| Micros::new(random.up_to(period - 1))).collect());
        if random.up_to(1) == 0 {
            let (x, y) = (ring.together[0].trailing_zeros() as usize, 63 - ring.together[0].leading_zeros() as usize);
            times.iter_mut().for_each(|times| times[y] = times[x]);
        }
        let lags = vec![Micros::ZERO; sensors];
        let schedule =
            Schedule::<4>::from_slices(Micros::new(period), &lags, [&times[0], &times[1]]).expect("it lies within");
        let (min_interval, neighbours) = (random.up_to(3), 1 + random.up_to(3) as u8);
        let uneven = ring.uneven();
        assert_eq!(uneven.check(sensors), Ok(()));
        let requirements = Requirements {
            min_interval: Micros::new(min_interval),
            layout: Layout::Line(neighbours),
            uneven: Some(uneven),
            ..Requirements::new(Micros::new(99))
        };
        let mut expected = ring.violated(&schedule, min_interval.into(), neighbours.into());
        expected.sort_by_key(|&(kind, x, y)| (x, y, kind.as_str()));
        let report = schedule.verify(&requirements);
        assert_eq!(kinds(&report), expected, "{requirements:?} {schedule:?}");
        assert_eq!(report.ok(), expected.is_empty());
        sound += u32::from(expected.is_empty());
        for (kind, ..) in expected {
            *seen.entry(kind.as_str()).or_insert(0) += 1;
        }
    }
    assert!(sound > 50 && seen.len() == 7 && seen.values().all(|&times| times > 500), "{sound} {seen:?}");
}

#[test]
fn what_is_violated_is_named_in_words() {
    let ms = |ms: [u32; 3]| ms.map(Micros::from_millis);
    let schedule = Schedule::from_firing(Micros::from_millis(40), [ms([0, 10, 21]), ms([0, 12, 20])]).unwrap();
    let uneven = Uneven { shared_lines: &[0b011], together: &[0b110], ..Uneven::NONE };
    let requirements = Requirements {
        window: Micros::from_millis(11),
        layout: Layout::Line(1),
        uneven: Some(uneven),
        ..Requirements::new(Micros::new(499))
    };
    let said: Vec<String> = schedule.verify(&requirements).violations().map(|found| found.to_string()).collect();
    assert_eq!(
        said,
        [
            "sensor 2 fires 10 ms after sensor 1 fired in phase a; on the echo line that they share sensor 1 listens \
             for 11 ms (T_wind)",
            "sensors 2 and 3 fire 11 ms apart in phase a; they must fire together",
            "sensors 2 and 3 fire 8 ms apart in phase b; they must fire together",
        ]
    );
}

#[test]
fn what_makes_no_sense_for_a_ring_is_refused_by_what_it_is() {
    let two = [Micros::ZERO; 2];
    for (uneven, expected) in [
        (Uneven { window: &two, ..Uneven::NONE }, "window: 2 values; expected one for each of 3 sensors"),
        (Uneven { t_delta: &two, ..Uneven::NONE }, "t_delta: 2 values; expected one for each of 3 sensors"),
        (
            Uneven { intervals: &[(0, 3, Micros::ZERO)], ..Uneven::NONE },
            "intervals: sensors 1 and 4; expected two different ones of 3",
        ),
        (
            Uneven { intervals: &[(0, 1, Micros::ZERO), (1, 0, Micros::ZERO)], ..Uneven::NONE },
            "intervals: sensors 2 and 1 twice; expected each pair once",
        ),
        (
            Uneven { shared_lines: &[0b1001], ..Uneven::NONE },
            "shared_lines: sensors 1 4; expected two or more different ones of 3",
        ),
        (Uneven { together: &[0b1], ..Uneven::NONE }, "together: sensors 1; expected two or more different ones of 3"),
        (Uneven { together: &[0b11, 0b110], ..Uneven::NONE }, "together: sensor 2 is in two groups; expected one"),
    ] {
        assert_eq!(uneven.check(3).map_err(|error| error.to_string()), Err(expected.to_owned()));
    }
    assert_eq!(Uneven { shared_lines: &[u64::MAX], ..Uneven::NONE }.check(64), Ok(()));
    let too_few = Uneven { shared_lines: &[u64::MAX], ..Uneven::NONE }.check(63);
    assert!(matches!(too_few, Err(RequirementsError::Set { sensors: 63, .. })));
}

// A verified schedule allows each sensor its own limits, and all of them the strictest.
#[test]
fn verified_uneven_schedule_allows_each_its_own() {
    const CORNERS: VerifiedSchedule<3, 2, EachSensor<3>> = schedule! {
        period_us: 60_000,
        t_fire_a_us: [0, 25_000, 25_000],
        t_fire_b_us: [0, 29_000, 29_000],
        each_meets: Requirements {
            min_interval: Micros::from_millis(15),
            layout: Layout::Line(2),
            uneven: Some(Uneven {
                t_delta: &[Micros::new(499), Micros::new(1_900), Micros::new(999)],
                window: &[Micros::from_millis(24), Micros::from_millis(12), Micros::from_millis(40)],
                refire: &[],
                intervals: &[(1, 2, Micros::ZERO)],
                shared_lines: &[0b011],
                together: &[0b110],
            }),
            ..Requirements::new(Micros::new(999))
        },
    };
    let of = |sensor| CORNERS.limits_of(sensor).map(|limits| (limits.t_delta, limits.window));
    assert_eq!(of(1), Some((Micros::new(1_900), Micros::from_millis(12))));
    assert_eq!((of(2), of(3)), (Some((Micros::new(999), Micros::from_millis(40))), None));
    let least = CORNERS.verified_for();
    assert_eq!((least.t_delta, least.window), (Micros::new(499), Micros::from_millis(12)));
    // The longest time that any pair or sensor keeps: the third listens for 40 ms before it fires again.
    assert_eq!((least.min_interval, least.separation), (Micros::from_millis(40), Micros::from_millis(4)));
    let late = Requirements {
        layout: Layout::Line(1),
        uneven: Some(Uneven { shared_lines: &[0b011], ..Uneven::NONE }),
        window: Micros::from_millis(26),
        ..Requirements::new(Micros::new(499))
    };
    assert_eq!(CORNERS.verified(&late).unwrap_err().kind, ViolationKind::CrosstalkA);
}

#[test]
fn needs_that_make_no_sense_are_named_with_what_is_expected() {
    let one = Micros::new(1);
    let error = |uneven: Uneven<'_>| uneven.check(4).unwrap_err().to_string();
    let none = Uneven::NONE;
    let few = "2 values; expected one for each of 4 sensors";
    assert_eq!(error(Uneven { t_delta: &[one; 2], ..none }), format!("t_delta: {few}"));
    assert_eq!(error(Uneven { window: &[one; 2], ..none }), format!("window: {few}"));
    assert_eq!(error(Uneven { refire: &[one; 2], ..none }), format!("refire: {few}"));
    let intervals = |intervals: &[(u8, u8, Micros)]| error(Uneven { intervals, ..none });
    assert_eq!(intervals(&[(1, 1, one)]), "intervals: sensors 2 and 2; expected two different ones of 4");
    assert_eq!(intervals(&[(0, 4, one)]), "intervals: sensors 1 and 5; expected two different ones of 4");
    assert_eq!(intervals(&[(4, 0, one)]), "intervals: sensors 5 and 1; expected two different ones of 4");
    assert_eq!(intervals(&[(0, 1, one), (0, 1, one)]), "intervals: sensors 1 and 2 twice; expected each pair once");
    assert_eq!(intervals(&[(0, 1, one), (1, 0, one)]), "intervals: sensors 2 and 1 twice; expected each pair once");
    let lines = |shared_lines: &[u64]| error(Uneven { shared_lines, ..none });
    assert_eq!(lines(&[0b1_0001]), "shared_lines: sensors 1 5; expected two or more different ones of 4");
    assert_eq!(lines(&[0b0011, 0b0100]), "shared_lines: sensors 3; expected two or more different ones of 4");
    let together = |together: &[u64]| error(Uneven { together, ..none });
    assert_eq!(together(&[0b1000]), "together: sensors 4; expected two or more different ones of 4");
    assert_eq!(together(&[0b0011, 0b1100, 0b0110]), "together: sensor 2 is in two groups; expected one");
    // A sensor may share lines with several, and its neighbour's number.
    let (intervals, each) = ([(0, 3, one), (1, 3, one), (0, 1, one)], [one; 4]);
    let lines = Uneven { shared_lines: &[0b0110, 0b1100], together: &[0b0011, 0b1100], ..none };
    assert_eq!(Uneven { intervals: &intervals, t_delta: &each, ..lines }.check(4), Ok(()));
    assert_eq!(Uneven { together: &[1 << 63 | 1], ..none }.check(64), Ok(()));
}

#[test]
fn separation_and_interval_count_the_pairs_that_need_them() {
    let even = Requirements { min_interval: Micros::from_millis(17), ..Requirements::new(Micros::new(999)) };
    let found = |requirements: &Requirements<'_>| {
        let verification = TABLE_I_D.verify(requirements);
        let (separation, interval) = (verification.separation(), verification.min_interval());
        (separation.map(|least| least.value), interval.map(|least| least.value))
    };
    let with = |uneven| Requirements { uneven: Some(uneven), ..even };
    assert_eq!(found(&with(Uneven::NONE)), found(&even));
    // Two alone that need an interval: in the second phase they fire after 18 ms and after 50 + 8.
    let two = Uneven { intervals: &[(0, 6, Micros::from_millis(1))], ..Uneven::NONE };
    let apart = Requirements { layout: Layout::Line(1), ..with(two) };
    assert_eq!(found(&apart).1, Some(Micros::from_millis(40)));
    assert_eq!(TABLE_I_D.verify(&apart).min_interval().unwrap().sensors, (0, 6));
    // All that must fire together need no separation.
    assert_eq!(found(&with(Uneven { together: &[0xfff], ..Uneven::NONE })).0, None);
    let closest = TABLE_I_D.verify(&even).separation().unwrap();
    let pair = [1 << closest.sensors.0 | 1 << closest.sensors.1];
    let others = with(Uneven { together: &pair, ..Uneven::NONE });
    assert_ne!(TABLE_I_D.verify(&others).separation().unwrap().sensors, closest.sensors);
}

#[test]
fn sensors_that_no_ring_has_share_nothing() {
    let everywhere = [u64::MAX];
    let uneven = Uneven { shared_lines: &everywhere, together: &everywhere, ..Uneven::NONE };
    let requirements = Requirements { uneven: Some(uneven), ..Requirements::new(Micros::new(999)) };
    assert!(requirements.share_a_line(0, 63) && requirements.fire_together(63, 0));
    for (x, y) in [(0, 64), (64, 0), (64, 64)] {
        assert!(!requirements.share_a_line(x, y) && !requirements.fire_together(x, y), "{x} {y}");
    }
}
