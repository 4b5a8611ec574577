//! Output of `eeruf design --emit rust`, compiled: the compiler has checked the table against its requirements.

// Public, for firmware to put where it likes.
#[expect(unreachable_pub)]
#[path = "emitted/car_12.rs"]
mod car_12;
#[expect(unreachable_pub)]
#[path = "emitted/flow_8.rs"]
mod flow_8;
#[expect(unreachable_pub)]
#[path = "emitted/multiplexers_8.rs"]
mod multiplexers_8;
#[expect(unreachable_pub)]
#[path = "emitted/paper_12.rs"]
mod paper_12;

use eeruf_core::{Instant, Micros, Ring, RingConfig, RingEvent, flow::FlowRing};

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
