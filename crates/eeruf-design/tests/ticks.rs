//! Claims about finer ticks, against searches in ticks of a tenth.

#[path = "../../eeruf-period/tests/common/mod.rs"]
mod common;

use common::Random;
use eeruf_core::Micros;
use eeruf_design::{RingDesign, RingSpec, Search, real_budget};

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
    let search = Search { budget: 200_000, what_if: false, atlas: "" };
    spec.shortest(&search, &mut ()).expect("a schedule")
}

#[test]
fn no_finer_tick_beats_what_is_proven_over_the_reals() {
    let cases = std::env::var("EERUF_CASES").map_or(30, |cases| cases.parse().expect("a number"));
    let (mut proven, mut said, mut shorter) = (0, 0, 0);
    for seed in 0..cases {
        let text = random_ring(seed);
        let tick_us = [1000, 500][seed as usize % 2];
        let coarse = in_ticks_of(&text, tick_us);
        let fine = in_ticks_of(&text, tick_us / 10);
        let period = |design: &RingDesign| design.schedule.period();
        // Coarse ticks are fine ones too, so a bound in fine ticks holds in coarse ones.
        assert!(period(&coarse) >= fine.found.bound.unwrap_or_default(), "seed {seed}\n{text}");
        shorter += usize::from(period(&fine) < period(&coarse));
        let budget = real_budget(coarse.spec.sensors);
        let Some(real) = coarse.over_reals(budget, |_| true).filter(|real| real.proven) else { continue };
        proven += 1;
        // The least t_delta is for the fine schedule; if it moves less, it may need less.
        let same_needs = fine.t_delta >= coarse.t_delta;
        if same_needs {
            assert!(real.us() <= f64::from(period(&fine).as_micros()), "seed {seed}: {real:?}\n{text}");
        }
        let is_said = real.gain_us(period(&coarse)) <= 0.0 && coarse.spec.speed_mm_s.unwrap_or(0) == 0;
        said += usize::from(is_said);
        assert!(!is_said || period(&fine) >= period(&coarse), "seed {seed}\n{text}");
    }
    println!("{cases} rings: {proven} proven over the reals, {said} without a gain, {shorter} shorter in a tenth");
    assert!(proven * 2 > cases as usize && shorter > 0, "{proven} {shorter}");
}

#[test]
fn needs_in_whole_ticks_gain_nothing_from_finer_ones() {
    // Window 20 ms and separation 2 * 7 + 1 us are whole ticks of 5 us, and they alone bound the period.
    let ring = "sensors = 2\nneighbours = 1\nt_delta_us = 7\nmin_interval_us = 0\nwindow_us = 20_000\n";
    let found = in_ticks_of(ring, 5);
    let real = found.over_reals(real_budget(2), |_| true).expect("small numbers");
    assert_eq!((real.period_us, real.proven), ((20_015, 1), true));
    assert_eq!((found.schedule.period(), real.gain_us(found.schedule.period())), (Micros::new(20_015), 0.0));
}

#[test]
fn needs_that_were_rounded_up_gain_from_finer_ticks() {
    // Four neighbours 15 ms apart, and of the separation a microsecond less than two ticks.
    let ring = "sensors = 4\nneighbours = 4\nt_delta_us = 999\nmin_interval_us = 15_000\nwindow_us = 40_000\n";
    let found = in_ticks_of(ring, 1000);
    let real = found.over_reals(real_budget(4), |_| true).expect("small numbers");
    assert_eq!(found.schedule.period(), Micros::from_millis(62));
    assert_eq!((real.period_us, real.proven), ((61_999, 1), true));
    assert_eq!(in_ticks_of(ring, 1).schedule.period(), Micros::new(61_999));
}
