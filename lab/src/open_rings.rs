//! Searches the rings that the atlas leaves open: `cargo lab open-rings [SECONDS
//! [FILE [PART/PARTS]]]`, each for this many seconds of a core.
//!
//! Prints each ring as the atlas does, with its shortest known period, the bound, the difference of the two and the
//! seconds that this run took for it. FILE is an earlier list, tests/data/open-rings.txt: what is better there stays,
//! and what is proven there is not searched again.

use std::collections::BTreeMap;
use std::fs::read_to_string;

use eeruf_design::atlas::{ATLAS, Ring, rows};
use eeruf_period::engine::Problem;
use eeruf_period::engine::shortest::shortest;

use crate::clock::core_seconds;

fn problem(ring: &Ring) -> Problem {
    let sensors = usize::from(ring.sensors);
    let rows = ring.neighbourhood.layout(ring.sensors).rows(sensors);
    Problem::alike(&rows[..sensors], ring.separation, ring.interval, ring.window)
}

/// The period and bound of each ring of an earlier list.
fn known(text: &str) -> BTreeMap<Ring, [u32; 2]> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let lines = lines.filter_map(|line| line.split_once(": "));
    let number = |words: &[&str], at: usize| words[at].parse().expect("a number");
    lines
        .map(|(ring, rest)| {
            let words: Vec<&str> = rest.split(' ').collect();
            (ring.parse().expect("a ring"), [number(&words, 0), number(&words, 1)])
        })
        .collect()
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let mut arguments = arguments.iter();
    let seconds: f64 = arguments.next().map_or(Ok(1.0), |text| text.parse())?;
    let known = known(&arguments.next().map_or(Ok(String::new()), read_to_string)?);
    let share = arguments.next().map_or("1/1", String::as_str);
    let (part, parts) = share.split_once('/').ok_or("expected a share such as 1/2")?;
    let (part, parts): (usize, usize) = (part.parse()?, parts.parse()?);
    println!(
        "# The rings that the atlas leaves open, after longer searches: sensors, layout, neighbours, separation,\n\
         # interval, window in ticks: period, bound, the difference, seconds of a core in the last run."
    );
    let (mut rings, mut open, mut of_six, mut open_of_six) = (0, 0, 0, 0);
    let atlas: Vec<_> = rows(ATLAS).filter(|row| row.bound < row.period).collect();
    for row in atlas.iter().skip(part - 1).step_by(parts) {
        let [mut period, mut bound] = known.get(&row.ring).copied().unwrap_or([row.period, row.bound]);
        let begin = core_seconds();
        if bound < period {
            let found = shortest(&problem(&row.ring), u64::MAX, &mut |_| core_seconds() - begin < seconds);
            let found = found.ok_or("no schedule")?;
            (period, bound) = (period.min(found.period), bound.max(found.bound));
        }
        println!("{}: {period} {bound} {} {:.1}", row.ring, period - bound, core_seconds() - begin);
        let is_of_six = row.ring.to_string().split(' ').nth(2) == Some("6") && row.ring.sensors <= 20;
        (rings, open) = (rings + 1, open + usize::from(bound < period));
        (of_six, open_of_six) =
            (of_six + usize::from(is_of_six), open_of_six + usize::from(is_of_six && bound < period));
    }
    println!("# {open} of {rings} rings are open; {open_of_six} of {of_six} with 6 neighbours and up to 20 sensors");
    Ok(())
}
