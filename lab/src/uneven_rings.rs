//! Prints random rings of 16 to 32 sensors that differ, and the engine's results, for `benches/peers/cpsat.py`: `cargo
//! lab uneven-rings [RINGS [SECONDS [FIRST]]]`, where FIRST is the first seed. Each line of JSON gives, in ticks, the
//! problem, period and bound, the processor time in seconds, and each period found with the seconds until then.

use eeruf_period::engine::Problem;
use eeruf_period::engine::shortest::shortest;
use serde_json::json;

use crate::clock::core_seconds;

/// A generator of pseudo-random numbers, the same on every machine (xorshift64*).
struct Random(u64);

impl Random {
    /// Draws a number from `least` to `most`.
    fn within(&mut self, least: u32, most: u32) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        least + ((self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) % u64::from(most - least + 1)) as u32
    }
}

/// Draws a ring: two to four neighbours, 15 ticks apart except one pair in four, windows of 15 to 45 ticks, separations
/// of 1 to 3.
fn draw(seed: u64) -> Problem {
    let mut random = Random(seed);
    (0..10).for_each(|_| _ = random.within(0, 1));
    let (sensors, neighbours) = (random.within(16, 32) as usize, random.within(2, 4) as usize);
    let is_ring = random.within(0, 1) == 1;
    let mut gaps = Vec::new();
    for x in 0..sensors {
        for y in x + 1..sensors {
            if y - x < neighbours || is_ring && sensors - (y - x) < neighbours {
                let gap = if random.within(0, 3) == 0 { random.within(10, 20) } else { 15 };
                gaps.push((x, y, gap, gap));
            }
        }
    }
    Problem {
        tick_us: (1000, 1),
        separation: (0..sensors).map(|_| random.within(1, 3)).collect(),
        window: (0..sensors).map(|_| random.within(15, 45)).collect(),
        stale_echo: false,
        together: Vec::new(),
        gaps,
    }
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let rings: u64 = arguments.first().map_or(Ok(20), |text| text.parse())?;
    let seconds: f64 = arguments.get(1).map_or(Ok(60.0), |text| text.parse())?;
    let first: u64 = arguments.get(2).map_or(Ok(20_000), |text| text.parse())?;
    for seed in first..first + rings {
        let problem = draw(seed);
        let (begin, mut steps) = (core_seconds(), Vec::<(f64, u32)>::new());
        let mut step = |period: u32| {
            let since = core_seconds() - begin;
            if steps.last().is_none_or(|(_, last)| period < *last) {
                steps.push((since, period));
            }
            since
        };
        let found = shortest(&problem, u64::MAX, &mut |so_far| step(so_far.best) < seconds);
        let found = found.ok_or("no schedule")?;
        let seconds = step(found.period);
        let Problem { separation, window, gaps, .. } = &problem;
        let (period, bound) = (found.period, found.bound);
        println!(
            "{}",
            json!({"separation": separation, "window": window, "gaps": gaps, "period": period,
                              "bound": bound, "seconds": seconds, "steps": steps})
        );
    }
    Ok(())
}
