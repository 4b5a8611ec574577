#![allow(missing_docs)]
use eeruf_core::search::design::*;
fn main() {
    let n = 4;
    for a in std::env::args().skip(1) {
        let w: Vec<&str> = a.split(' ').collect();
        let k: usize = w[0].parse().unwrap();
        let ring = w[1] == "ring";
        let num = |i: usize| w[i].parse::<u32>().unwrap();
        let (r, t, seeds) = (num(2), num(3), num(4));
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
        let p =
            Problem { sensors: k, conflicts: &conflicts, separation: 2, interval: 15, window: r, stale_echo: false };
        let mut memory = vec![0; memory_words(k) * 4];
        print!("{a}:");
        for (m, fo) in [(6, 0), (6, 4), (6, 6), (6, 7), (6, 8), (12, 7)] {
            let begin = std::time::Instant::now();
            let (f, nodes) = probe(&p, t, &mut memory, u64::from(seeds * 24 / m.max(6)), k as u64 * u64::from(m), fo);
            let ms = begin.elapsed().as_secs_f64() * 1e3;
            print!(
                "  {},{fo}: {f} in {nodes} = {:.0} nodes {:.0} ms;",
                m,
                nodes as f64 / f.max(1) as f64,
                ms / f.max(1) as f64
            );
        }
        println!();
    }
}
