//! The filter compared with a naive one that keeps all firings and applies the rule directly.

use arbitrary::Arbitrary;
use eeruf_core::{EchoFilter, Micros, ReadingKind};

/// Largest number of echoes per firing in this test.
const ECHOES: usize = 3;

/// Random input.
#[derive(Arbitrary, Debug)]
pub struct Firings {
    t_delta: u16,
    consecutive: u8,
    firings: Vec<Firing>,
}

#[derive(Arbitrary, Debug)]
enum Firing {
    /// Echoes near 10 ms, so that some are near-identical.
    Near([Option<u16>; ECHOES], i16),
    /// Any echo.
    Any(Option<u32>, i32),
    Forget,
}

/// One firing as the naive filter remembers it: its sorted echoes, and the change expected for it.
#[derive(Clone, Debug)]
struct Heard {
    echoes: Vec<u32>,
    expected: i32,
}

/// Returns true if `echo` is near-identical to `previous` after subtracting the expected change (Eq. 11).
fn near(t_delta: u16, echo: u32, previous: u32, expected: i32) -> bool {
    (i128::from(echo) - i128::from(previous) - i128::from(expected)).abs() <= i128::from(t_delta)
}

/// Returns the length of the longest run of firings that ends with `echo` in the last one, in which each firing has an
/// echo near-identical to one of the previous firing.
fn run(t_delta: u16, firings: &[Heard], echo: u32) -> usize {
    let [before @ .., last] = firings else { return 0 };
    let previous = before.last().map_or(&[][..], |heard| &heard.echoes);
    let longest = previous.iter().filter(|&&previous| near(t_delta, echo, previous, last.expected));
    1 + longest.map(|&previous| run(t_delta, before, previous)).max().unwrap_or(0)
}

/// Returns the expected verdict of the filter: the kind and the echo time.
fn naive(t_delta: u16, consecutive: usize, firings: &[Heard]) -> (ReadingKind, Option<u32>) {
    // Only this many firings matter, and a run through more of them branches.
    let firings = &firings[firings.len().saturating_sub(consecutive)..];
    let Some((last, before)) = firings.split_last() else { unreachable!("there is a firing") };
    if last.echoes.is_empty() {
        let silent = firings.iter().rev().take_while(|heard| heard.echoes.is_empty()).count();
        return (if silent >= consecutive { ReadingKind::Clear } else { ReadingKind::NoEcho }, None);
    }
    let runs: Vec<usize> = last.echoes.iter().map(|&echo| run(t_delta, firings, echo)).collect();
    let first = |least: usize| runs.iter().position(|&run| run >= least).map(|place| last.echoes[place]);
    if let Some(accepted) = first(consecutive) {
        return (ReadingKind::Accepted, Some(accepted));
    }
    if let Some(repeated) = first(2) {
        return (ReadingKind::Repeated, Some(repeated));
    }
    let compared = before.last().is_some_and(|heard| !heard.echoes.is_empty());
    (if compared { ReadingKind::Rejected } else { ReadingKind::First }, last.echoes.first().copied())
}

/// Pushes all firings into both filters.
pub fn check(input: &Firings) {
    let consecutive = 2 + input.consecutive % 7;
    let t_delta = input.t_delta;
    let mut filter = EchoFilter::<2, ECHOES>::new(Micros::new(t_delta.into()), consecutive).expect("2 to 8");
    let (mut heard, mut age) = (Vec::new(), None);
    for firing in input.firings.iter().take(200) {
        let (echoes, expected) = match firing {
            Firing::Near(echoes, expected) => {
                (echoes.iter().flatten().map(|&echo| u32::from(echo)).collect(), i32::from(*expected))
            }
            // The longest time means no echo.
            Firing::Any(echo, expected) => (echo.iter().copied().filter(|&echo| echo < u32::MAX).collect(), *expected),
            Firing::Forget => {
                filter.forget(1).expect("there is a sensor 1");
                heard.clear();
                continue;
            }
        };
        let mut echoes: Vec<u32> = echoes;
        let pushed: Vec<Micros> = echoes.iter().map(|&echo| Micros::new(echo)).collect();
        let verdict = filter.push_echoes(1, &pushed, expected).expect("there is a sensor 1");
        echoes.sort_unstable();
        heard.push(Heard { echoes, expected });
        let (kind, t_echo) = naive(t_delta, consecutive.into(), &heard);
        assert_eq!(
            (verdict.kind, verdict.t_echo),
            (kind, t_echo.map(Micros::new)),
            "{t_delta} {consecutive} {heard:?}"
        );
        age = match age {
            _ if kind == ReadingKind::Accepted => Some(0),
            Some(age) => Some(age + 1),
            None => None,
        };
        assert_eq!(verdict.age, age);
        if kind == ReadingKind::Accepted {
            let previous = verdict.previous.expect("it was compared").as_micros();
            let before = &heard[heard.len() - 2].echoes;
            assert!(before.contains(&previous));
            assert!(near(t_delta, t_echo.expect("it is an echo"), previous, expected));
        }
        // The other sensor is not affected.
        assert_eq!(filter.push(0, None).map(|verdict| verdict.t_echo), Ok(None));
    }
}
