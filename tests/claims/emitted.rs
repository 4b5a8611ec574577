//! Output of `eeruf design --emit rust`, compiled: the compiler has checked the table against its requirements.

use std::path::PathBuf;

use eeruf_core::{Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, flow::FlowRing, judge::Judge, plan::Plan};

use crate::common::eeruf;
use crate::started::rings;

// Public, for firmware to put where it likes.
#[expect(unreachable_pub)]
#[path = "emitted/flow_8.rs"]
mod flow_8;

/// Tables of ring files: the module, its file, the ring file, its number of sensors, and how the ring listens.
macro_rules! tables {
    ($($name:ident $path:tt $ring:literal $sensors:literal $config:expr;)*) => {
        $(
            #[expect(unreachable_pub)]
            #[path = $path]
            mod $name;
        )*

        #[test]
        fn every_ring_file_is_emitted_in_rust_and_fires() {
            $(
                let asked = ["design", $ring, "--no-atlas", "--period-only", "--emit", "rust"];
                assert_eq!(eeruf(&asked).out, include_str!($path), "eeruf {}", asked.join(" "));
                let ring = Ring::<_, _, $sensors>::new(&$name::RING, $config, Instant::default());
                assert_eq!(before_walls(ring.unwrap()), ([4; $sensors], true), "{}", $ring);
            )*
            let mut files = rings();
            let mut emitted = vec![$(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join($ring)),*];
            (files.sort(), emitted.sort());
            assert_eq!(files, emitted);
        }
    };
}

tables! {
    car_12 "emitted/car_12.rs" "rings/car-12.toml" 12 RingConfig::new();
    hc_sr04_8 "emitted/hc_sr04_8.rs" "rings/hc-sr04-8.toml" 8 hc_sr04_8::CONFIG;
    labmate_8 "emitted/labmate_8.rs" "rings/labmate-8.toml" 8 RingConfig::new();
    mower_8_and_4 "emitted/mower_8_and_4.rs" "rings/mower-8-and-4.toml" 12 RingConfig::new();
    multiplexers_8 "emitted/multiplexers_8.rs" "rings/hc-sr04-8-two-multiplexers.toml" 8 multiplexers_8::CONFIG;
    paper_12 "emitted/paper_12.rs" "rings/paper-12.toml" 12 RingConfig::new();
    ring_24 "emitted/ring_24.rs" "rings/ring-24.toml" 24 RingConfig::new();
    round_16 "emitted/round_16.rs" "rings/round-16.toml" 16 round_16::CONFIG;
}

/// Firings of each sensor in four periods, and true if each had the wall before it accepted.
fn before_walls<P: Plan, J: Judge, const K: usize, const H: usize>(mut ring: Ring<P, J, K, 1, H>) -> ([u32; K], bool) {
    let wall = ring.blanking().saturating_add(Micros::from_millis(2));
    let (mut fired, mut accepted) = ([0; K], [false; K]);
    loop {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    fired[usize::from(sensor)] += 1;
                    ring.echo(sensor, now + wall).unwrap();
                }
                RingEvent::Reading(reading) => {
                    accepted[usize::from(reading.sensor)] |= reading.kind == ReadingKind::Accepted;
                }
                RingEvent::PeriodEnded(stats) if stats.period == 3 => return (fired, accepted == [true; K]),
                RingEvent::PeriodEnded(_) => {}
            }
        }
    }
}

#[test]
fn an_emitted_table_drives_a_ring() {
    let mut ring = Ring::new(&paper_12::RING, RingConfig::new(), Instant::default()).unwrap();
    assert_eq!((ring.t_delta(), ring.window()), (Micros::new(999), Micros::from_millis(30)));
    let mut fired = [0; 12];
    while ring.next_deadline() != Instant::default() + Micros::from_millis(130) {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            if let RingEvent::Fire { sensor, .. } = event {
                fired[usize::from(sensor)] += 1;
            }
        }
    }
    assert_eq!(fired, [2; 12]);
}

// The modules' blanking goes with the table.
#[test]
fn emitted_table_is_deaf_as_its_modules() {
    let ring = Ring::<_, _, 8>::new(&multiplexers_8::RING, multiplexers_8::CONFIG, Instant::default()).unwrap();
    assert_eq!((ring.blanking(), ring.window_of(0)), (Micros::new(117), Micros::new(14_569)));
}

#[test]
fn emitted_flow_drives_a_ring_whose_modules_rest() {
    use flow_8::{LISTENING, SENSORS, SETTINGS};
    let start = Instant::default();
    let mut ring = FlowRing::<SENSORS>::flow(SENSORS, SETTINGS, LISTENING, start).unwrap();
    assert_eq!((SENSORS, ring.window(), ring.blanking()), (8, Micros::new(23_310), Micros::new(117)));
    let mut fired = [(0, start); 8];
    while ring.next_deadline().since(start) < Micros::from_millis(1000) {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            if let RingEvent::Fire { sensor, .. } = event {
                let (count, before) = &mut fired[usize::from(sensor)];
                assert!(
                    *count == 0 || now.since(*before) >= Micros::from_millis(60),
                    "{sensor}: {}",
                    now.since(*before)
                );
                (*count, *before) = (*count + 1, now);
            }
        }
    }
    // In cycles of 63.36 ms, longer while nothing is believed.
    assert!(fired.iter().all(|(count, _)| (10..=16).contains(count)), "{fired:?}");
}

// An emitted table of sensors that are not all alike drives a ring that knows each.
#[test]
fn emitted_uneven_table_drives_its_ring() {
    let ring = Ring::<_, _, 12>::new(&car_12::RING, RingConfig::new(), Instant::default()).unwrap();
    assert_eq!((ring.window_of(1), ring.window_of(4)), (Micros::new(32_051), Micros::new(11_655)));
    assert_eq!((ring.t_delta_of(1), ring.t_delta_of(4)), (Micros::new(644), Micros::new(894)));
}
