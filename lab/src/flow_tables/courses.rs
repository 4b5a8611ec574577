//! Set II: courses among poles, alone, with another robot behind, and with one ahead.

use eeruf_core::SpeedOfSound;
use eeruf_core::flow::{BeliefSettings, Votes};
use eeruf_design::needs_to_see_m;
use eeruf_sim::experiments::set_two::{Pilots, SECOND_AHEAD, SECOND_BEHIND, SetTwoOptions, set_two};
use eeruf_sim::{Entry, FlowOptions, LabMate, Method};

use super::{Asked, Cell, Table, usual};

/// Returns flow as `eeruf design` sets it for a ring at this speed.
fn designed(speed_m_s: f64) -> Entry {
    let reach = needs_to_see_m(speed_m_s).map(|m| SpeedOfSound::default().echo_time((1e3 * m).round() as u32));
    let mut options = FlowOptions::default();
    let belief = BeliefSettings { votes: Votes::TwoInARow, ..BeliefSettings::DEFAULT };
    (options.belief, options.window) = (Some(belief), reach);
    Entry::new("flow as designed", Method::Flow).with_flow(options)
}

pub(super) fn table(asked: &Asked) -> Result<Table, Box<dyn std::error::Error>> {
    let mut table = Table::new("courses", 2, &["finished %", "m/s"]);
    for speed_max_m_s in [1.0, 2.0] {
        for (place, second_robot) in [("alone", None), ("behind", Some(SECOND_BEHIND)), ("ahead", Some(SECOND_AHEAD))] {
            let mut methods = usual();
            methods.extend([designed(speed_max_m_s), Entry::new("eeruf", Method::Eeruf)]);
            let options = SetTwoOptions {
                seeds: asked.count,
                first: asked.first,
                methods,
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
