//! Random problems, a brute force that knows only the definition, and the checker of certificates.
#![allow(dead_code)]

use eeruf_period::engine::{Claim, Problem};
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The checker of certificates, `checker/check_period.py`.
pub(crate) fn checker() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../checker/check_period.py")
}

/// The verdict of a checker on each certificate, all in one process: its claim, or `refused: line N: why`. The name is
/// that of a folder for the files.
pub(crate) fn verdicts_of(checker: &Path, name: &str, certificates: &[String]) -> Vec<String> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).expect("the folder can be made");
    let mut python = Command::new("python3");
    python.arg(checker).arg("-").current_dir(&folder).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut python = python.spawn().expect("python3 runs");
    let mut names = python.stdin.take().expect("it reads names");
    for (number, text) in certificates.iter().enumerate() {
        fs::write(folder.join(number.to_string()), text).expect("the folder can be written to");
        writeln!(names, "{number}").expect("it reads names");
    }
    // One more, so that there are several and each line has its file's name.
    fs::write(folder.join("end"), "").expect("the folder can be written to");
    writeln!(names, "end").expect("it reads names");
    drop(names);
    let done = python.wait_with_output().expect("python3 ends");
    let said = String::from_utf8(done.stdout).expect("it writes text");
    let verdict = |(number, line): (usize, &str)| {
        let name = format!("{number}: ");
        assert_eq!(line.trim_start_matches("refused: ").find(&name), Some(0), "{line}");
        line.replacen(&name, "", 1)
    };
    let verdicts: Vec<String> = said.lines().take(certificates.len()).enumerate().map(verdict).collect();
    assert_eq!((verdicts.len(), done.status.code()), (certificates.len(), Some(1)), "{said}");
    verdicts
}

/// Checks that the checker accepts all these certificates, and returns its words for their claims.
pub(crate) fn accepted(name: &str, certificates: &[String]) -> Vec<String> {
    let verdicts = verdicts_of(&checker(), name, certificates);
    for (verdict, text) in verdicts.iter().zip(certificates) {
        assert!(!verdict.starts_with("refused"), "{name}: {verdict}\n{text}");
    }
    verdicts
}

/// The claim of a certificate that the checker accepted: its head.
pub(crate) fn claim_of(certificate: &str) -> Claim {
    let row = |line: &str| -> Vec<u32> {
        line.split(' ').skip(1).map(|number| number.parse().expect("the checker read it")).collect()
    };
    let rows = |word: &str| -> Vec<Vec<u32>> {
        certificate.lines().filter(|line| line.split(' ').next() == Some(word)).map(row).collect()
    };
    let one = |word: &str| rows(word).swap_remove(0);
    let group = |group: Vec<u32>| group.into_iter().map(|sensor| sensor as usize).collect();
    let problem = Problem {
        tick_us: (one("tick_us")[0], one("tick_us")[1]),
        separation: one("separation"),
        window: one("window"),
        stale_echo: one("stale_echo") == [1],
        together: rows("together").into_iter().map(group).collect(),
        gaps: rows("gap").iter().map(|gap| (gap[0] as usize, gap[1] as usize, gap[2], gap[3])).collect(),
    };
    let fire = [one("fire_a"), one("fire_b")];
    Claim { problem, period: one("period")[0], fire, bound: one("no_period_below")[0] }
}

/// Approximate number of nodes of a certificate's tree: two for each branching, or as many as sensors for `next`.
pub(crate) fn nodes_of(certificate: &str) -> usize {
    let sensors = claim_of(certificate).problem.sensors();
    let nodes = |line: &str| match line.split(' ').next() {
        Some("a" | "b" | "sign" | "rank" | "split") => 2,
        Some("next") => sensors,
        _ => 0,
    };
    certificate.lines().map(nodes).sum::<usize>() + 1
}

/// The certificates that the checker reads quickly; `EERUF_NODES` sets how many nodes they may have.
pub(crate) fn small(certificates: Vec<String>) -> Vec<String> {
    let most = from_environment("EERUF_NODES", 500);
    let all = certificates.len();
    let small: Vec<String> = certificates.into_iter().filter(|text| nodes_of(text) as u64 <= most).collect();
    println!("{} of {all} certificates have at most {most} nodes and are checked", small.len());
    assert!(!small.is_empty(), "none of {all} certificates has at most {most} nodes");
    small
}

/// A number from the environment, or its default.
pub(crate) fn from_environment(name: &str, usual: u64) -> u64 {
    std::env::var(name).map_or(usual, |number| number.parse().expect("a number"))
}

/// A small generator of pseudo-random numbers, the same on every machine (xorshift64*).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// A number below `end`.
    pub(crate) fn below(&mut self, end: u32) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        ((self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) % u64::from(end)) as u32
    }

    /// A number from 0 to this.
    pub(crate) fn up_to(&mut self, most: u32) -> u32 {
        self.below(most + 1)
    }

    /// Returns true once in `n` calls, at random.
    pub(crate) fn once_in(&mut self, n: u32) -> bool {
        self.below(n) == 0
    }
}

