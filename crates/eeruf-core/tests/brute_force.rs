//! A brute force over firing times judges `search::design`: shortest periods, decisions, largest values, preferences and
//! relaxations of random problems of up to six sensors and 40 ticks.
//!
//! It is written from the definition in the documentation of [`Problem`] and shares nothing with the search. Each sensor has a
//! set of pairs of firing times that are still open to it. Setting one sensor takes away from the others what no longer fits;
//! the sensor with the fewest pairs is next.
//!
//! `EERUF_BRUTE_FORCE=10000` judges so many problems instead of 200 in each test, and `EERUF_BRUTE_FORCE_SEED` draws others.

use eeruf_core::search::design::{
    Answer, Effect, Firing, Problem, decide, largest_interval, largest_separation, memory_words, prefer, relaxations,
    shortest,
};

/// The longest period that is judged.
const MOST_TICKS: u32 = 40;
/// What one sensor may do at most: `MOST_TICKS` rows, one for each time in phase a, with a bit for each time in phase b.
type Times = [u64; MOST_TICKS as usize];
/// A question that takes the brute force more steps than this is left unjudged, and few may be.
const MOST_STEPS: u64 = 200_000;

/// The needs of a problem at a period, all signed so that they can be written as in the definition.
#[derive(Clone, Debug)]
struct Needs {
    conflicts: Vec<u64>,
    separation: i32,
    interval: i32,
    window: i32,
    stale_echo: bool,
    period: i32,
}

impl Needs {
    fn conflict(&self, x: usize, y: usize) -> bool {
        self.conflicts[x] >> y & 1 == 1
    }

    /// Whether a sensor alone may fire at these times.
    fn alone(&self, (a, b): (i32, i32)) -> bool {
        let size = (a - b).abs();
        self.period - size >= self.window && (!self.stale_echo || 2 * size >= self.separation)
    }

    /// Whether the crosstalk between two sensors moves enough.
    fn separated(&self, (ax, bx): (i32, i32), (ay, by): (i32, i32)) -> bool {
        ((ax - bx).abs() - (ay - by).abs()).abs() >= self.separation
    }

    /// Whether two firings, `s` in one sensor's phase and `t` in the other's, are far enough apart. `other` says that the phases
    /// differ, and then one comes a period after the other, whichever is first.
    fn apart(&self, s: i32, t: i32, other: bool) -> bool {
        if other {
            self.period + t - s >= self.interval && self.period + s - t >= self.interval
        } else {
            (s - t).abs() >= self.interval
        }
    }

    /// Whether two conflicting sensors fire far enough apart in both phases and across the ends of both.
    fn all_apart(&self, (ax, bx): (i32, i32), (ay, by): (i32, i32)) -> bool {
        self.apart(ax, ay, false) && self.apart(bx, by, false) && self.apart(ax, by, true) && self.apart(bx, ay, true)
    }

    /// Whether these firing times meet the needs, pair by pair.
    fn met_by(&self, times: &[(i32, i32)]) -> bool {
        let within = |time: i32| (0..self.period).contains(&time);
        (0..times.len()).all(|x| {
            within(times[x].0)
                && within(times[x].1)
                && self.alone(times[x])
                && (0..x).all(|y| {
                    self.separated(times[x], times[y]) && (!self.conflict(x, y) || self.all_apart(times[x], times[y]))
                })
        })
    }
}

/// Whether a schedule exists; `None` if that takes too many steps.
fn brute_force(needs: &Needs) -> Option<bool> {
    assert!((1..=MOST_TICKS as i32).contains(&needs.period));
    let sensors = needs.conflicts.len();
    let mut open = vec![[0; MOST_TICKS as usize]; sensors];
    for (x, open) in open.iter_mut().enumerate() {
        for a in 0..needs.period {
            for b in 0..needs.period {
                // A sensor without conflicts needs nothing but some |d|, so it may as well fire at 0 in phase b.
                if needs.alone((a, b)) && (needs.conflicts[x] != 0 || b == 0) {
                    open[a as usize] |= 1 << b;
                }
            }
        }
    }
    let mut search = BruteForce { needs, set: vec![None; sensors], steps: 0 };
    // All that conflict can be moved to earlier times together, and the phases exchanged: one of them may as well fire at 0 in b.
    let conflicting: Vec<usize> = (0..sensors).filter(|&x| needs.conflicts[x] != 0).collect();
    let mut found = Some(false);
    if conflicting.is_empty() {
        found = search.place(&open);
    }
    for &first in &conflicting {
        if found != Some(false) {
            break;
        }
        let mut open = open.clone();
        for row in &mut open[first] {
            *row &= 1;
        }
        found = search.place(&open);
    }
    if found == Some(true) {
        let times: Vec<_> = search.set.iter().map(|times| times.expect("every sensor is set")).collect();
        assert!(needs.met_by(&times), "the brute force itself is wrong: {needs:?} {times:?}");
    }
    found
}

