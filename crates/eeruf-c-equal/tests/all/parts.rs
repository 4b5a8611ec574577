//! The parts that can be used alone: filter, distances, edges, adaptation.

use eeruf_c_equal::core_side::{echo, explanation};
use eeruf_c_equal::{C, Do, Edges, NO_ECHO, Needs, Random, distance_mm, echo_time_us, filter, sound_mm_s};
use eeruf_core::{
    EchoFilter, Edge, EdgeQueue, Instant, Micros, Requirements, Ring, RingConfig, RingEvent, Schedule, SpeedOfSound,
    adaptation::Adaptation,
};

#[test]
fn the_filter_alone_gives_the_same_verdicts() {
    let r = Random::new(1);
    for _ in 0..200 {
        let (t_delta, consecutive) = (r.duration(2_000), r.within(2, 8) as u8);
        let mut rust = EchoFilter::<1>::new(Micros::new(t_delta), consecutive).unwrap();
        let mut held = [NO_ECHO, u16::MAX.into(), 0];
        let near = r.duration(u32::MAX / 4);
        for _ in 0..200 {
            let t_echo = match r.within(0, 9) {
                0 => NO_ECHO,
                1 => r.duration(u32::MAX / 2),
                _ => near + r.duration(t_delta),
            };
            let change = r.one_of(&[0, 0, r.duration(500) as i32, -(r.duration(500) as i32), r.any() as i32]);
            let verdict = rust.push_echoes(0, (t_echo != NO_ECHO).then_some(Micros::new(t_echo)).as_slice(), change);
            let verdict = verdict.unwrap();
            let age = verdict.age.unwrap_or(u16::MAX).into();
            let by = explanation(verdict.explained_by);
            let expected = [verdict.kind as u32, echo(verdict.t_echo), echo(verdict.previous), age, by];
            assert_eq!(filter(&mut held, t_delta, consecutive, t_echo, change), expected, "{change}");
        }
    }
}

// Distances echo times and the speed of sound are the same for all numbers.
#[test]
fn distances_and_speed_of_sound_equal_rust_for_all_numbers() {
    let r = Random::new(2);
    for tenths in i16::MIN..=i16::MAX {
        assert_eq!(sound_mm_s(tenths), SpeedOfSound::at_celsius_tenths(tenths).mm_per_s(), "{tenths}");
    }
    for _ in 0..200_000 {
        let (c, us) = (r.one_of(&[343_200, r.duration(u32::MAX), u32::MAX, 0]), r.duration(u32::MAX));
        let sound = SpeedOfSound::from_mm_per_s(c);
        assert_eq!(distance_mm(us, c), sound.distance_mm(Micros::new(us)), "{us} us at {c}");
        assert_eq!(echo_time_us(us, c), sound.echo_time(us).as_micros(), "{us} mm at {c}");
    }
    // Where the result just fits, or just does not.
    for c in 1..2_000 {
        let most = (u64::from(u32::MAX) * u64::from(c) / 2_000_000) as u32;
        for mm in most.saturating_sub(2)..most + 3 {
            let sound = SpeedOfSound::from_mm_per_s(c);
            assert_eq!(echo_time_us(mm, c), sound.echo_time(mm).as_micros(), "{mm} mm at {c}");
        }
    }
}

#[test]
fn edges_queue_alike() {
    let (r, mut c, rust) = (Random::new(3), Edges::new(), EdgeQueue::<8>::new());
    for _ in 0..100_000 {
        if r.once_in(2) {
            let (sensor, high, at) = (r.within(0, 127) as u8, r.once_in(2), r.any() as u32);
            c.push(sensor, high, at);
            rust.push(Edge { sensor, high, at: Instant::from_micros(at) });
        } else {
            let edge = rust.pop().map(|edge| [edge.sensor.into(), edge.high.into(), edge.at.as_micros()]);
            assert_eq!(c.pop(), (edge, rust.lost().into()));
        }
    }
    assert!(rust.lost() > 0);
}

#[test]
fn adaptation_climbs_and_descends_alike() {
    const K: usize = 4;
    let needs =
        Needs { t_delta_us: 100, min_interval_us: 0, window_us: 0, layout: 0, neighbours: 4, stale_echo: false };
    let mut changes = 0;
    for seed in 0..40 {
        let (r, mut c) = (Random::new(seed), C::new());
        let mut rungs = vec![];
        for (number, period) in [30_000, 45_000, 60_000].into_iter().enumerate() {
            let a = [0, 5_000, 10_000, 15_000];
            let b = [0, 5_500, 11_000, 16_500];
            let flat: Vec<u32> = a.into_iter().chain(b).collect();
            assert_eq!(c.schedule(period, K as u8, 2, &flat), 0);
            assert_eq!(c.verify(number as u32, needs, &[]).0, 0);
            let schedule = Schedule::<K>::from_firing(Micros::new(period), [a, b].map(|row| row.map(Micros::new)));
            rungs.push(schedule.unwrap().verified(&Requirements::new(Micros::new(100))).unwrap());
        }
        let mut rust = Adaptation::new(&rungs).unwrap();
        (rust.window, rust.patience) = (r.within(0, 20) as u8, r.within(0, 5) as u8);
        (rust.noisy_permille, rust.calm_permille) = (r.within(0, 500) as u16, r.within(0, 500) as u16);
        assert_eq!(c.adaptation(rust.window, rust.patience, rust.noisy_permille, rust.calm_permille), 0);
        // Now and then longer than the middle schedules' window would allow, so that changes are refused.
        let config = RingConfig::new().with_window(Micros::new(20_000));
        let mut ring = Ring::new(&rungs[0], config, Instant::from_micros(0)).unwrap();
        assert_eq!(c.ring(0, [0, 20_000, 0, 0, 0], 2, 0), 0);
        let mut noise = 0;
        for _ in 0..20_000 {
            if r.once_in(3_000) {
                noise = r.within(0, 3);
            }
            let now = ring.next_deadline();
            let event = ring.poll(now);
            assert_eq!(c.poll(now.as_micros(), None).is_ok(), event.is_some());
            match event {
                Some(RingEvent::Fire { sensor, .. }) => {
                    let after = if r.within(1, 4) <= noise { r.within(5_000, 20_000) } else { 9_000 };
                    ring.echo(sensor, now + Micros::new(after)).unwrap();
                    assert_eq!(c.call(Do::Echo, sensor, now.as_micros().wrapping_add(after)), 0);
                }
                Some(RingEvent::PeriodEnded(stats)) => {
                    let changed = rust.adapt(&stats, |schedule| ring.change_schedule(schedule));
                    changes += u32::from(changed == Ok(true));
                    assert_eq!(c.call(Do::Adapt, 0, 0), changed.map_or(-16, i32::from));
                    let permille = rust.rejection_permille().unwrap_or(u16::MAX);
                    assert_eq!(c.rung(), (rust.rung() as u32, permille.into()));
                }
                _ => {}
            }
        }
    }
    assert!(changes > 100, "{changes} changes of schedule");
}
