//! Rings that hop in time.

use crate::tracking::{self, status_of};
use crate::{C, Do, Random};
use eeruf_core::{
    Criterion, EachSensor, Instant, Layout, Micros, Requirements, Uneven,
    adaptation::Adaptation,
    hopping::{HoppingCode, HoppingError, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings},
    plan::OwnLimits,
};

fn settings(r: &Random) -> HoppingSettings {
    let mut settings =
        r.one_of(&[HoppingSettings::BALANCED, HoppingSettings::QUICK, HoppingSettings::DRIVING, HoppingSettings::MAPS]);
    if r.once_in(2) {
        settings.tracker = tracking::settings(r);
        settings.solo_rate = r.one_of(&[0, 255, r.within(0, 255) as u8]);
        settings.solo_after = r.within(0, 9) as u8;
        settings.solo_spacing = r.within(0, 5) as u8;
        settings.shift_after = r.within(0, 6) as u8;
        settings.shift_spacing = r.within(0, 9) as u8;
        settings.shift_interval = Micros::new(r.one_of(&[0, 2_000, 8_000]));
        settings.neighbours = r.within(0, 5) as u8;
    }
    settings
}

/// Limits of each sensor, and the same as numbers for C; `None` where the schedule does not keep those that were drawn.
fn own_limits<const K: usize>(
    r: &Random,
    schedule: &HoppingSchedule<K>,
    (t_delta, window): (Micros, u32),
    together: &[u64],
) -> Option<(EachSensor<K>, Vec<u32>)> {
    let t_deltas = [(); K].map(|()| Micros::new(r.within(1, t_delta.as_micros())));
    let windows = [(); K].map(|()| Micros::new(r.one_of(&[window, r.within(1, window)])));
    let requirements = Requirements {
        criterion: Criterion::Margin(Micros::ZERO),
        layout: Layout::Line(1),
        window: Micros::new(window),
        uneven: Some(Uneven { t_delta: &t_deltas, window: &windows, together, ..Uneven::NONE }),
        ..Requirements::new(t_delta)
    };
    let limits = schedule.limits(&requirements).ok()?;
    // What a pair keeps is the longest window.
    let interval = windows.iter().max().map_or(0, |window| window.as_micros());
    Some((limits, numbers_of(interval, &windows, &t_deltas, together)))
}

/// Limits as numbers for C: what a pair keeps, then window, `t_delta` and group of each sensor.
pub(crate) fn numbers_of(interval_us: u32, windows: &[Micros], t_deltas: &[Micros], together: &[u64]) -> Vec<u32> {
    let mut numbers = vec![interval_us];
    for (sensor, (window, t_delta)) in windows.iter().zip(t_deltas).enumerate() {
        let group = together.iter().position(|set| set >> sensor & 1 == 1).map_or(0, |group| group as u32 + 1);
        numbers.extend([window.as_micros(), t_delta.as_micros(), group]);
    }
    numbers
}

/// The schedules that a ring changes to: the one that it began with, and up to three others, now and then of another
/// code, or with too short a period.
fn rungs<const K: usize>(r: &Random, c: &mut C, first: HoppingSchedule<K>, code: u8) -> Vec<HoppingSchedule<K>> {
    let mut rungs = vec![first];
    let mut period = first.period().as_micros();
    for _ in 0..r.within(0, 3) {
        period = r.one_of(&[period.saturating_add(r.duration(60_000)), r.within(period / 2, period)]);
        let (of, other) = (first.code(), HoppingCode::new(K, r.within(2, 20) as u8, first.code().step()));
        let (of, number) = match other {
            Ok(other) if r.once_in(8) => (other, 0),
            _ => (*of, code),
        };
        let lags: Option<[Micros; K]> = r.once_in(2).then(|| [(); K].map(|()| Micros::new(r.within(0, period / 2))));
        let schedule = match lags {
            Some(lags) => HoppingSchedule::<K>::new(of, Micros::new(period), lags),
            None => HoppingSchedule::spread(of, Micros::new(period)),
        };
        let Ok(schedule) = schedule else { continue };
        let lags: Vec<u32> = lags.iter().flatten().map(|lag| lag.as_micros()).collect();
        c.hopping_rung(of.phases(), number, of.step().as_micros(), period, &lags);
        rungs.push(schedule);
    }
    rungs
}