struct BruteForce<'a> {
    needs: &'a Needs,
    set: Vec<Option<(i32, i32)>>,
    steps: u64,
}

impl BruteForce<'_> {
    fn place(&mut self, open: &[Times]) -> Option<bool> {
        let count = |times: &Times| times.iter().map(|row| row.count_ones()).sum::<u32>();
        let left: Vec<usize> = (0..open.len()).filter(|&x| self.set[x].is_none()).collect();
        let Some(&next) = left.iter().min_by_key(|&&x| count(&open[x])) else { return Some(true) };
        if !self.has_room(&left, open) {
            return Some(false);
        }
        for a in 0..self.needs.period {
            for b in (0..self.needs.period).filter(|b| open[next][a as usize] >> b & 1 == 1) {
                self.steps += 1;
                if self.steps > MOST_STEPS {
                    return None;
                }
                self.set[next] = Some((a, b));
                let open: Vec<Times> = (0..open.len()).map(|x| self.remaining(x, open[x], next, (a, b))).collect();
                if left.iter().all(|&x| x == next || count(&open[x]) > 0) && self.place(&open)? {
                    return Some(true);
                }
                self.set[next] = None;
            }
        }
        Some(false)
    }

    /// What is left to sensor `x` when `other` fires at these times.
    fn remaining(&self, x: usize, open: Times, other: usize, (a, b): (i32, i32)) -> Times {
        let needs = self.needs;
        if self.set[x].is_some() {
            return open;
        }
        let bits = |keeps: &dyn Fn(i32) -> bool| (0..needs.period).filter(|&t| keeps(t)).map(|t| 1 << t).sum::<u64>();
        // Two sensors of which each conflicts with the same others can be exchanged: the lower one has the smaller |d|.
        let ordered = |size: i32| !self.twins(x, other) || (size < (a - b).abs()) == (x < other);
        let sizes = bits(&|size| needs.separated((size, 0), (a, b)) && ordered(size));
        let conflict = needs.conflict(x, other);
        let in_a = bits(&|s| !conflict || (needs.apart(s, a, false) && needs.apart(s, b, true)));
        let in_b = bits(&|t| !conflict || (needs.apart(t, b, false) && needs.apart(t, a, true)));
        let mut rows = [0; MOST_TICKS as usize];
        for (s, row) in rows.iter_mut().enumerate().filter(|(s, _)| in_a >> s & 1 == 1) {
            // From time s on, and from s backwards.
            *row = open[s] & in_b & (sizes << s | sizes.reverse_bits() >> (63 - s));
        }
        rows
    }

    fn twins(&self, x: usize, y: usize) -> bool {
        self.needs.conflicts[x] & !(1 << y) == self.needs.conflicts[y] & !(1 << x)
    }

    /// Whether the sensors that are left may find enough separated |d| between them, and those of them that all conflict with one
    /// another enough times in each phase.
    fn has_room(&self, left: &[usize], open: &[Times]) -> bool {
        let sizes = |s: usize, row: u64| row >> s | row.reverse_bits() >> (63 - s);
        let in_a = |s: usize, row: u64| u64::from(row != 0) << s;
        let any = |sensors: &[usize], of: &dyn Fn(usize, u64) -> u64| {
            sensors.iter().flat_map(|&x| open[x].iter().enumerate()).fold(0, |any, (s, &row)| any | of(s, row))
        };
        most(any(left, &sizes), self.needs.separation) >= left.len()
            && left.iter().all(|&x| {
                let mut clique = vec![x];
                for &y in left {
                    if clique.iter().all(|&z| self.needs.conflict(y, z)) {
                        clique.push(y);
                    }
                }
                let interval = self.needs.interval;
                most(any(&clique, &in_a), interval) >= clique.len()
                    && most(any(&clique, &|_, row| row), interval) >= clique.len()
            })
    }
}

