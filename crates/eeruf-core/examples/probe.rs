#![allow(missing_docs)]
use eeruf_core::search::design::*;
fn conflicts(k: usize, n: usize, layout: &str) -> Vec<u64> {
    (0..k)
        .map(|x| {
            (0..k)
                .filter(|&y| {
                    let g = x.abs_diff(y);
                    let g = if layout == "ring" { g.min(k - g) } else { g };
                    if layout == "blocks" { x != y && x / n == y / n } else { g > 0 && g < n }
                })
                .fold(0, |s, y| s | 1 << y)
        })
        .collect()
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let scale: u32 = args.get(1).map_or(1, |s| s.parse().unwrap());
    let d: u32 = args.get(2).map_or(2, |s| s.parse().unwrap());
    let ks: Vec<usize> =
        args.get(3).map_or(vec![8, 12, 16, 24], |s| s.split(',').map(|s| s.parse().unwrap()).collect());
    let n: usize = args.get(4).map_or(4, |s| s.parse().unwrap());
    let stale = args.get(5).is_some_and(|s| s == "stale");
    let layouts = args.get(6).map_or("line,ring", |s| s);
    let mut total = 0.0;
    for layout in layouts.split(',') {
        for &k in &ks {
            for r in [15, 30, 45, 60] {
                let c = conflicts(k, n, layout);
                let p = Problem {
                    sensors: k,
                    conflicts: &c,
                    separation: d * scale,
                    interval: 15 * scale,
                    window: r * scale,
                    stale_echo: stale,
                };
                let mut memory = vec![0; memory_words(k)];
                let begin = std::time::Instant::now();
                let s = shortest(&p, 10_000_000, &mut memory, &mut ()).unwrap();
                let t = begin.elapsed().as_secs_f64();
                total += t;
                println!(
                    "{k:2} {layout} R={r} T={}{} nodes {:6} {:.1} ms {:?}",
                    s.period,
                    if s.proven() { "".into() } else { format!(" (>= {})", s.bound) },
                    s.nodes,
                    t * 1e3,
                    s.reason
                );
            }
        }
    }
    println!("total {total:.3} s");
}
