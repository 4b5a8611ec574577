//! The checker of certificates against nested loops over firing times: whatever claim it accepts is true.

use crate::common::{Random, accepted, checker, claim_of, feasible, from_environment, random_problem, verdicts_of};
use eeruf_period::engine::Claim;
use eeruf_period::engine::prove::{prove, prove_in_time};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A claim about a tiny problem, with a schedule by nested loops.
fn claim(seed: u64, longer: u32) -> Option<Claim> {
    let problem = random_problem(&mut Random(seed + 1));
    let most = if problem.sensors() <= 3 { 12 } else { 8 };
    let shortest = (1..=most).find(|&period| feasible(&problem, period).is_some())?;
    let period = shortest + longer;
    let fire = feasible(&problem, period)?;
    Some(Claim { problem, period, fire, bound: period })
}

/// Returns true if trying all firing times confirms the claim: the schedule keeps the needs, and no shorter period can.
fn holds(claim: &Claim) -> bool {
    let Claim { problem, bound, .. } = claim;
    claim.check().is_ok() && (1..*bound).all(|period| feasible(problem, period).is_none())
}

/// The certificate with one to three lines mutated: deleted, doubled, swapped, moved, cut, or a number changed by up to
/// two.
fn mutated(random: &mut Random, certificate: &str) -> String {
    let mut lines: Vec<String> = certificate.split('\n').map(str::to_owned).collect();
    for _ in 0..=random.below(3) {
        let count = lines.len() as u32;
        let [i, j] = [random.below(count) as usize, random.below(count) as usize];
        match random.below(10) {
            0 => _ = lines.remove(i),
            1 => lines.insert(i, lines[i].clone()),
            2 => lines.swap(i, j),
            3 => {
                let line = lines.remove(i);
                lines.insert(j.min(lines.len()), line);
            }
            4 => lines.truncate(i + 1),
            _ => {
                let mut words: Vec<String> = lines[i].split(' ').map(str::to_owned).collect();
                let at = random.below(words.len() as u32) as usize;
                let change = [-2, -1, 1, 2][random.below(4) as usize];
                if let Ok(number) = words[at].parse::<i64>() {
                    words[at] = (number + change).max(0).to_string();
                }
                lines[i] = words.join(" ");
            }
        }
        if lines.is_empty() {
            break;
        }
    }
    lines.join("\n")
}

// Certificates of tiny problems, and mutated ones: whatever is accepted is true.
#[test]
fn accepted_claims_are_true_by_nested_loops() {
    let (first, cases) = (from_environment("EERUF_FIRST", 0), from_environment("EERUF_CASES", 1_000));
    let (mut certificates, mut proven) = (Vec::new(), 0);
    for seed in first..first + cases {
        let Some(claim) = claim(seed, 0) else { continue };
        let mut random = Random(seed + 1);
        let by = if seed % 2 == 0 { prove } else { prove_in_time };
        let Ok(text) = by(&claim, 10_000) else { continue };
        proven += 1;
        certificates.extend((0..4).map(|_| mutated(&mut random, &text)).filter(|other| *other != text));
        certificates.push(text);
        // An engine and a checker with the same fault would agree on a period that is too long.
        certificates.extend(self::claim(seed, 1).and_then(|longer| prove(&longer, 10_000).ok()));
    }
    let verdicts = verdicts_of(&checker(), "nested-loops", &certificates);
    let (mut judged, mut claims) = (0, BTreeSet::new());
    for text in
        certificates.iter().zip(&verdicts).filter(|(_, verdict)| !verdict.starts_with("refused")).map(|(text, _)| text)
    {
        let head = text.split("no_period_below").next().unwrap_or_default();
        let claim = claim_of(text);
        judged += 1;
        if claims.insert((head.to_owned(), claim.bound)) {
            assert!(holds(&claim), "a false claim was accepted:\n{text}");
        }
    }
    println!(
        "{proven} problems of {cases}, {} certificates, {judged} accepted, {} claims",
        verdicts.len(),
        claims.len()
    );
    // Tiny problems repeat, claims with them: of many, certificates are counted.
    assert!(2 * proven > cases && judged > proven, "mutated claims are accepted too");
}