/// How many of these numbers can be chosen so that each is `apart` or more from the next: from small to large, each as soon as it can
/// be.
fn most(numbers: u64, apart: i32) -> usize {
    if apart == 0 {
        return usize::MAX;
    }
    let (mut chosen, mut next) = (0, 0);
    while next < 64 && numbers >> next != 0 {
        next += (numbers >> next).trailing_zeros() as i32 + apart;
        chosen += 1;
    }
    chosen
}

/// A seeded pseudo-random sequence, the same on every machine (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    fn up_to(&mut self, most: u32) -> u32 {
        (self.next() % (u64::from(most) + 1)) as u32
    }
}

/// A line, a ring, blocks, or any graph, with up to five neighbours.
fn conflicts(sensors: usize, random: &mut Random) -> Vec<u64> {
    let (layout, n) = (random.up_to(3), 1 + random.up_to(4) as usize);
    let odds = random.up_to(3);
    let mut rows = vec![0; sensors];
    for x in 0..sensors {
        for y in 0..x {
            let conflict = match layout {
                0 => x - y < n,
                1 => x - y < n || sensors - (x - y) < n,
                2 => x / n == y / n,
                _ => random.up_to(3) <= odds,
            };
            if conflict {
                rows[x] |= 1 << y;
                rows[y] |= 1 << x;
            }
        }
    }
    rows
}

/// A random problem with up to six sensors, whose numbers leave room for a period of up to about 40 ticks.
fn draw(random: &mut Random) -> (Vec<u64>, Problem<'static>) {
    let sensors = 1 + random.up_to(5) as usize;
    let problem = Problem {
        sensors,
        conflicts: &[],
        separation: 1 + random.up_to(4),
        interval: random.up_to(8),
        window: random.up_to(25),
        stale_echo: random.up_to(1) == 1,
    };
    (conflicts(sensors, random), problem)
}

fn needs(problem: &Problem<'_>, period: u32) -> Needs {
    Needs {
        conflicts: problem.conflicts.to_vec(),
        separation: problem.separation as i32,
        interval: problem.interval as i32,
        window: problem.window as i32,
        stale_echo: problem.stale_echo,
        period: period as i32,
    }
}

fn times(firing: &Firing) -> Vec<(i32, i32)> {
    firing.fire_a().iter().zip(firing.fire_b()).map(|(&a, &b)| (a as i32, b as i32)).collect()
}

fn assert_meets(problem: &Problem<'_>, period: u32, firing: &Firing) {
    assert_eq!(firing.fire_a().len(), problem.sensors);
    assert!(needs(problem, period).met_by(&times(firing)), "{problem:?} at {period}: {:?}", times(firing));
}

/// How many questions were judged, and how many were too large to judge, by the number of sensors.
#[derive(Default, Debug)]
struct Judged {
    yes: [u32; 7],
    no: [u32; 7],
    unjudged: [u32; 7],
}

impl Judged {
    /// Asserts that no schedule meets this problem.
    fn assert_none(&mut self, problem: &Problem<'_>, period: u32) {
        match brute_force(&needs(problem, period)) {
            Some(found) => {
                assert!(!found, "there is a schedule: {problem:?} at {period}");
                self.no[problem.sensors] += 1;
            }
            None => self.unjudged[problem.sensors] += 1,
        }
    }

    /// Asserts that what was found is right and that nothing was kept back.
    fn assert_decided(&mut self, problem: &Problem<'_>, period: u32, answer: &Answer) {
        match answer {
            Answer::Found(firing) => {
                assert_meets(problem, period, firing);
                self.yes[problem.sensors] += 1;
            }
            Answer::Exhausted => self.assert_none(problem, period),
            Answer::BudgetSpent => panic!("no budget was set: {problem:?} at {period}"),
        }
    }

    /// Asserts that enough was judged for each number of sensors, both ways.
    fn assert_enough(&self, both: bool) {
        println!("{self:?}");
        for sensors in 2..=6 {
            let (yes, no, unjudged) = (self.yes[sensors], self.no[sensors], self.unjudged[sensors]);
            assert!(no >= 10 && (!both || yes >= 3), "{sensors} sensors: {yes} found, {no} refuted");
            assert!(5 * unjudged <= yes + no, "{sensors} sensors: {unjudged} of {} not judged", yes + no);
        }
    }
}

