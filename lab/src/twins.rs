//! Cost of the table of `docs/explanation/search.md` for core's search of even rings and for the engine, and where one
//! limit of one sensor or pair is a tick more or less: `cargo lab twins [SECONDS]`, for each ring at most. Times are
//! those of a core.

use eeruf_core::Layout;
use eeruf_core::search::design::{self, memory_words};
use eeruf_design::engine::Problem;
use eeruf_design::engine::shortest::shortest;

use crate::clock::core_seconds;

const KINDS: [&str; 7] = ["even", "window +", "window -", "gap +", "gap -", "separation +", "separation -"];

fn twin(even: &Problem, kind: &str) -> Problem {
    let mut twin = even.clone();
    let (middle, pair) = (even.sensors() / 2, even.gaps.len() / 2);
    match kind {
        "window +" => twin.window[0] += 1,
        "window -" => twin.window[middle] -= 1,
        "gap +" => (twin.gaps[0].2, twin.gaps[0].3) = (16, 16),
        "gap -" => (twin.gaps[pair].2, twin.gaps[pair].3) = (14, 14),
        "separation +" => twin.separation[0] += 1,
        "separation -" => twin.separation[middle] -= 1,
        _ => {}
    }
    twin
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let seconds: f64 = arguments.first().map_or(Ok(10.0), |text| text.parse())?;
    println!("layout sensors window | core: period nodes ms | {}: period[bound] nodes ms", KINDS.join(", "));
    // Of each kind: seconds, open rings, and the logarithms of the times to core's, where 20 ms is the least.
    let mut sums = [(0.0, 0, 0.0); KINDS.len()];
    let (mut rings, mut worst) = (0, [0.0_f64; KINDS.len()]);
    for layout in ["line", "ring"] {
        for (sensors, window) in [8, 12, 16, 24].iter().flat_map(|&k| [15, 30, 45, 60].map(|window| (k, window))) {
            let rows = if layout == "ring" { Layout::Ring(4) } else { Layout::Line(4) }.rows(sensors);
            let conflicts = &rows[..sensors];
            let problem =
                design::Problem { sensors, conflicts, separation: 2, interval: 15, window, stale_echo: false };
            let mut memory = vec![0; memory_words(sensors)];
            let begin = core_seconds();
            let found = design::shortest(&problem, u64::MAX, &mut memory, &mut ()).expect("the table makes sense");
            let core = (core_seconds() - begin) * 1e3;
            print!("{layout} {sensors} {window} | {} {} {core:.1}", found.period, found.nodes);
            let pairs = (0..sensors).flat_map(|x| (x + 1..sensors).map(move |y| (x, y)));
            let even = Problem {
                tick_us: (1000, 1),
                separation: vec![2; sensors],
                window: vec![window; sensors],
                stale_echo: false,
                over_reals: false,
                together: Vec::new(),
                gaps: pairs.filter(|&(x, y)| conflicts[x] >> y & 1 == 1).map(|(x, y)| (x, y, 15, 15)).collect(),
            };
            rings += 1;
            for (kind, (sum, worst)) in KINDS.iter().zip(sums.iter_mut().zip(&mut worst)) {
                let begin = core_seconds();
                let mut go_on = |_: &_| core_seconds() - begin < seconds;
                let found = shortest(&twin(&even, kind), u64::MAX, &mut go_on).expect("there is a schedule");
                let own = (core_seconds() - begin) * 1e3;
                let open = if found.bound < found.period { format!("[{}]", found.bound) } else { String::new() };
                print!(" | {}{open} {} {own:.1}", found.period, found.nodes);
                let floored = own.max(20.0) / core.max(20.0);
                let (all, left_open, ratios) = *sum;
                let left_open = left_open + u32::from(!open.is_empty());
                *sum = (all + own / 1e3, left_open, ratios + floored.ln());
                *worst = worst.max(floored);
            }
            println!();
        }
    }
    for (kind, ((all, open, ratios), worst)) in KINDS.iter().zip(sums.into_iter().zip(worst)) {
        println!(
            "# {kind}: {all:.2} s, {open} open; times core, less than 20 ms counts as 20: geometric mean {:.2}, \
             at most {worst:.1}",
            (ratios / f64::from(rings)).exp()
        );
    }
    Ok(())
}
