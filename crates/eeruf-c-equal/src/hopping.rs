//! Rings that hop in time.

use crate::tracking::{self, status_of};
use crate::{C, Do, Random};
use eeruf_core::{
    Instant, Micros,
    hopping::{HoppingCode, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings},
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
    let lags: Option<[Micros; K]> = r.once_in(2).then(|| [(); K].map(|()| Micros::new(r.within(0, period / 2))));
    // Mostly the ordinary code, else any, and the one whose period may be shortest.
    let any_code = HoppingCode::of(K, phases, r.one_of(&[0, r.within(0, 70) as u8]), Micros::new(step));
    let shortest = HoppingCode::shortest(K, phases, Micros::new(step));
    let (phases, code, rust) = match (r.within(0, 3), &any_code, &shortest) {
        (0, Ok(code), _) | (1, _, Ok(code)) => (code.phases(), 1 + code.first_multiplier(), Ok(*code)),
        _ => (phases, 0, HoppingCode::new(K, phases, Micros::new(step))),
    };
    numbers.push(code.into());
    numbers.extend(lags.iter().flatten().map(|lag| lag.as_micros()));
    let status = c.hopping(K as u8, phases, &numbers, start);
    let rust = rust.and_then(|code| {
        let schedule = match lags {
            Some(lags) => HoppingSchedule::<K>::new(code, Micros::new(period), lags)?,
            None => HoppingSchedule::spread(code, Micros::new(period))?,
        };
        HoppingRing::<K>::hopping(&schedule, s, listening, random_seed, Instant::from_micros(start))
    });
    let ring = match rust {
        Ok(ring) => ring,
        Err(error) => {
            assert_eq!(status, status_of(&error), "{r}: {error}");
            return 0;
        }
    };
    assert_eq!(status, 0, "{r}");
    let weighed = |ring: &HoppingRing<K>, sensor| ring.plan().weighed(sensor, 0);
    tracking::run(r, c, ring, window, start, weighed, |c, ring, at| {
        for sensor in 0..K as u8 {
            assert_eq!(Some(Micros::new(c.lag_us(sensor))), ring.plan().t_lag(sensor.into()), "{at}");
        }
        assert_eq!(c.call(Do::Solo, 0, 0) & 255, ring.plan().solo().map_or(255, i32::from), "{at}");
    })
}
