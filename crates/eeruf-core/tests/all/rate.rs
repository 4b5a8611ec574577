//! The filter with a rate against the plainest worlds there are: one wall, and one path from another sensor, that come
//! nearer or go away.

use eeruf_core::tables::{PAPER_12, TABLE_I_D};
use eeruf_core::{
    Instant, Layout, Micros, Phase, ReadingKind, Requirements, Ring, RingConfig, RingEvent, Schedule,
    judge::{Agreement, Judge, RateFilter},
    plan::ScheduledFiring,
};

use crate::common::random::Random;

const SENSORS: usize = 6;
/// Two phases.
type Firing = [[i64; SENSORS]; 2];

/// A schedule of random lags whose shifts are further than twice `t_delta` apart, in random order and of random sign,
/// as the verifier confirms for this window.
fn draw(random: &mut Random, t_delta: u32, period: u32, window: u32) -> Firing {
    let separation = 2 * t_delta + 1;
    let mut shifts = [(); SENSORS].map(|()| 0);
    let mut shift = random.up_to(separation);
    for place in &mut shifts {
        *place = shift;
        shift += separation + random.up_to(200);
    }
    for place in (1..SENSORS).rev() {
        shifts.swap(place, random.up_to(place as u32) as usize);
    }
    let fire = shifts.map(|shift| {
        let lag = random.up_to(period - 1 - shift);
        if random.up_to(1) == 0 { [lag + shift, lag] } else { [lag, lag + shift] }
    });
    let firing = [0, 1].map(|phase| fire.map(|fire| fire[phase]));
    let schedule = Schedule::<SENSORS>::from_firing(Micros::new(period), firing.map(|fire| fire.map(Micros::new)));
    let needs = Requirements {
        min_interval: Micros::ZERO,
        layout: Layout::Line(1),
        window: Micros::new(window),
        ..Requirements::new(Micros::new(t_delta))
    };
    schedule.unwrap().verified(&needs).unwrap();
    firing.map(|fire| fire.map(i64::from))
}

/// When a sensor fires in a period.
fn fires(firing: &Firing, sensor: usize, period: i64, number: i64) -> i64 {
    number * period + firing[(number % 2) as usize][sensor]
}

#[test]
fn one_path_that_grows_at_any_constant_rate_is_never_accepted() {
    let mut random = Random(1);
    let (mut heard, mut moved) = (0, 0);
    for _ in 0..3000 {
        let t_delta = 20 + random.up_to(500);
        let (period, window) = (60_000, 30_000);
        let firing = draw(&mut random, t_delta, period, window);
        let (x, y) = (random.up_to(SENSORS as u32 - 1) as usize, random.up_to(SENSORS as u32 - 1) as usize);
        if x == y {
            continue;
        }
        // Up to 3.4 m/s towards or from whatever reflects it; up to three periods old when it is heard.
        let rate = f64::from(random.up_to(40_000)) * 1e-6 - 0.02;
        let (length, period) = (f64::from(100_000 + random.up_to(80_000)), i64::from(period));
        let mut filter = RateFilter::<1>::new(Micros::new(t_delta), 40_000).unwrap();
        let arrivals: Vec<i64> = (0..60)
            .map(|number| fires(&firing, x, period, number))
            .map(|sent| sent + (length + rate * sent as f64).round() as i64)
            .collect();
        for number in 4..50 {
            let fired = fires(&firing, y, period, number);
            let echoes = arrivals.iter().map(|arrival| arrival - fired);
            let echo = echoes.filter(|echo| (0..=i64::from(window)).contains(echo)).min();
            let t_echo = echo.map(|echo| Micros::new(echo as u32));
            let verdict = filter.push(0, Instant::from_micros(fired as u32), t_echo).unwrap();
            assert_ne!(verdict.kind, ReadingKind::Accepted, "{firing:?}, {x} to {y}, {length} us, rate {rate}");
            heard += usize::from(echo.is_some());
            moved += usize::from(verdict.previous.is_some() && echo.is_some());
        }
    }
    assert!(heard > 30_000 && moved > 20_000, "{heard}, {moved}");
}

