//! Reasons why a period is not shorter, in words that say which need to relax.

use eeruf_core::Micros;

use crate::engine::Problem;
use crate::engine::counting::{Bound, strongest};
use crate::engine::shortest::Shortest;

/// Returns the reason why the period found is not shorter; `time` converts ticks.
pub(crate) fn reason(problem: &Problem, found: &Shortest, time: &dyn Fn(u32) -> Micros) -> String {
    if found.bound < found.period {
        return format!(
            "the search, which ended early: periods from {} on are neither found nor excluded, and a larger budget may \
             settle that",
            time(found.bound)
        );
    }
    if found.period == 1 {
        return "the tick: a period has at least one".to_owned();
    }
    if problem.is_even() {
        let counted = strongest(&problem.merged());
        return if counted.period() >= found.period {
            by_counting(counted, time)
        } else {
            in_any_order(counted, found, time)
        };
    }
    let shorter = time(found.period - 1);
    if found.without_cases {
        format!("what the sensors need: {shorter} leave too little time for it, before any order of firing is chosen")
    } else {
        format!("what the sensors need together: no firing order meets it within {shorter} (every order was searched)")
    }
}

/// The reason if the period meets a bound by counting.
fn by_counting(bound: Bound, time: &dyn Fn(u32) -> Micros) -> String {
    let period = time(bound.period());
    match bound {
        Bound::Capacity { sensors, separation, window, least } => {
            let first = if least > 0 {
                format!(", the first {} from the period for the sake of stale echoes", time(least))
            } else {
                String::new()
            };
            format!(
                "window and separation: {sensors} sensors need {sensors} refire times {} apart{first}, and the \
                 shortest must leave a window of {}, which takes {period}; a shorter window, a smaller separation or \
                 fewer sensors would help, a shorter interval would not",
                time(separation),
                time(window)
            )
        }
        Bound::Clique { sensors, interval, .. } => format!(
            "interval: {sensors} sensors that are all neighbours must fire {} apart, which takes {period}; a shorter \
             interval or fewer neighbours would help, a smaller separation would not",
            time(interval)
        ),
        Bound::Density { sensors, at_once, interval, .. } => format!(
            "interval and number of sensors: at most {at_once} of {sensors} sensors can fire within the same {}, which \
             takes {period}; a shorter interval or fewer neighbours would help, a smaller separation would not",
            time(interval)
        ),
        Bound::Places { sensors, at_once, interval, separation, .. } => format!(
            "interval and separation together: at most {at_once} of {sensors} sensors can fire within the same {}, \
             which leaves too little time to tell {sensors} refire times {} apart, and takes {period}; a shorter \
             interval, a smaller separation or fewer neighbours would help",
            time(interval),
            time(separation)
        ),
        Bound::Classes { clique, sensors, interval, separation, .. } => format!(
            "interval and separation together: {clique} sensors that are all neighbours and fire {} apart leave too \
             little time to tell {sensors} refire times {} apart, which takes {period}; a shorter interval, a smaller \
             separation or fewer neighbours would help",
            time(interval),
            time(separation)
        ),
    }
}

/// The reason if no bound explains the period, but a full search found no schedule one tick shorter.
fn in_any_order(counted: Bound, found: &Shortest, time: &dyn Fn(u32) -> Micros) -> String {
    let alone = match counted {
        Bound::Capacity { .. } => "window and separation alone",
        Bound::Classes { .. } | Bound::Places { .. } => "the sizes of the refire times",
        Bound::Clique { .. } | Bound::Density { .. } => "the interval alone",
    };
    format!(
        "interval and separation together: no firing order of the sensors meets both within {}, though {} would do for \
         {alone} (every order was searched)",
        time(found.period - 1),
        time(counted.period())
    )
}