/// One hopping ring for up to 4,000 steps, or until there are no numbers left; how many events it had.
///
/// # Panics
/// Where C and Rust differ.
pub fn run<const K: usize>(r: &Random) -> u64 {
    let mut c = C::new();
    let s = settings(r);
    let (phases, step) = (r.one_of(&[2, 2, 2, 8, 16, r.within(0, 70) as u8]), r.one_of(&[240, 240, r.duration(900)]));
    let period = r.one_of(&[60_000, r.within(20_000, 120_000), r.duration(1 << 28)]);
    let longest = HoppingListening::MAX_WINDOW.as_micros();
    let window = r.one_of(&[36_000, 36_000, 30_000, r.within(1, 40_000), r.within(longest - 2_000, longest + 200)]);
    let blanking = r.one_of(&[0, 500, r.duration(4_000)]);
    let listening = HoppingListening::new(Micros::new(window))
        .with_blanking(Micros::new(blanking))
        .with_reach(Micros::new(r.one_of(&[window, r.duration(100_000)])));
    // Also where the clock begins, at which sensors would seem to have just fired.
    let (random_seed, start) = (r.within(0, 3), r.one_of(&[r.any() as u32, r.duration(50_000)]));
    let t = s.tracker;
    let mut numbers = vec![step, period, window, blanking, listening.reach.as_micros()];
    numbers.extend([s.shift_interval.as_micros(), random_seed]);
    numbers.extend(tracking::numbers(&t));
    numbers.extend(
        [s.solo_rate, s.solo_after, s.solo_spacing, s.shift_after, s.shift_spacing, s.neighbours].map(u32::from),
    );
    let mut lags: Option<[Micros; K]> = r.once_in(2).then(|| [(); K].map(|()| Micros::new(r.within(0, period / 2))));
    // Mostly the ordinary code, else any, and the one whose period may be shortest.
    let any_code = HoppingCode::of(K, phases, r.one_of(&[0, r.within(0, 70) as u8]), Micros::new(step));
    let shortest = HoppingCode::shortest(K, phases, Micros::new(step));
    let (phases, code, rust) = match (r.within(0, 3), &any_code, &shortest) {
        (0, Ok(code), _) | (1, _, Ok(code)) => (code.phases(), 1 + code.first_multiplier(), Ok(*code)),
        _ => (phases, 0, HoppingCode::new(K, phases, Micros::new(step))),
    };
    // Some sensors fire together.
    let mut together = vec![];
    if let (Some(lags), true) = (&mut lags, K > 2 && r.once_in(2)) {
        let (x, y) = (r.within(0, K as u32 / 2 - 1) as usize, r.within(K as u32 / 2, K as u32 - 1) as usize);
        lags[y] = lags[x];
        together.push(1 << x | 1 << y);
    }
    numbers.push(code.into());
    numbers.extend(lags.iter().flatten().map(|lag| lag.as_micros()));
    let schedule = rust.and_then(|code| match lags {
        Some(lags) => HoppingSchedule::<K>::new(code, Micros::new(period), lags),
        None => HoppingSchedule::spread(code, Micros::new(period)),
    });
    let limits = schedule.as_ref().ok().filter(|_| r.once_in(2));
    let limits = limits.and_then(|schedule| own_limits(r, schedule, (t.t_delta, window), &together));
    let own = limits.as_ref().map_or(&[][..], |(_, numbers)| numbers);
    let status = c.hopping(K as u8, phases, &numbers, own, start);
    let now = Instant::from_micros(start);
    let rungs = schedule.as_ref().map_or(vec![], |&schedule| rungs(r, &mut c, schedule, code));
    match limits {
        Some((limits, _)) => {
            let ring = schedule
                .and_then(|it| HoppingRing::<K, 4, 1, _>::with_limits(&it, limits, s, listening, random_seed, now));
            compare(r, c, status, ring, &rungs, (window, start))
        }
        None => {
            let ring = schedule.and_then(|it| HoppingRing::<K>::hopping(&it, s, listening, random_seed, now));
            compare::<K, ()>(r, c, status, ring, &rungs, (window, start))
        }
    }
}

/// Runs both, if they are made.
fn compare<const K: usize, U: OwnLimits>(
    r: &Random,
    mut c: C,
    status: i32,
    ring: Result<HoppingRing<K, 4, 1, U>, HoppingError>,
    rungs: &[HoppingSchedule<K>],
    (window, start): (u32, u32),
) -> u64 {
    let ring = match ring {
        Ok(ring) => ring,
        Err(error) => {
            assert_eq!(status, status_of(&error), "{r}: {error}");
            return 0;
        }
    };
    assert_eq!(status, 0, "{r}");
    let weighed = |ring: &HoppingRing<K, 4, 1, U>, sensor| ring.plan().weighed(sensor, 0);
    let mut adaptation = adaptation(r, &mut c, rungs);
    tracking::run(r, c, ring, window, start, weighed, |c, ring, stats, at| {
        let Some(stats) = stats else {
            let number = r.within(0, rungs.len() as u32 - 1);
            let changed = ring.change_hopping(&rungs[number as usize]);
            assert_eq!(c.call(Do::ChangeHopping, 0, number), changed.map_or_else(|error| status_of(&error), |()| 0));
            return;
        };
        if let Some(adaptation) = &mut adaptation {
            let changed = adaptation.adapt(stats, |schedule| ring.change_hopping(schedule));
            let expected = changed.map_or_else(|error| status_of(&error), i32::from);
            assert_eq!(c.call(Do::Adapt, 0, 0), expected, "{at}");
            let permille = adaptation.rejection_permille().unwrap_or(u16::MAX);
            assert_eq!(c.rung(), (adaptation.rung() as u32, permille.into()), "{at}");
        }
        for sensor in 0..K as u8 {
            assert_eq!(Some(Micros::new(c.lag_us(sensor))), ring.plan().t_lag(sensor.into()), "{at}");
        }
        assert_eq!(c.call(Do::Solo, 0, 0) & 255, ring.plan().solo().map_or(255, i32::from), "{at}");
    })
}

/// The same ladder in both, if it is one.
fn adaptation<'s, const K: usize>(
    r: &Random,
    c: &mut C,
    rungs: &'s [HoppingSchedule<K>],
) -> Option<Adaptation<'s, HoppingSchedule<K>>> {
    let (window, patience) = (r.within(0, 6) as u8, r.within(0, 3) as u8);
    let (noisy, calm) = (r.within(0, 500) as u16, r.within(0, 500) as u16);
    let status = c.adaptation(window, patience, noisy, calm);
    let adaptation = Adaptation::hopping(rungs);
    assert_eq!(status, if adaptation.is_ok() { 0 } else { -22 }, "{r}");
    let mut adaptation = adaptation.ok()?;
    (adaptation.window, adaptation.patience) = (window, patience);
    (adaptation.noisy_permille, adaptation.calm_permille) = (noisy, calm);
    Some(adaptation)
}
