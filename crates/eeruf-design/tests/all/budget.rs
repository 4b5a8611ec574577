//! Claims of a search that ends before its proof, for a robot that moves.

use eeruf_design::{Effort, NoDesign, RingSpec};

#[test]
fn bounds_hold_whatever_the_budget() {
    for layout in ["line", "ring"] {
        let ring = format!(
            "sensors = 12\nlayout = \"{layout}\"\nneighbours = 4\nmax_range_m = 4\ncrosstalk_range_m = 2\njitter_us = \
             60\nspeed_m_s = 0.5\ntick_us = 100\n"
        );
        let spec = RingSpec::from_text(&ring).unwrap();
        let within = |budget| spec.shortest(&Effort { budget, what_if: false, atlas: "" }, &mut ());
        let shortest = within(1_000_000).unwrap().found;
        assert!(shortest.proven);
        let mut unproven = 0;
        for budget in [1, 3, 10, 30, 100, 300, 1000] {
            match within(budget) {
                Ok(design) if design.found.proven => assert_eq!(design.found.value, shortest.value, "{budget} nodes"),
                Ok(design) => {
                    unproven += 1;
                    assert!(design.found.value >= shortest.value, "{budget} nodes");
                    assert!(design.found.bound <= shortest.value, "{budget} nodes: {:?}", design.found.bound);
                    assert!(design.schedule.verify(&design.spec.problem().requirements).ok());
                }
                Err(none) => assert_eq!(none, NoDesign::EndedEarly, "{budget} nodes"),
            }
        }
        assert!(unproven > 0, "{layout}: no budget was too small");
    }
}

#[test]
fn faster_needs_are_compared_with_printed_ones() {
    // It moves, so that the needed t_delta depends on the schedule that is found.
    let ring = "sensors = 8\nlayout = \"line\"\nneighbours = 4\nmax_range_m = 4\ncrosstalk_range_m = 2\n\
                jitter_us = 60\nspeed_m_s = 1\ntick_us = 100\n";
    let spec = RingSpec::from_text(ring).unwrap();
    let search = Effort { budget: 100_000, what_if: true, atlas: "" };
    let design = spec.shortest(&search, &mut ()).unwrap();
    let needed = format!("instead of {}", design.t_delta);
    assert!(
        design.t_delta > spec.t_delta && design.what_if.iter().any(|case| case.need.ends_with(&needed)),
        "{needed}"
    );
}
