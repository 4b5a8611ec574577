//! Schedules that fit into a period, and curves of needs, against the shortest period.

use eeruf_core::Micros;
use eeruf_design::{CURVE_POINTS, Effort, Need, RingSpec};

const SEARCH: Effort = Effort { budget: 200_000, what_if: false, atlas: "" };

fn ring(text: &str) -> RingSpec {
    RingSpec::from_text(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Even and uneven rings, at rest and moving.
fn rings() -> [RingSpec; 5] {
    let common = "sensors = 6\nneighbours = 3\nmin_interval_us = 7_000\n";
    [
        ring(&format!("{common}t_delta_us = 499\nwindow_us = 20_000\n")),
        ring(&format!("{common}layout = \"ring\"\nt_delta_us = 999\nwindow_us = 9_000\nstale_echo = true\n")),
        ring(&format!("{common}jitter_us = 100\nspeed_m_s = 1.5\nwindow_us = 20_000\ntick_us = 100\n")),
        ring(&format!(
            "{common}t_delta_us = [999, 499, 499, 499, 499, 499]\nwindow_us = 15_000\nshared_lines = [[0, 3]]\n"
        )),
        ring(&format!(
            "{common}jitter_us = [50, 90, 50, 50, 50, 50]\nspeed_m_s = 0.9\nwindow_us = 15_000\ntick_us = 200\n"
        )),
    ]
}

fn shortest(spec: &RingSpec) -> Micros {
    let design = spec.shortest(&SEARCH, &mut ()).expect("there is a schedule");
    assert!(design.found.proven, "{:?}", design.found);
    design.schedule.period()
}

#[test]
fn needs_fit_from_the_shortest_period_on() {
    for spec in rings() {
        let tick = spec.tick.as_micros();
        let least = shortest(&spec).as_micros();
        for (period, fits) in [(least - 2 * tick, false), (least - tick, false), (least, true)] {
            let fit = spec.fit(Micros::new(period), 200_000, &mut ()).expect("a period in ticks");
            assert_eq!(fit.fits, Some(fits), "{period} of {least}: {fit:?}");
            if fits {
                let schedule = fit.schedule.expect("one that meets the needs");
                assert_eq!(schedule.period(), Micros::new(period));
                assert!(schedule.verify(&fit.spec.problem().requirements).ok(), "{fit:?}");
            }
        }
    }
}

#[test]
fn largest_t_delta_fits_and_a_microsecond_more_does_not() {
    let text = |t_delta: u32| format!("sensors = 6\nneighbours = 3\nmin_interval_us = 7_000\nt_delta_us = {t_delta}\n");
    for period in [30_000, 34_000] {
        let period = Micros::new(period);
        let of = |t_delta| ring(&format!("{}window_us = 20_000\n", text(t_delta)));
        let fit = of(1).fit(period, 200_000, &mut ()).expect("a period in ticks");
        let largest = fit.t_delta.expect("a schedule").as_micros();
        assert!(fit.proven && fit.bound == fit.t_delta, "{fit:?}");
        assert!(shortest(&of(largest)) <= period && shortest(&of(largest + 1)) > period, "{fit:?}");
    }
}

#[test]
fn periods_that_cannot_be_asked_for_are_refused() {
    let spec = &rings()[0];
    let error = |us| spec.fit(Micros::new(us), 1000, &mut ()).unwrap_err().to_string();
    assert_eq!(error(30_500), "the period of 30.5 ms; expected a whole number of ticks of 1 ms");
    assert!(error(0).contains("expected"), "{}", error(0));
}

// Curve points are the shortest periods of rings with that need.
#[test]
fn curve_points_are_shortest_periods() {
    let text = |t_delta: u32, window: u32, interval: u32| {
        ring(&format!(
            "sensors = 6\nneighbours = 3\nt_delta_us = {t_delta}\nwindow_us = {window}\nmin_interval_us = {interval}\n"
        ))
    };
    let own = text(500, 20_000, 7_000);
    for need in [Need::TDelta, Need::Range, Need::Interval] {
        let curve = own.curve(need, &SEARCH, &mut ()).expect("it can be searched");
        assert_eq!(curve.len(), CURVE_POINTS as usize);
        for point in &curve {
            let tenths = point.tenths;
            let (spec, value) = match need {
                Need::TDelta => (text(50 * tenths, 20_000, 7_000), 50 * tenths),
                Need::Range => (text(500, 2_000 * tenths, 7_000), 2_000 * tenths),
                Need::Interval => (text(500, 20_000, 700 * tenths), 700 * tenths),
            };
            assert!(point.proven, "{need:?}: {point:?}");
            assert_eq!((point.value, point.period), (Micros::new(value), Some(shortest(&spec))), "{need:?}: {point:?}");
        }
        assert!(curve[0].period < curve[19].period, "{need:?}: the curve rises");
    }
}

// Curves of uneven and moving rings rise and pass their own period.
#[test]
fn curves_of_uneven_rings_rise_through_their_period() {
    for spec in &rings()[2..] {
        let own = shortest(spec);
        for need in [Need::TDelta, Need::Range, Need::Interval] {
            let curve = spec.curve(need, &SEARCH, &mut ()).expect("it can be searched");
            assert_eq!(curve[9].period, Some(own), "{need:?}");
            let periods: Vec<_> = curve.iter().filter(|point| point.proven).map(|point| point.period).collect();
            assert!(periods.is_sorted() && periods.len() > 10, "{need:?}: {curve:?}");
        }
    }
}
