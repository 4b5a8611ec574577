#![allow(missing_docs)]
use eeruf_core::search::design::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let k: usize = args[1].parse().unwrap();
    let ring = args[2] == "ring";
    let num = |i: usize| args[i].parse::<u32>().unwrap();
    let (r, t, budget) = (num(3), num(4), num(5) as u64);
    let scale: u32 = args.get(6).map_or(1, |s| s.parse().unwrap());
    let n = 4;
    let conflicts: Vec<u64> = (0..k)
        .map(|x| {
            (0..k)
                .filter(|&y| {
                    let g = x.abs_diff(y);
                    let g = if ring { g.min(k - g) } else { g };
                    g > 0 && g < n
                })
                .fold(0, |s, y| s | 1 << y)
        })
        .collect();
    let p = Problem {
        sensors: k,
        conflicts: &conflicts,
        separation: 2 * scale,
        interval: 15 * scale,
        window: r * scale,
        stale_echo: false,
    };
    let mut memory = vec![0; memory_words(k) * 4];
    let begin = std::time::Instant::now();
    let d = decide(&p, t, budget, &mut memory, &mut ()).unwrap();
    println!(
        "{k} {} R={r} T={t}: {} nodes {} {:?}",
        args[2],
        match d.answer {
            Answer::Found(_) => "found",
            Answer::Exhausted => "exhausted",
            Answer::BudgetSpent => "spent",
        },
        d.nodes,
        begin.elapsed()
    );
}
