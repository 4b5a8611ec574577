#![allow(missing_docs)]
use eeruf_core::search::design::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let k: usize = args[1].parse().unwrap();
    let ring = args[2] == "ring";
    let num = |i: usize| args[i].parse::<u32>().unwrap();
    let (r, t, budget) = (num(3), num(4), num(5) as u64);
    let seeds: u64 = args.get(6).map_or(0, |s| s.parse().unwrap());
    let scale: u32 = args.get(7).map_or(1, |s| s.parse().unwrap());
    let n = 4;
    let conflicts: Vec<u64> = (0..k).map(|x| (0..k).filter(|&y| { let g = x.abs_diff(y); let g = if ring { g.min(k - g) } else { g }; g > 0 && g < n }).fold(0, |s, y| s | 1 << y)).collect();
    let p = Problem { sensors: k, conflicts: &conflicts, separation: 2 * scale, interval: 15 * scale, window: r * scale, stale_echo: false };
    let mut memory = vec![0; words(k) * 4];
    for seed in 0..=seeds {
        let begin = std::time::Instant::now();
        let (o, nodes, a, b) = probe(&p, t, &mut memory, if seed > 0 { Some(seed) } else { None }, budget);
        println!("{k} {} R={r} T={t} seed {seed}: {} nodes {nodes} {:?}", args[2], ["spent", "exhausted", "found"][(o + 1) as usize], begin.elapsed());
        if o == 1 { println!("{:?} {:?}", &a[..k], &b[..k]); break; }
        if o == 0 { break; }
    }
}
