//! Prints the result as source text of `eeruf-sim`.

use eeruf_sim::Method;

use super::score::Round;
use super::search::Tuned;

/// Returns the file's text.
pub(crate) fn source(rounds: &[Round], found: &[(Method, Tuned)]) -> String {
    let mut text = String::from(
        "//! The pilots that `cargo lab tune` found, one for each method; it prints this file: change none by hand.\n\
         //!\n",
    );
    let mut first = 0;
    for (number, round) in rounds.iter().enumerate() {
        let Round { pilots, courses } = round;
        let who = if number == 0 { format!("{pilots} pilots") } else { format!("the best {pilots}") };
        let end = if number + 1 == rounds.len() { ". The best is taken." } else { "," };
        text += &format!("//! {who} on courses {first} to {}{end}\n", first + courses - 1);
        first += courses;
    }
    let courses = rounds.last().map_or(0, |round| round.courses);
    text += &format!(
        "//! Every course is driven alone, with a second robot behind, and with one ahead.\n\n\
         use crate::methods::Method;\n\
         use crate::navigation::{{Piloting, tuned}};\n\n\
         /// Smoothing, threshold, width of a wide valley, highest density, rate of turn in degrees/s, gain, range\n\
         /// in metres, growth rate operator; of the last {courses} courses how many were finished alone, behind and\n\
         /// ahead.\n\
         #[rustfmt::skip]\n\
         pub(super) const OWN: [(Method, Piloting); {}] = [\n",
        found.len()
    );
    for (method, tuned) in found {
        text += &format!("    {}\n", row(*method, tuned));
    }
    text + "];\n"
}

/// Returns one method's line.
pub(crate) fn row(method: Method, tuned: &Tuned) -> String {
    let Tuned { pilot, score, .. } = tuned;
    let [alone, behind, ahead] = score.finished;
    format!(
        "(Method::{method:?}, tuned({}, {:?}, {}, {:?}, {:?}, {:?}, {:?}, {})), // {alone}, {behind}, {ahead}",
        pilot.smoothing,
        pilot.threshold,
        pilot.wide,
        pilot.density_max,
        pilot.turn_max_deg_s,
        pilot.turn_gain,
        pilot.range_m,
        pilot.growth,
    )
}