// A wall that comes nearer at any constant rate is accepted from the third reading on.
#[test]
fn wall_at_constant_rate_is_accepted_from_third_reading() {
    let mut random = Random(2);
    for table in 0..500 {
        let (firing, period) = if table == 0 {
            // Of Table I-d six sensors.
            let at = |phase, x| TABLE_I_D.t_fire(Phase(phase), x).map_or(0, |at| i64::from(at.as_micros()));
            ([0, 1].map(|phase| core::array::from_fn(|x| at(phase, x))), 100_000)
        } else {
            (draw(&mut random, 300, 60_000, 30_000), 60_000)
        };
        let rate = f64::from(random.up_to(40_000)) * 1e-6 - 0.02;
        // Whole microseconds are off by half of one each.
        let mut filter = RateFilter::<SENSORS>::new(Micros::new(1), 20_000).unwrap();
        for number in 0..10 {
            for y in 0..SENSORS {
                let fired = fires(&firing, y, period, number);
                let echo = (25_000.0 + rate * fired as f64).round();
                let (at, t_echo) = (Instant::from_micros(fired as u32), Micros::new(echo as u32));
                let kind = filter.push(y as u8, at, Some(t_echo)).unwrap().kind;
                let expected = [ReadingKind::First, ReadingKind::Repeated];
                assert_eq!(
                    kind,
                    expected.get(number as usize).copied().unwrap_or(ReadingKind::Accepted),
                    "rate {rate}"
                );
            }
        }
    }
}

#[test]
fn of_random_readings_those_are_accepted_that_plain_numbers_say() {
    let mut random = Random(3);
    let (mut accepted, mut close) = (0, 0);
    for _ in 0..60_000 {
        let t_delta = random.up_to(800);
        let limit = random.up_to(20_000);
        let mut filter = RateFilter::<1>::new(Micros::new(t_delta), limit).unwrap();
        let (mut fired, mut readings) = (random.up_to(u32::MAX), vec![]);
        for _ in 0..3 {
            let echo = 10_000 + random.up_to(2_000);
            readings.push((f64::from(fired.wrapping_sub(1 << 31)), f64::from(echo)));
            let kind = filter.push(0, Instant::from_micros(fired), Some(Micros::new(echo))).unwrap().kind;
            if let [(f1, e1), (f2, e2), (f3, e3)] = readings[..] {
                if f3 < f1 {
                    // Through the wrap, which these numbers do not know.
                    continue;
                }
                let off = (e2 - (e1 + (e3 - e1) * (f2 - f1) / (f3 - f1))).abs() - f64::from(t_delta);
                let fast = (e3 - e1).abs() - f64::from(t_delta) - (1e-6 * f64::from(limit) * (f3 - f1)).floor();
                if off.abs() < 1e-6 {
                    close += 1;
                    continue;
                }
                assert_eq!(kind == ReadingKind::Accepted, off < 0.0 && fast <= 0.0, "{readings:?}, {t_delta}, {limit}");
                accepted += usize::from(kind == ReadingKind::Accepted);
            }
            fired = fired.wrapping_add(1 + random.up_to(150_000));
        }
    }
    assert!((3_000..50_000).contains(&accepted) && close < 1_000, "{accepted}, {close}");
}

#[test]
fn the_latest_echo_is_one_and_a_later_one_is_silence() {
    let mut filter = RateFilter::<1>::new(Micros::new(500), 5_000).unwrap();
    let latest = Micros::new((1 << 24) - 1);
    let mut push = |at, t_echo| filter.push(0, Instant::from_micros(at), Some(t_echo)).unwrap();
    let first = push(0, latest);
    assert_eq!((first.kind, first.previous, first.t_echo), (ReadingKind::First, None, Some(latest)));
    let later = push(60_000, Micros::new(1 << 24));
    assert_eq!((later.kind, later.previous, later.t_echo), (ReadingKind::NoEcho, Some(latest), None));
}

#[test]
fn the_age_of_what_was_once_accepted_stays_below_never() {
    let mut filter = RateFilter::<1>::new(Micros::new(500), 5_000).unwrap();
    let kinds = [0, 60_000, 120_000].map(|at| filter.push(0, Instant::from_micros(at), Some(Micros::new(9_000))));
    assert_eq!(kinds[2].unwrap().kind, ReadingKind::Accepted);
    let ages: Vec<_> = (0..70_000).map(|_| filter.push(0, Instant::from_micros(0), None).unwrap().age).collect();
    assert_eq!((ages[0], ages[65_000], ages[69_999]), (Some(1), Some(65_001), Some(65_534)));
}

