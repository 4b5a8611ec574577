//! Flow rings.

use crate::hopping::numbers_of;
use crate::tracking::{self, status_of};
use crate::{C, Random};
use eeruf_core::{
    EachSensor, Instant, Micros, Requirements, Uneven,
    flow::{FlowRing, FlowSettings},
    hopping::{HoppingError, HoppingListening},
    plan::OwnLimits,
};

fn settings(r: &Random) -> FlowSettings {
    let mut settings = FlowSettings::DEFAULT;
    if r.once_in(2) {
        settings.tracker = tracking::settings(r);
        settings.unserved_after = r.within(0, 9) as u8;
        for time in [&mut settings.shortest_gap, &mut settings.masked_adds, &mut settings.unserved_adds] {
            *time = Micros::new(r.one_of(&[r.duration(100_000), r.within(0, 20_000)]));
        }
        settings.believed_takes = Micros::new(r.duration(20_000));
        settings.travel = Micros::new(r.one_of(&[0, 260, r.duration(100_000)]));
    }
    if r.once_in(2) {
        settings.step = Micros::new(r.one_of(&[240, r.duration(900), r.duration(70_000)]));
        settings.shortest_cycle = Micros::new(r.one_of(&[60_000, r.within(0, 200_000), r.duration(1 << 29)]));
        settings.rest = Micros::new(r.one_of(&[0, 60_000, r.duration(1 << 25)]));
        settings.lead = Micros::new(r.one_of(&[0, 3_000, r.duration(100_000)]));
        settings.longest_cycle = Micros::new(r.one_of(&[400_000, r.within(0, 900_000), r.duration(u32::MAX)]));
    }
    settings
}

/// Limits of each sensor, and the same as numbers for C. Some fire together: two sets at most.
fn own_limits<const K: usize>(r: &Random, settings: &FlowSettings, window: u32) -> (EachSensor<K>, Vec<u32>) {
    let t_deltas = [(); K].map(|()| Micros::new(r.within(1, settings.tracker.t_delta.as_micros())));
    let windows = [(); K].map(|()| Micros::new(r.one_of(&[window, window, r.within(1, window)])));
    let mut together = vec![0, 0, 0];
    for sensor in 0..K {
        together[r.one_of(&[0, 0, 1, 2])] |= 1 << sensor;
    }
    let together: Vec<u64> = together.into_iter().skip(1).filter(|set: &u64| set.count_ones() > 1).collect();
    let uneven = Uneven { t_delta: &t_deltas, window: &windows, together: &together, ..Uneven::NONE };
    let requirements = Requirements {
        window: Micros::new(window),
        uneven: Some(uneven),
        ..Requirements::new(settings.tracker.t_delta)
    };
    let limits = FlowSettings::limits(K, &requirements).expect("one value for each sensor, and sets that are apart");
    (limits, numbers_of(0, &windows, &t_deltas, &together))
}

/// One flow ring for up to 4,000 steps, or until there are no numbers left; the number of its events.
///
/// # Panics
/// Where C and Rust differ.
pub fn run<const K: usize>(r: &Random) -> u64 {
    let mut c = C::new();
    let s = settings(r);
    let longest = HoppingListening::MAX_WINDOW.as_micros();
    let window = r.one_of(&[36_000, 36_000, 30_000, r.within(1, 40_000), r.within(longest - 2_000, longest + 200)]);
    let blanking = r.one_of(&[0, 500, 2_380, r.duration(4_000)]);
    let listening = HoppingListening::new(Micros::new(window))
        .with_blanking(Micros::new(blanking))
        .with_reach(Micros::new(r.one_of(&[window, r.duration(100_000)])));
    // Also where the clock begins, at which sensors would seem to have just fired.
    let start = r.one_of(&[r.any() as u32, r.duration(50_000)]);
    let mut numbers = vec![window, blanking, listening.reach.as_micros(), s.unserved_after.into()];
    let gaps = [s.shortest_gap, s.masked_adds, s.believed_takes, s.unserved_adds];
    numbers.extend([s.step].into_iter().chain(gaps).map(Micros::as_micros));
    numbers.extend([s.shortest_cycle, s.longest_cycle, s.rest, s.lead, s.travel].map(Micros::as_micros));
    numbers.extend(tracking::numbers(&s.tracker));
    let now = Instant::from_micros(start);
    if r.once_in(2) {
        let (limits, own) = own_limits::<K>(r, &s, window);
        let status = c.flow(K as u8, &numbers, &own, start);
        return compare(
            r,
            c,
            status,
            FlowRing::<K, 4, 1, _>::with_limits(K, limits, s, listening, now),
            (window, start),
        );
    }
    let status = c.flow(K as u8, &numbers, &[], start);
    compare::<K, ()>(r, c, status, FlowRing::flow(K, s, listening, now), (window, start))
}

/// Runs both, if they are made.
fn compare<const K: usize, U: OwnLimits>(
    r: &Random,
    c: C,
    status: i32,
    ring: Result<FlowRing<K, 4, 1, U>, HoppingError>,
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
    let weighed = |ring: &FlowRing<K, 4, 1, U>, sensor| ring.plan().weighed(sensor, 0);
    tracking::run(r, c, ring, window, start, weighed, |c, ring, _, at| {
        for sensor in 0..=K as u8 {
            let quiet = ring.plan().quiet(sensor).map(|(before, after)| [before, after].map(Micros::as_micros));
            assert_eq!(c.quiet_us(sensor), quiet, "{at}");
        }
    })
}
