//! Default settings of a flow ring, which must be the same numbers in Rust and C.

use eeruf_core::{
    Micros,
    flow::{BeliefSettings, TurnSettings, Votes},
};

#[test]
fn flow_settings_of_c_are_those_of_the_core() {
    let (_, after) = include_str!("../../../../c/eeruf.h").split_once("#define EERUF_FLOW(").unwrap();
    let (_, body) = after.split_once("window_us, ").unwrap();
    let (body, _) = body.split_once(", NULL, NULL}").unwrap();
    let numbers: Vec<u32> = body.split(", ").map(|number| number.parse().expect("a number")).collect();
    let (t, b) = (TurnSettings::new(1), BeliefSettings::DEFAULT);
    // The window is a parameter; blanking is zero.
    let mut expected = vec![0];
    expected.extend([t.least, t.most, t.rest, t.dice].map(Micros::as_micros));
    expected.push(t.seed);
    expected.extend([b.t_delta, b.near, b.path_change].map(Micros::as_micros));
    expected.extend([b.memory.into(), b.hold.into(), b.top_speed_mm_s.into(), u32::from(b.alone)]);
    // By motion is 0 in C.
    assert_eq!(b.votes, Votes::ByMotion);
    expected.push(0);
    assert_eq!(numbers, expected);
}
