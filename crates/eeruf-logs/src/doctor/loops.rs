//! A loop that waits for each echo before it fires the next sensor is a schedule: foreign sound on a path of its own
//! makes the sum of two readings constant, and the second bounce of a sensor's own sound their difference.

use super::series::Scatter;

/// A sensor that reads another's sound in most rounds, judging by sums or differences.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Looped {
    pub(crate) sender: usize,
    pub(crate) receiver: usize,
    /// True if the difference is constant instead of the sum.
    pub(crate) is_difference: bool,
    /// The share of the rounds in which the value is constant.
    pub(crate) share: f64,
    pub(crate) rounds: usize,
    /// The range of the sender's readings in those rounds, in microseconds.
    pub(crate) spread_us: f64,
}

/// Number of rounds below which nothing is concluded.
const FEWEST: usize = 60;
/// Least share of rounds with a constant sum, and its least ratio to the share found with readings of other rounds.
const STAYS: f64 = 0.3;
const BY_CHANCE: f64 = 2.0;
/// Least movement of the readings meanwhile, in half widths of the tolerance for equal sums.
const MOVES: f64 = 8.0;
/// Largest number of sensors in one loop, and of rows examined.
const MOST_SENSORS: usize = 16;
const MOST_ROWS: usize = 1 << 16;

/// The largest number of values within an interval of this width, and where it begins.
fn crowd(mut values: Vec<f64>, width: f64) -> (usize, f64) {
    values.sort_by(f64::total_cmp);
    let (mut from, mut most) = (0, (0, 0.0));
    for (to, value) in values.iter().enumerate() {
        while value - values[from] > width {
            from += 1;
        }
        if to - from + 1 > most.0 {
            most = (to - from + 1, values[from]);
        }
    }
    most
}

/// Pairs of sensors in which one reads the other's sound, at most one for each pair; `rows` are all readings in order.
pub(crate) fn looped(rows: &[(usize, f64)], scatter: &[Scatter]) -> Vec<Looped> {
    let sensors = scatter.len();
    let rows = &rows[..rows.len().min(MOST_ROWS)];
    let mut found: Vec<Looped> = vec![];
    if !(2..=MOST_SENSORS).contains(&sensors) {
        return found;
    }
    let most_us = scatter.iter().map(|of| of.us).fold(0.0, f64::max);
    for back in 1..sensors {
        // By pair: the receiver's reading with those between the two, and the sender's.
        let mut pairs = vec![vec![]; sensors * sensors];
        for of in rows.windows(back + 1) {
            let ((sender, sent), (receiver, heard)) = (of[0], of[back]);
            let between: f64 = of[1..back].iter().map(|row| row.1).sum();
            if sender != receiver && !(heard + between + sent).is_nan() {
                pairs[sender * sensors + receiver].push((heard + between, sent));
            }
        }
        for (pair, values) in pairs.iter().enumerate().filter(|(_, values)| values.len() >= FEWEST) {
            let (sender, receiver, n) = (pair / sensors, pair % sensors, values.len());
            let half = 3.0 * scatter[sender].us.hypot(scatter[receiver].us) + 2.1 * (back - 1) as f64 * most_us;
            let half = half.max(45.0);
            for sign in [1.0, -1.0] {
                let with = |shift: usize| (0..n).map(|k| values[k].0 + sign * values[(k + shift) % n].1).collect();
                let (count, from) = crowd(with(0), 2.0 * half);
                let share = count as f64 / n as f64;
                let is_known = found.iter().any(|of| {
                    [(of.sender, of.receiver), (of.receiver, of.sender)].contains(&(sender, receiver))
                        && of.share >= share
                });
                if share < STAYS || is_known {
                    continue;
                }
                let chance = [5, 3, 2].map(|part| crowd(with(n / part), 2.0 * half).0).into_iter().max().unwrap_or(0);
                let is_in = |&&(heard, sent): &&(f64, f64)| (from..=from + 2.0 * half).contains(&(heard + sign * sent));
                let mut moved: Vec<f64> = values.iter().filter(is_in).map(|value| value.1).collect();
                moved.sort_by(f64::total_cmp);
                let spread_us = moved[moved.len() * 19 / 20] - moved[moved.len() / 20];
                if count as f64 >= BY_CHANCE * chance as f64 && spread_us >= MOVES * half {
                    found.retain(|of| ![(sender, receiver), (receiver, sender)].contains(&(of.sender, of.receiver)));
                    let is_difference = sign < 0.0;
                    found.push(Looped { sender, receiver, is_difference, share, rounds: n, spread_us });
                }
            }
        }
    }
    found
}
