//! Parts that can be used alone: distances, edges.

use eeruf_c_equal::{Edges, Random, distance_mm, sound_mm_s};
use eeruf_core::{Edge, EdgeQueue, Instant, Micros, SpeedOfSound};

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
