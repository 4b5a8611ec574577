//! Output of `eeruf design --emit rust`, compiled: the compiler checks the table against its requirements.

use std::path::PathBuf;

use eeruf_core::{Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, flow::FlowRing, judge::Judge, plan::Plan};

use crate::common::{C, Scratch, compile_and_run, cpp, eeruf};
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
    car_12 "emitted/car_12.rs" "rings/car-12.toml" 12 car_12::CONFIG;
    hc_sr04_8 "emitted/hc_sr04_8.rs" "rings/hc-sr04-8.toml" 8 hc_sr04_8::CONFIG;
    labmate_8 "emitted/labmate_8.rs" "rings/labmate-8.toml" 8 RingConfig::new();
    magni_5 "emitted/magni_5.rs" "rings/magni-5.toml" 5 magni_5::CONFIG;
    mower_8_and_4 "emitted/mower_8_and_4.rs" "rings/mower-8-and-4.toml" 12 mower_8_and_4::CONFIG;
    multiplexers_8 "emitted/multiplexers_8.rs" "rings/hc-sr04-8-two-multiplexers.toml" 8 multiplexers_8::CONFIG;
    nao_2 "emitted/nao_2.rs" "rings/nao-2.toml" 2 nao_2::CONFIG;
    paper_12 "emitted/paper_12.rs" "rings/paper-12.toml" 12 RingConfig::new();
    pioneer_8 "emitted/pioneer_8.rs" "rings/pioneer-3dx-8.toml" 8 pioneer_8::CONFIG;
    pmb2_3 "emitted/pmb2_3.rs" "rings/pmb2-3.toml" 3 pmb2_3::CONFIG;
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
    use flow_8::{BELIEF, CONFIG, SENSORS};
    let start = Instant::default();
    assert!(FlowRing::<SENSORS>::flow(SENSORS, flow_8::turns(0), BELIEF, CONFIG, start).is_err());
    let mut ring = FlowRing::<SENSORS>::flow(SENSORS, flow_8::turns(77), BELIEF, CONFIG, start).unwrap();
    assert_eq!((SENSORS, ring.window(), ring.blanking()), (8, Micros::new(24_310), Micros::new(117)));
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
    // Nothing is heard: quiet stays at the 11.5 ms that it begins with, and dice of 1 ms in the mean follow.
    assert!(fired.iter().all(|(count, _)| (9..=11).contains(count)), "{fired:?}");
}

// An emitted table of sensors that are not all alike drives a ring that knows each.
#[test]
fn emitted_uneven_table_drives_its_ring() {
    let ring = Ring::<_, _, 12>::new(&car_12::RING, RingConfig::new(), Instant::default()).unwrap();
    assert_eq!((ring.window_of(1), ring.window_of(4)), (Micros::new(32_051), Micros::new(11_655)));
    assert_eq!((ring.t_delta_of(1), ring.t_delta_of(4)), (Micros::new(1_395), Micros::new(1_645)));
}

// In C only those sensors of a car accept a wall that look as far.
#[test]
fn emitted_limits_hold_in_c() {
    let c = eeruf(&["design", "rings/car-12.toml", "--period-only", "--emit", "c"]).out;
    let (folder, header) = Scratch::new("schedule.h", &c);
    let main = "static EerufRing ring;
        static EerufSensor sensors[EERUF_SENSORS];
        static uint32_t accepted[EERUF_SENSORS];
        int main(void) {
            const EerufConfig config = EERUF_CONFIG;
            EerufEvent event;
            uint32_t at = 0, x, period = 0;
            if (eeruf_schedule_check(&eeruf_schedule) != EERUF_OK) return 1;
            if (eeruf_ring_init(&ring, sizeof ring, sensors, sizeof sensors, &eeruf_schedule, &config, 0) != EERUF_OK)
                return 2;
            while (period < 110) {
                if (eeruf_ring_poll(&ring, at, &event) != EERUF_EVENT) {
                    at = eeruf_ring_deadline(&ring);
                } else if (event.kind == EERUF_EVENT_FIRE) {
                    eeruf_ring_echo(&ring, event.sensor, at + 13000);
                } else if (event.kind == EERUF_EVENT_PERIOD) {
                    period++;
                } else if (event.u.reading.kind == EERUF_READING_ACCEPTED) {
                    if (event.u.reading.t_echo_us != 13000u) return 3;
                    accepted[event.sensor]++;
                }
            }
            for (x = 0; x < EERUF_SENSORS; x++)
                if ((accepted[x] > 100) != (eeruf_schedule.limits[x].window_us > 13000u)) return 4;
            return 0;
        }";
    let with_library = format!("#include <eeruf.h>\n#include \"{}\"\n{main}\n", header.display());
    for language in [C].into_iter().chain(cpp()) {
        compile_and_run(&folder, &with_library, &[language, &["c/eeruf.c"]].concat());
    }
}