/// Rules of the checker made too strong: the replaced parts of its text.
const BROKEN: [(&str, &str, &str); 15] = [
    ("closure: a cycle of 0 is refuted", "self.bound(j, i) < 0:", "self.bound(j, i) <= 0:"),
    ("window: a tick more", "period - problem.R[x])", "period - problem.R[x] - 1)"),
    ("gap into the next phase: a tick more", "next_b, a, period - wait)", "next_b, a, period - wait - 1)"),
    (
        "stale echoes: a tick more",
        "(D + 1) // 2 * problem.stale_echo for",
        "((D + 1) // 2 + 1) * problem.stale_echo for",
    ),
    ("orders: after a gap that just fits", "min(least, zero) + zero <<", "min(least + 1, zero) + zero <<"),
    ("orders: reversed in the same phase", "[(i, j, m, k, p", "[(i, j, j, i, p"),
    (
        "signs: a d that can just be positive",
        "            if least > positive:",
        "            if least >= positive > 0:",
    ),
    ("ranks: a |d| that can just be larger", "pack([max(mine, own) for", "pack([max(mine, own) + 1 for"),
    ("ranks: a separation too many", "lanes.ones + narrowest - span &", "lanes.ones + narrowest - span - lanes.ones &"),
    (
        "spacing: an interval that just has room",
        "lanes.pack(low) + zero * ones)",
        "lanes.pack(low) + (zero + 1) * ones)",
    ),
    ("precedence: a separation too many", "bound - (span - D) for", "bound - span for"),
    ("branching: a d of 0 is left out", "(0, -1)  #", "(-1, -1)  #"),
    ("symmetry: another separation", "for row in (problem.separation, problem.window)", "for row in (problem.window,)"),
    (
        "symmetry: other gaps",
        "kept and all(gap[x][y] == gap[image[x]][image[y]] for x in every for y in every)",
        "kept",
    ),
    ("lanes: equal numbers are less", "return (p | self.top) - q &", "return (p | self.top) - q - self.ones &"),
];

/// Mutated rules of counting and of firings in the order of time.
const BROKEN_IN_TIME: [(&str, &str, &str); 16] = [
    ("sequence: a tick more", "apart + max(windows", "apart + 1 + max(windows"),
    ("one by one: no sensor follows itself", "sum(gap.values()) - again >", "sum(gap.values()) >"),
    ("one by one: a tick more", "- again > T", "- again >= T"),
    ("density: a tick more", "2 * at_once * T <", "2 * at_once * T <="),
    ("density: one too few at once", "2 * at_once * T < sum", "2 * (at_once - 1) * T < sum"),
    ("places: a tick more apart", "min(fits) + self.D\n", "min(fits) + self.D + 1\n"),
    ("places: a tick less room", "T - max(self.R, least[count - e])", "T - 1 - max(self.R, least[count - e])"),
    (
        "classes: a tick less room",
        "(high - max(low, self.least)) // self.D + 1",
        "(high - max(low, self.least)) // self.D",
    ),
    ("line: too many share a place", "else divmod(count, n)", "else (count // n + 1, 0)"),
    (
        "permutation: no place moves",
        "* (c > 0) for c in range(n)]\n    if any(",
        "* (c > 0) + (c == 0) for c in range(n)]\n    if any(",
    ),
    ("pace: a tick more", "- 2 * self.T * turns for turns", "- 2 * self.T * turns + 1 for turns"),
    (
        "cliques: gaps of some",
        "min(problem.G[x][y] for y in clique if y != x)",
        "max(problem.G[x][y] for y in clique if y != x)",
    ),
    ("next: those before at the same instant", "own, -(y < x))", "own, -1)"),
    ("next: others of the phase take too long", "period - 1 - least[", "period - 2 - least["),
    (
        "next: too far on",
        "2 * period - least[2 * size - steps] - since)",
        "2 * period - 1 - least[2 * size - steps] - since)",
    ),
    (
        "next: a sensor too few",
        "return [(Node.place, x) for x in left]",
        "return [(Node.place, x) for x in left[1:] or left]",
    ),
];

