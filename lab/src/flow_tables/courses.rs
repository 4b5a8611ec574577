//! Set II: courses among poles, alone, with another robot behind, and with one ahead.

use eeruf_core::{Micros, flow::Votes};
use eeruf_sim::experiments::set_two::{Pilots, SECOND_AHEAD, SECOND_BEHIND, SetTwoOptions, set_two};
use eeruf_sim::{Entry, LabMate, Method};

use super::{Asked, Cell, Table, flow, usual};

/// Choices: what the map gets, for how long sensors listen, and the least quiet.
fn candidates() -> Vec<Entry> {
    let ms = |time: u32| Some(Micros::from_millis(time));
    let mut entries = vec![Entry::from(Method::Flow)];
    for (name, votes, of) in [
        ("believed", Votes::TwoInARow, &[(36, 8), (18, 4)][..]),
        ("every echo", Votes::EveryEcho, &[(36, 8), (36, 4), (30, 4), (24, 4)]),
    ] {
        for &(window, least) in of {
            entries.push(flow(&format!("{name}, window {window}, least {least}"), votes, ms(least), ms(window)));
        }
    }
    entries
}

pub(super) fn table(asked: &Asked) -> Result<Table, Box<dyn std::error::Error>> {
    let mut table = Table::new("courses", 2, &["finished %", "m/s"]);
    let ms = |time: u32| Some(Micros::from_millis(time));
    // What the candidates of courses below 2,000 said.
    let chosen = flow("flow, every echo, LEAST 4", Votes::EveryEcho, ms(4), ms(36));
    let mut methods = if asked.tune { candidates() } else { usual() };
    methods.extend((!asked.tune).then_some(chosen));
    methods.push(Entry::new("eeruf", Method::Eeruf));
    for speed_max_m_s in [1.0, 2.0] {
        for (place, second_robot) in [("alone", None), ("behind", Some(SECOND_BEHIND)), ("ahead", Some(SECOND_AHEAD))] {
            let options = SetTwoOptions {
                seeds: asked.count,
                first: asked.first,
                methods: methods.clone(),
                second_robot,
                labmate: LabMate { speed_max_m_s, ..LabMate::default() },
                pilots: Pilots::Shared,
                ..SetTwoOptions::default()
            };
            let found = set_two(&options, &|_| true)?;
            for ((name, of), runs) in found.methods.iter().zip(&found.runs) {
                let finished =
                    Cell::new(100.0 * of.finished as f64 / of.courses as f64, of.finished_95.map(|of| 100.0 * of));
                let speed = Cell::mean(runs.iter().map(|run| run.way_m / run.time_s));
                table.row(format!("{speed_max_m_s} m/s, {place}"), name, vec![finished, speed]);
            }
        }
    }
    Ok(table)
}