/// A tiny random problem: even or uneven, sometimes with shared lines, groups and stale echoes.
pub(crate) fn random_problem(random: &mut Random) -> Problem {
    for _ in 0..10 {
        random.below(2);
    }
    let sensors = 2 + random.below(3) as usize;
    let is_even = random.once_in(3);
    let (separation, window, interval) = (1 + random.below(3), 1 + random.below(5), 1 + random.below(3));
    let pick = |random: &mut Random, most: u32, all: u32| if is_even { all } else { 1 + random.below(most) };
    let separation: Vec<u32> = (0..sensors).map(|_| pick(random, 3, separation)).collect();
    let window: Vec<u32> = (0..sensors).map(|_| pick(random, 5, window)).collect();
    let mut together = Vec::new();
    if random.once_in(3) && sensors > 2 {
        let first = random.below(sensors as u32 - 1) as usize;
        together.push(vec![first, first + 1 + random.below((sensors - first - 1) as u32) as usize]);
        if sensors == 4 && random.once_in(3) {
            together.push((0..4).filter(|sensor| !together[0].contains(sensor)).collect());
        }
    }
    let mut gaps = Vec::new();
    for x in 0..sensors {
        for y in x + 1..sensors {
            let joined = together.iter().any(|group: &Vec<usize>| group.contains(&x) && group.contains(&y));
            if joined || random.once_in(4) {
                continue;
            }
            if !is_even && random.once_in(4) {
                // A shared line: neither listens while the other does.
                gaps.push((x, y, window[x], window[y]));
            } else {
                let gap = pick(random, 3, interval);
                gaps.push((x, y, gap, gap));
            }
        }
    }
    Problem { tick_us: (1, 1), separation, window, stale_echo: random.once_in(3), together, gaps }
}

/// A schedule with this period, if there is one: all firing times are tried, sensor by sensor.
pub(crate) fn feasible(problem: &Problem, period: u32) -> Option<[Vec<u32>; 2]> {
    let mut fire: Vec<(u32, u32)> = Vec::new();
    extend(problem, period, &mut fire)
        .then(|| [fire.iter().map(|times| times.0).collect(), fire.iter().map(|times| times.1).collect()])
}

fn extend(problem: &Problem, period: u32, fire: &mut Vec<(u32, u32)>) -> bool {
    if fire.len() == problem.sensors() {
        return true;
    }
    for a in 0..period {
        for b in 0..period {
            fire.push((a, b));
            if last_fits(problem, period, fire) && extend(problem, period, fire) {
                return true;
            }
            fire.pop();
        }
    }
    false
}

/// Returns true if the last sensor meets the definition, by itself and with all before it.
fn last_fits(problem: &Problem, period: u32, fire: &[(u32, u32)]) -> bool {
    let y = fire.len() - 1;
    let d = |x: usize| i64::from(fire[x].0) - i64::from(fire[x].1);
    if i64::from(period) - d(y).abs() < i64::from(problem.window[y]) {
        return false;
    }
    if problem.stale_echo && 2 * d(y).abs() < i64::from(problem.separation[y]) {
        return false;
    }
    (0..y).all(|x| {
        let joined = problem.together.iter().any(|group| group.contains(&x) && group.contains(&y));
        let needed = i64::from(problem.separation[x].max(problem.separation[y]));
        let apart = if joined { fire[x] == fire[y] } else { (d(x).abs() - d(y).abs()).abs() >= needed };
        apart && gaps_fit(problem, period, fire, x, y)
    })
}

/// Returns true if two sensors keep their gaps: it lays out five periods of both on one line of time, and checks what
/// follows each firing.
fn gaps_fit(problem: &Problem, period: u32, fire: &[(u32, u32)], x: usize, y: usize) -> bool {
    let line = |x: usize| -> Vec<u32> {
        (0..5).map(|n| n * period + if n % 2 == 0 { fire[x].0 } else { fire[x].1 }).collect()
    };
    let Some(&(_, _, after_x, after_y)) = problem.gaps.iter().find(|gap| (gap.0, gap.1) == (x, y)) else {
        return true;
    };
    let clear = |first: &[u32], second: &[u32], gap: u32| {
        first.iter().all(|&one| second.iter().all(|&other| other < one || other >= one + gap))
    };
    clear(&line(x), &line(y), after_x) && clear(&line(y), &line(x), after_y)
}

/// The claims of tests/data/shortest-periods.json with their names; all times multiplied by `scale`.
pub(crate) fn table(scale: u32) -> Vec<(String, Claim)> {
    let text = include_str!("../../../../tests/data/shortest-periods.json");
    text.split("{\"sensors\"").skip(1).map(|case| claim(&format!("\"sensors\"{case}"), scale)).collect()
}

fn claim(case: &str, scale: u32) -> (String, Claim) {
    let value = |key: &str| case.split(&format!("\"{key}\": ")).nth(1).expect("the key is there");
    let number = |key: &str| -> u32 {
        let digits: String = value(key).chars().take_while(char::is_ascii_digit).collect();
        digits.parse().expect("a number")
    };
    let row = |key: &str| -> Vec<u32> {
        let list = value(key)[1..].split(']').next().expect("a list");
        list.split(", ").map(|number| scale * number.parse::<u32>().expect("a number")).collect()
    };
    let (sensors, neighbours) = (number("sensors") as usize, number("neighbours") as usize);
    let layout = &value("layout")[1..5];
    let interval = scale * number("min_interval");
    let pairs = (0..sensors).flat_map(|x| (x + 1..sensors).map(move |y| (x, y)));
    let near = |x: usize, y: usize| y - x < neighbours || layout == "ring" && sensors - (y - x) < neighbours;
    let problem = Problem {
        tick_us: (number("tick_us"), scale),
        separation: vec![scale * number("separation"); sensors],
        window: vec![scale * number("window"); sensors],
        stale_echo: false,
        together: Vec::new(),
        gaps: pairs.filter(|&(x, y)| near(x, y)).map(|(x, y)| (x, y, interval, interval)).collect(),
    };
    let period = scale * number("period");
    let name = format!("{layout} {sensors}, window {}", number("window"));
    (name, Claim { problem, period, fire: [row("fire_a"), row("fire_b")], bound: period })
}