/// A copy of the checker with one text replaced.
fn broken(number: usize, from: &str, to: &str) -> PathBuf {
    let text = std::fs::read_to_string(checker()).expect("the checker");
    assert_eq!(text.matches(from).count(), 1, "{from}");
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("broken_{number}.py"));
    std::fs::write(&file, text.replace(from, to)).expect("the folder can be written to");
    file
}

/// Certificates that a checker's rules allow for claims, by branching on anything open; at most this many. `how` is
/// `orders`, or `time` for counting and branchings along time.
fn proven_by(checker: &Path, name: &str, claims: &[Claim], most: usize, how: &str) -> Vec<String> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("the folder can be made");
    // The proof that no period is below one tick is a head.
    for (number, claim) in claims.iter().enumerate() {
        let least = prove(&Claim { bound: 1, ..claim.clone() }, 10).expect("no period is below one tick");
        let head = least.replace("\nno_period_below 1\n", &format!("\nno_period_below {}\n", claim.bound));
        std::fs::write(folder.join(number.to_string()), head).expect("the folder can be written to");
    }
    let mut python = Command::new("python3");
    python.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/prove.py")).arg(checker).arg(&folder);
    let done =
        python.args([claims.len(), most].map(|number| number.to_string())).arg(how).output().expect("python3 runs");
    assert!(done.status.success(), "{name}: {}", String::from_utf8_lossy(&done.stderr));
    (0..claims.len())
        .filter_map(|number| std::fs::read_to_string(folder.join(format!("{number}.proof"))).ok())
        .collect()
}

/// Claims about problems that have a schedule: that no period is below the shortest, and, falsely, below one tick more.
fn claims(cases: u64, longer: u32) -> Vec<Claim> {
    (0..cases).filter_map(|seed| claim(seed, longer)).collect()
}

// The rules allow a proof of each true claim and of no false one, whatever is branched on and assumed at the root.
#[test]
fn rules_prove_true_claims_and_no_false_ones() {
    let cases = from_environment("EERUF_CASES", 150);
    let (all_true, all_false) = (claims(cases, 0), claims(cases, 1));
    assert!(all_true.len() as u64 * 2 > cases && all_false.len() as u64 * 2 > cases, "most have schedules");
    for how in ["orders", "time"] {
        let proofs = proven_by(&checker(), "true", &all_true, usize::MAX >> 1, how);
        assert_eq!(proofs.len(), all_true.len());
        accepted("true-proofs", &proofs);
        assert_eq!(proven_by(&checker(), "false", &all_false, 1, how), Vec::<String>::new());
    }
}

// Each rule broken in turn proves something false, which the whole checker refuses.
#[test]
fn broken_rules_prove_false_claims() {
    let (all_false, most) = (claims(400, 1), from_environment("EERUF_PROOFS", 1) as usize);
    let all = BROKEN.iter().map(|rule| (rule, "orders")).chain(BROKEN_IN_TIME.iter().map(|rule| (rule, "time")));
    for (number, ((rule, from, to), how)) in all.enumerate() {
        let broken = broken(number, from, to);
        let proofs = proven_by(&broken, &format!("broken-{number}"), &all_false, most, how);
        assert!(!proofs.is_empty(), "{rule}: no false claim is proven");
        let [by_broken, by_whole] = [&broken, &checker()].map(|checker| verdicts_of(checker, "broken-proofs", &proofs));
        assert!(by_broken.iter().all(|verdict| !verdict.starts_with("refused")), "{rule}: {by_broken:?}");
        assert!(by_whole.iter().all(|verdict| verdict.starts_with("refused")), "{rule}: {by_whole:?}");
        assert!(proofs.iter().all(|text| !holds(&claim_of(text))), "{rule}: the nested loops see it");
    }
}

const PAIR: &str = "eeruf-certificate 2\ntick_us 1000 1\nsensors 2\nseparation 2 1\nwindow 3 1\nstale_echo 0\n\
                    gap 0 1 3 1\nperiod 4\nfire_a 0 3\nfire_b 1 0\nno_period_below 4\nend\n";

