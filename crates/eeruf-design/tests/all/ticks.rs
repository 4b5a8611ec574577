//! Claims about finer ticks, checked by searches in ticks of a tenth.

use crate::common::Random;
use eeruf_core::Micros;
use eeruf_design::{Effort, RingDesign, RingSpec};

/// A ring file in metres, without its tick.
fn random_ring(seed: u64) -> String {
    let mut random = Random(seed + 1);
    for _ in 0..10 {
        random.below(2);
    }
    let sensors = 4 + random.below(9);
    let metres = |hundredths: u32| f64::from(hundredths) / 100.0;
    let range = 100 + random.below(400);
    let crosstalk = 50 + random.below(range.min(250) - 49);
    let speed = match random.below(4) {
        0 => format!("speed_m_s = {}\n", metres(random.below(100))),
        _ => String::new(),
    };
    format!(
        "sensors = {sensors}\nlayout = \"{}\"\nneighbours = {}\nmax_range_m = {}\ncrosstalk_range_m = {}\n\
         jitter_us = {}\n{speed}",
        ["line", "ring"][random.below(2) as usize],
        2 + random.below(3),
        metres(range),
        metres(crosstalk),
        50 + random.below(200)
    )
}

fn in_ticks_of(text: &str, tick_us: u32) -> RingDesign {
    let spec = RingSpec::from_text(&format!("{text}tick_us = {tick_us}\n")).expect("a ring");
    let search = Effort { budget: 200_000, what_if: false, atlas: "" };
    spec.shortest(&search, &mut ()).expect("a schedule")
}

// Coarse ticks are fine ones too, so a bound in fine ticks holds in coarse ones.
#[test]
fn finer_ticks_are_no_slower() {
    let cases = std::env::var("EERUF_CASES").map_or(30, |cases| cases.parse().expect("a number"));
    let mut shorter = 0;
    for seed in 0..cases {
        let text = random_ring(seed);
        let tick_us = [1000, 500][seed as usize % 2];
        let [coarse, fine] = [tick_us, tick_us / 10].map(|tick_us| in_ticks_of(&text, tick_us));
        assert!(coarse.schedule.period() >= fine.found.bound.unwrap_or_default(), "seed {seed}\n{text}");
        shorter += usize::from(fine.schedule.period() < coarse.schedule.period());
    }
    assert!(shorter > 0);
}

#[test]
fn needs_that_were_rounded_up_gain_from_finer_ticks() {
    // Four neighbours 15 ms apart, and of the separation a microsecond less than two ticks.
    let ring = "sensors = 4\nneighbours = 4\nt_delta_us = 999\nmin_interval_us = 15_000\nwindow_us = 40_000\n";
    assert_eq!(in_ticks_of(ring, 1000).schedule.period(), Micros::from_millis(62));
    assert_eq!(in_ticks_of(ring, 1).schedule.period(), Micros::new(61_999));
}
