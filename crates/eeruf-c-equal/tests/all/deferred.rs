//! A flow ring in C decides about the next firing when first asked, so that its trigger is on time: whatever came in
//! between, the decision is that of a ring that is asked at once.

use eeruf_c_equal::{C, Do, Random};

const SENSORS: u8 = 4;
/// The settings of `EERUF_FLOW`.
const SETTINGS: [u32; 15] = [25_000, 0, 6_000, 33_500, 60_000, 2_000, 1, 80, 150, 150, 8, 4, 0, 0, 0];
/// `EERUF_EVENT_FIRE`.
const FIRE: u32 = 0;

#[test]
fn decision_does_not_depend_on_when_it_is_asked() {
    let mut firings = 0;
    for seed in 0..100 {
        let r = &Random::new(seed);
        let mut rings = [C::new(), C::new()];
        for c in &mut rings {
            assert_eq!(c.flow(SENSORS, &SETTINGS, &[], 0), 0);
            assert_eq!(c.modules(60_000, 150), 0);
        }
        for step in 0..400 {
            let at = || format!("seed {seed}, step {step}");
            let [now, other] = rings.each_ref().map(C::deadline);
            assert_eq!(now, other, "{}", at());
            while let [Ok(event), other] = rings.each_mut().map(|c| c.poll(now, None)) {
                assert_eq!(Ok(event), other, "{}", at());
                let [kind, sensor, ..] = event;
                if kind != FIRE {
                    continue;
                }
                assert!(sensor < SENSORS.into(), "{}: {sensor}", at());
                firings += 1;
                let _asks = rings[0].deadline();
                let (sensor, is_high) = (sensor as u8, u8::from(r.once_in(12)) << 7);
                let (rises, falls) = (!r.once_in(12), !r.once_in(6));
                // Echoes that differ are doubted, and get more quiet.
                let fall = now.wrapping_add(500 + r.within(1_000, 24_000));
                for c in &mut rings {
                    let fires = c.call(Do::FireModule, sensor | is_high, 0) == 0;
                    for (edge, at) in [(0x80, now.wrapping_add(450)), (0, fall)] {
                        if fires && if edge == 0 { falls } else { rises } {
                            assert_eq!(c.call(Do::Edge, sensor | edge, at), 0);
                        }
                    }
                }
            }
        }
    }
    assert!(firings > 5_000, "{firings} firings");
}
