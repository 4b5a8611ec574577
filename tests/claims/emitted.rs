//! Output of `eeruf design --emit rust`, compiled: the compiler has checked the table against its requirements.

// Public, for firmware to put where it likes.
#[expect(unreachable_pub)]
#[path = "emitted/car_12.rs"]
mod car_12;
#[expect(unreachable_pub)]
#[path = "emitted/paper_12.rs"]
mod paper_12;

use eeruf_core::{Instant, Micros, Ring, RingConfig, RingEvent};

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

#[test]
fn an_emitted_table_of_sensors_that_are_not_all_alike_drives_a_ring_that_knows_each() {
    let ring = Ring::<_, _, 12>::new(&car_12::RING, RingConfig::new(), Instant::default()).unwrap();
    assert_eq!((ring.window_of(1), ring.window_of(4)), (Micros::new(32_051), Micros::new(11_655)));
    assert_eq!((ring.t_delta_of(1), ring.t_delta_of(4)), (Micros::new(644), Micros::new(894)));
}
