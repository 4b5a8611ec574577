//! `handling_us`: firings far enough apart for the controller, with all other needs kept.

use eeruf_core::{Micros, Phase, Requirements};
use eeruf_design::{Effort, NoDesign, RingDesign, RingSpec};

fn designed(text: &str) -> Result<RingDesign, NoDesign> {
    let spec = RingSpec::from_text(text).expect("a ring");
    spec.shortest(&Effort::default(), &mut ())
}

fn ring(sensors: usize, more: &str) -> String {
    format!(
        "sensors = {sensors}\nlayout = \"ring\"\nmax_range_m = 4.0\ncrosstalk_range_m = 2.5\njitter_us = 200\n\
         speed_m_s = 0.5\ntick_us = 500\nretrigger_us = 60_000\n{more}"
    )
}

/// All instants of two periods, and the ends of the periods, in order.
fn instants(design: &RingDesign, sensors: usize) -> Vec<(u32, usize)> {
    let period = design.schedule.period().as_micros();
    let of = |phase, start: u32| {
        (0..sensors).map(move |x| (start + design.schedule.t_fire(phase, x).expect("a sensor").as_micros(), x))
    };
    let mut instants: Vec<_> = of(Phase::A, 0).chain(of(Phase::B, period)).chain(of(Phase::A, 2 * period)).collect();
    instants.sort_unstable();
    instants
}

#[test]
fn firings_are_apart_by_what_one_takes_and_the_rest_is_kept() {
    let mut same = 0;
    for sensors in [2, 3, 6, 8, 12, 16, 24] {
        for handling in [50, 110, 250, 400] {
            let at_once = designed(&ring(sensors, "")).expect("a schedule");
            let design = match designed(&ring(sensors, &format!("handling_us = {handling}"))) {
                Ok(design) => design,
                Err(none) => {
                    assert_eq!(none, NoDesign::Handling);
                    continue;
                }
            };
            let instants = instants(&design, sensors);
            let nearest = instants.windows(2).map(|pair| pair[1].0 - pair[0].0).min().expect("two firings");
            assert!(nearest >= handling, "{sensors} sensors: {nearest} us apart, {handling} asked for");
            let requirements: Requirements<'_> = design.spec.problem().requirements;
            assert!(design.schedule.verify(&requirements).ok());
            assert_eq!(design.spec.t_delta, design.t_delta);
            let period = design.schedule.period();
            assert!(period >= at_once.schedule.period());
            // A longer one is not called the shortest.
            assert_eq!(design.found.proven, period == at_once.schedule.period(), "{sensors} sensors, {handling} us");
            assert_eq!((design.bound, design.bounding.t_delta), (at_once.bound, at_once.bounding.t_delta));
            same += u32::from(design.found.proven);
        }
    }
    assert!(same >= 12, "{same} periods as short as without");
}

#[test]
fn without_it_or_where_no_two_coincide_nothing_changes() {
    let at_once = designed(&ring(4, "")).expect("a schedule");
    let zero = designed(&ring(4, "handling_us = 0")).expect("a schedule");
    assert_eq!(zero.schedule, at_once.schedule);
    assert!(zero.to_spare.is_some());
}

#[test]
fn sensors_that_fire_together_by_demand_still_do() {
    let design = designed(
        "sensors = 6\nneighbours = 2\nt_delta_us = 300\nmin_interval_us = 9_000\nwindow_us = 12_000\ntick_us = 500\n\
         together = [[0, 3], [1, 4]]\nhandling_us = 200\n",
    )
    .expect("a schedule");
    let mut coincide = 0;
    for pair in instants(&design, 6).windows(2) {
        let (one, other) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
        if pair[0].0 == pair[1].0 {
            assert!([(0, 3), (1, 4)].contains(&(one, other)));
            coincide += 1;
        } else {
            assert!(pair[1].0 - pair[0].0 >= 200);
        }
    }
    assert_eq!(coincide, 6);
}

#[test]
fn what_fits_into_a_period_keeps_firings_apart_too() {
    let spec = RingSpec::from_text(&ring(8, "handling_us = 110")).expect("a ring");
    let fit = spec.fit(Micros::from_millis(67), 1_000_000, &mut ()).expect("a search");
    assert_eq!(fit.fits, Some(true));
    let schedule = fit.schedule.expect("a schedule");
    for phase in [Phase::A, Phase::B] {
        let mut times: Vec<_> = (0..8).map(|x| schedule.t_fire(phase, x).expect("a sensor").as_micros()).collect();
        times.sort_unstable();
        assert!(times.windows(2).all(|pair| pair[1] - pair[0] >= 110), "{times:?}");
    }
}
