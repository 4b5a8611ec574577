//! Prints the table of shortest periods with what each cost: `cargo run --release --example shortest_periods
//! [ticks-per-ms] [separation-ms] [sensors,..] [neighbours] [layout,..] [budget] [window-ms,..]`; without arguments the
//! table of `docs/explanation/search.md`, 8 to 24 sensors in a line and in a ring.
//!
//! The columns are read by `benches/peers/design_cpsat.py`; keep them in step.

use std::time::Instant;

use eeruf_core::Layout;
use eeruf_core::search::design::{Problem, memory_words, shortest};

fn list<T: std::str::FromStr>(text: &str) -> Vec<T> {
    text.split(',').filter_map(|item| item.parse().ok()).collect()
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let argument = |i: usize, default: &'static str| arguments.get(i).map_or(default, String::as_str).to_owned();
    let ticks = list::<u32>(&argument(0, "1"))[0];
    let separation = list::<u32>(&argument(1, "2"))[0] * ticks;
    let neighbours = list::<u8>(&argument(3, "4"))[0];
    let budget = list::<u64>(&argument(5, "100000000"))[0];
    let windows = list::<u32>(&argument(6, "15,30,45,60"));
    println!("layout sensors window period bound nodes milliseconds reason");
    let (mut times, begin) = (Vec::new(), Instant::now());
    for layout in list::<String>(&argument(4, "line,ring")) {
        for sensors in list::<usize>(&argument(2, "8,12,16,24")) {
            let rows = match layout.as_str() {
                "ring" => Layout::Ring(neighbours),
                "blocks" => Layout::Blocks(neighbours),
                _ => Layout::Line(neighbours),
            }
            .rows(sensors);
            let mut memory = vec![0; memory_words(sensors)];
            for &window in &windows {
                let problem = Problem {
                    sensors,
                    conflicts: &rows[..sensors],
                    separation,
                    interval: 15 * ticks,
                    window: window * ticks,
                    stale_echo: false,
                };
                let begin = Instant::now();
                let found = shortest(&problem, budget, &mut memory, &mut ()).expect("the table makes sense");
                let milliseconds = begin.elapsed().as_secs_f64() * 1e3;
                times.push(milliseconds);
                println!(
                    "{layout} {sensors} {window} {} {} {} {milliseconds:.2} {}",
                    found.period, found.bound, found.nodes, found.explanation
                );
            }
        }
    }
    times.sort_by(f64::total_cmp);
    println!(
        "# median {:.2} ms, longest {:.2} ms, all {:.3} s",
        times[times.len() / 2],
        times[times.len() - 1],
        begin.elapsed().as_secs_f64()
    );
}