/// The text with one line replaced.
fn with(line: usize, new: &str) -> String {
    let mut lines: Vec<&str> = PAIR.split('\n').collect();
    lines[line - 1] = new;
    lines.join("\n")
}

#[test]
fn refusal_names_line_value_and_expectation() {
    let odd = "expected a permutation that keeps the problem, and earlier orbits with their greatest";
    let cases = [
        (PAIR.to_owned(), "4000 us is the shortest period (tick 1000 us)"),
        (with(11, "no_period_below 3"), "no period below 3000 us; schedule of 4000 us (tick 1000 us)"),
        (with(2, "tick_us 1 3"), "4/3 us is the shortest period (tick 1/3 us)"),
        (String::new(), "refused: line 1: found '', expected a line eeruf-certificate"),
        (with(1, "eeruf-certificate 1"), "refused: line 1: found '1', expected 2 to 2"),
        (with(3, "sensors 65"), "refused: line 3: found '65', expected 1 to 64"),
        (with(4, "separation 2"), "refused: line 4: found 1 numbers, expected 2"),
        (with(5, "window 3 01"), "refused: line 5: found '01', expected 1 to 1048576"),
        (with(5, "window 3  1"), "refused: line 5: found '', expected 1 to 1048576"),
        (with(5, "window 3 9999999"), "refused: line 5: found '9999999', expected 1 to 1048576"),
        (with(7, "gap 1 0 3 1"), "refused: line 7: expected pairs in ascending order"),
        (with(9, "fire_a 0 4"), "refused: line 9: found '4', expected 0 to 3"),
        (with(10, "fire_b 1 2"), "refused: line 10: |d| of sensors 0 and 1 are too near"),
        (with(11, "no_period_below 5"), "refused: line 11: found '5', expected 1 to 4"),
        (with(12, "sign 0\nend"), "refused: line 12: found 'sign', expected a line end"),
        (
            with(12, "reverse 0 1\nend"),
            "refused: line 12: expected two sensors with a gap, and all gaps alike both ways",
        ),
        (with(12, "permutation 1 0\ngreatest 0\nend"), &format!("refused: line 12: {odd}")),
        (with(12, "next\nend"), "refused: line 12: found 'next', expected a line end"),
        (with(12, "line 3\nend"), "refused: line 12: found '3', expected 2 to 2"),
        (with(12, "ring 2\nend"), "refused: line 12: expected neighbours with a gap"),
        (with(7, "clique 0 1\nend"), "refused: line 7: found 'clique', expected a line period"),
        (with(12, "first 0\nend"), "refused: line 12: found 'first', expected a line end"),
        (format!("{PAIR}end\n"), "refused: line 12: expected nothing after the line end"),
        (PAIR.trim_end().to_owned(), "refused: line 12: expected nothing after the line end"),
    ];
    let texts = cases.clone().map(|(text, _)| text);
    assert_eq!(verdicts_of(&checker(), "refusals", &texts), cases.map(|(_, says)| says.to_owned()));
}

#[test]
fn checker_exits_with_0_1_or_2() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(folder.join("good"), PAIR).expect("the folder can be written to");
    std::fs::write(folder.join("bad"), with(12, "")).expect("the folder can be written to");
    for (files, code, out) in [
        (vec!["good"], 0, "4000 us is the shortest period (tick 1000 us)\n"),
        (vec!["bad"], 1, "refused: bad: line 12: found '', expected a line end\n"),
        (vec!["missing"], 2, ""),
        (vec![], 2, ""),
        (vec!["bad", "good", "missing"], 2, "good: 4000 us is the shortest period (tick 1000 us)\n"),
    ] {
        let done =
            Command::new("python3").arg(checker()).args(&files).current_dir(folder).output().expect("python3 runs");
        assert_eq!(done.status.code(), Some(code), "{files:?}");
        assert!(String::from_utf8_lossy(&done.stdout).ends_with(out), "{files:?}: {done:?}");
    }
}
