//! Times the search for the shortest period: the theory's table, the same in finer ticks, and a ring file.

use eeruf_benches::{design_of_file, time};
use eeruf_core::Layout;
use eeruf_period::engine::Problem;
use eeruf_period::engine::shortest::shortest;

fn main() {
    time("design of a ring file of 12, from the atlas", 1, design_of_file);
    for (name, ticks) in [("1 ms", 1), ("0.1 ms", 10)] {
        for sensors in [8, 12, 16, 24] {
            for layout in [Layout::Line(4), Layout::Ring(4)] {
                let rows = layout.rows(sensors);
                for window in [15, 30, 45, 60] {
                    let problem = Problem::alike(&rows[..sensors], 2 * ticks, 15 * ticks, window * ticks);
                    let name = format!("{sensors} sensors, {layout}, window {window} ms, ticks of {name}");
                    time(&name, 1, || shortest(&problem, u64::MAX, &mut |_| true));
                }
            }
        }
    }
}