/// Goes through `part` hundredths of the problems that are asked for.
fn for_each_problem(part: u32, seed: u64, mut judge: impl FnMut(&Problem<'_>, &mut [i32], &mut Random)) {
    let number = |name| std::env::var(name).ok().map(|text: String| text.parse::<u64>().expect(name));
    let problems = number("EERUF_BRUTE_FORCE").unwrap_or(200) * u64::from(part) / 100;
    let mut random = Random(seed ^ number("EERUF_BRUTE_FORCE_SEED").unwrap_or(0) << 8);
    let mut memory = vec![0; memory_words(6)];
    for _ in 0..problems {
        let (rows, problem) = draw(&mut random);
        judge(&Problem { conflicts: &rows, ..problem }, &mut memory, &mut random);
    }
}

#[test]
fn no_period_is_shorter_than_the_shortest() {
    let mut judged = Judged::default();
    for_each_problem(100, 1, |problem, memory, _| {
        let found = shortest(problem, u64::MAX, memory, &mut ()).unwrap();
        assert!(found.proven());
        assert_meets(problem, found.period, &found.firing);
        if found.period > 1 {
            judged.assert_none(problem, (found.period - 1).min(MOST_TICKS));
        }
    });
    judged.assert_enough(false);
}

#[test]
fn decisions_are_right_at_any_period() {
    let mut judged = Judged::default();
    for_each_problem(100, 2, |problem, memory, random| {
        let period = 1 + random.up_to(MOST_TICKS - 1);
        let decision = decide(problem, period, u64::MAX, memory, &mut ()).unwrap();
        judged.assert_decided(problem, period, &decision.answer);
    });
    judged.assert_enough(true);
}

/// A period at which there are schedules, and not a very long one.
fn some_period(problem: &Problem<'_>, memory: &mut [i32], random: &mut Random) -> Option<u32> {
    let period = shortest(problem, u64::MAX, memory, &mut ()).unwrap().period + random.up_to(3);
    (period <= MOST_TICKS).then_some(period)
}

#[test]
fn no_separation_is_larger_than_the_largest() {
    let mut judged = Judged::default();
    for_each_problem(100, 3, |problem, memory, random| {
        // At some periods there is none at all.
        let Some(period) = some_period(problem, memory, random).map(|period| period - random.up_to(1)) else { return };
        if period == 0 {
            return;
        }
        let largest = largest_separation(problem, period, u64::MAX, memory, &mut ()).unwrap();
        assert!(largest.proven());
        let Some((separation, firing)) = largest.found else {
            return judged.assert_none(&Problem { separation: 1, ..*problem }, period);
        };
        if problem.sensors == 1 && !problem.stale_echo {
            assert_eq!(separation, period, "a single sensor has no need of separation");
            return assert_meets(&Problem { separation: 1, ..*problem }, period, &firing);
        }
        assert_meets(&Problem { separation, ..*problem }, period, &firing);
        judged.yes[problem.sensors] += 1;
        judged.assert_none(&Problem { separation: separation + 1, ..*problem }, period);
    });
    judged.assert_enough(false);
}

#[test]
fn no_interval_is_longer_than_the_largest() {
    let mut judged = Judged::default();
    for_each_problem(100, 4, |problem, memory, random| {
        let Some(period) = some_period(problem, memory, random).map(|period| period - random.up_to(1)) else { return };
        if period == 0 {
            return;
        }
        let largest = largest_interval(problem, period, u64::MAX, memory, &mut ()).unwrap();
        assert!(largest.proven());
        let Some((interval, firing)) = largest.found else {
            return judged.assert_none(&Problem { interval: 0, ..*problem }, period);
        };
        assert_meets(&Problem { interval, ..*problem }, period, &firing);
        judged.yes[problem.sensors] += 1;
        if problem.conflicts.iter().all(|&row| row == 0) {
            assert_eq!(interval, period, "without conflicts the answer is the period");
        } else {
            judged.assert_none(&Problem { interval: interval + 1, ..*problem }, period);
        }
    });
    judged.assert_enough(false);
}

#[test]
fn the_preferred_schedule_is_best_in_separation_then_interval_then_window() {
    let mut judged = Judged::default();
    let mut better = [0; 3];
    for_each_problem(60, 5, |problem, memory, _| {
        let found = shortest(problem, u64::MAX, memory, &mut ()).unwrap();
        let period = found.period;
        if period > MOST_TICKS {
            return;
        }
        let best = prefer(problem, &found, u64::MAX, memory, &mut ()).unwrap();
        assert!(best.separation.proven() && best.interval.proven() && best.window.proven());
        let (separation, interval, window) = (best.separation.value, best.interval.value, best.window.value);
        let no_separation = problem.sensors == 1 && !problem.stale_echo;
        let all = Problem { separation: if no_separation { 1 } else { separation }, interval, window, ..*problem };
        assert_meets(&all, period, &best.firing);
        if !no_separation {
            judged.assert_none(&Problem { separation: separation + 1, ..*problem }, period);
        }
        if problem.conflicts.iter().any(|&row| row != 0) {
            judged.assert_none(&Problem { interval: interval + 1, window: problem.window, ..all }, period);
        }
        judged.assert_none(&Problem { window: window + 1, ..all }, period);
        better[0] += u32::from(!no_separation && separation > problem.separation);
        better[1] += u32::from(problem.conflicts.iter().any(|&row| row != 0) && interval > problem.interval);
        better[2] += u32::from(window > problem.window);
    });
    println!("better than asked for: {better:?}");
    assert!(better.iter().all(|&often| often >= 10), "there was something to prefer: {better:?}");
    judged.assert_enough(false);
}

#[test]
fn what_one_tick_less_does_to_the_period_is_true() {
    let mut judged = Judged::default();
    for_each_problem(60, 6, |problem, memory, _| {
        let period = shortest(problem, u64::MAX, memory, &mut ()).unwrap().period;
        if period < 2 || period > MOST_TICKS {
            return;
        }
        let relaxed = relaxations(problem, period, u64::MAX, memory, &mut ()).unwrap();
        let Problem { separation, interval, window, .. } = *problem;
        let less = [
            (relaxed.separation, (separation > 1).then(|| Problem { separation: separation - 1, ..*problem })),
            (relaxed.interval, (interval > 0).then(|| Problem { interval: interval - 1, ..*problem })),
            (relaxed.window, (window > 0).then(|| Problem { window: window - 1, ..*problem })),
        ];
        for (effect, less) in less {
            let Some(less) = less else {
                assert_eq!(effect, Effect::None);
                continue;
            };
            match brute_force(&needs(&less, period - 1)) {
                Some(found) => {
                    assert_eq!(effect, if found { Effect::Shorter } else { Effect::None }, "{less:?} at {period} - 1");
                    let judged = if found { &mut judged.yes } else { &mut judged.no };
                    judged[problem.sensors] += 1;
                }
                None => judged.unjudged[problem.sensors] += 1,
            }
        }
    });
    judged.assert_enough(true);
}

/// Whether a schedule exists, by trying all times of one sensor after the other and asking for everything at the end.
fn nested_loops(needs: &Needs, times: &mut Vec<(i32, i32)>) -> bool {
    if times.len() == needs.conflicts.len() {
        return needs.met_by(times);
    }
    (0..needs.period).any(|a| {
        (0..needs.period).any(|b| {
            times.push((a, b));
            let found = nested_loops(needs, times);
            times.pop();
            found
        })
    })
}

#[test]
fn the_brute_force_prunes_nothing_that_nested_loops_find() {
    let mut random = Random(7);
    let mut answers = [0, 0];
    for _ in 0..400 {
        let sensors = 1 + random.up_to(2) as usize;
        let needs = Needs {
            conflicts: conflicts(sensors, &mut random),
            separation: 1 + random.up_to(2) as i32,
            interval: random.up_to(3) as i32,
            window: random.up_to(6) as i32,
            stale_echo: random.up_to(1) == 1,
            period: 1 + random.up_to(if sensors < 3 { 8 } else { 5 }) as i32,
        };
        let found = nested_loops(&needs, &mut Vec::new());
        assert_eq!(brute_force(&needs), Some(found), "{needs:?}");
        answers[usize::from(found)] += 1;
    }
    assert!(answers.iter().all(|&often| often >= 50), "{answers:?}");
}