/// A path of sound to sensor 7 that begins at `length` us, grows by `rate` us/s, and is longer or shorter by `wobble`
/// us in turn.
struct Path {
    emitter: u8,
    length: u32,
    rate: i64,
    wobble: i64,
}

/// The readings of sensor 7, and those of them accepted, in ten seconds of firings each up to `late` us late.
fn heard_of_one_path<J: Judge>(judge: J, late: u32, path: &Path, seed: u32) -> (u32, u32) {
    let config = RingConfig::new().with_window(Micros::from_millis(30)).with_audible(Micros::from_millis(100));
    let begin = Instant::from_micros(0);
    let plan = ScheduledFiring::verified(&PAPER_12, begin);
    let mut ring = Ring::<_, J, 12, 1, 5>::judged_by(plan, judge, config, begin).unwrap();
    let mut random = Random(u64::from(seed));
    let mut arrivals: Vec<Instant> = Vec::new();
    let (mut readings, mut accepted, mut sign) = (0, 0, 1);
    loop {
        let due = arrivals.iter().fold(ring.next_deadline(), |due, &at| if due.has_reached(at) { at } else { due });
        if due.has_reached(Instant::from_micros(10_000_000)) {
            return (readings, accepted);
        }
        let now = due + Micros::new(random.up_to(late));
        arrivals.retain(|&arrival| {
            let is_in = now.has_reached(arrival);
            if is_in {
                ring.echo(7, arrival).unwrap();
            }
            !is_in
        });
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } if sensor == path.emitter => {
                    let longer = path.rate * i64::from(now.as_micros()) / 1_000_000 + sign * path.wobble;
                    arrivals.push(now + Micros::new((i64::from(path.length) + longer) as u32));
                    sign = -sign;
                }
                RingEvent::Reading(reading) if reading.sensor == 7 => {
                    readings += 1;
                    accepted += u32::from(reading.kind == ReadingKind::Accepted);
                }
                _ => {}
            }
        }
    }
}

// A ring with a rate accepts no path of anyone else however late firings are, nor on time one that changes fast and is
// off its line by P.
#[test]
fn rate_ring_accepts_no_foreign_path() {
    let filter = || RateFilter::<12>::new(Micros::new(999), 20_000).unwrap();
    let (mut alone, mut readings) = (0, 0);
    let changes = [(-6_000, 498), (-6_000, -498), (6_000, 498), (0, 0), (-4_000, 249), (270, 0)];
    for seed in 0..330 {
        let emitter = [0, 1, 2, 3, 4, 5, 6, 8, 9, 10, 11][seed as usize % 11];
        let late = [0, 500, 1_000, 3_000, 10_000][seed as usize / 11 % 5];
        let (rate, wobble) = changes[seed as usize / 55];
        let path = Path { emitter, length: 20_000 + 40 * seed + if rate < 0 { 60_000 } else { 0 }, rate, wobble };
        let (heard, accepted) = heard_of_one_path(filter(), late, &path, seed);
        assert_eq!(accepted, 0, "{emitter} late by up to {late} us, {rate} us/s, {wobble} us off");
        readings += heard;
        alone += heard_of_one_path(Agreement(filter()), late, &path, seed).1;
    }
    assert!(readings > 20_000 && alone > 20, "{readings} readings, {alone} accepted by agreement alone");
}

#[test]
fn a_ring_with_a_rate_accepts_a_wall_that_comes_nearer() {
    let filter = RateFilter::<12>::new(Micros::new(400), 20_000).unwrap();
    // At half a metre a second its echo comes 2.9 ms sooner each second.
    let wall = Path { emitter: 7, length: 28_000, rate: -2_900, wobble: 0 };
    let (readings, accepted) = heard_of_one_path(filter, 0, &wall, 1);
    assert!(readings > 80 && accepted > readings * 9 / 10, "{accepted} of {readings}");
}
