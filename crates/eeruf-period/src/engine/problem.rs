//! The problem in whole ticks, a claim about its period, and the problem that the engine works on.

/// The needs of a ring in ticks, as a certificate states them. Sensors count from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// A tick is `tick_us.0 / tick_us.1` microseconds.
    pub tick_us: (u32, u32),
    /// Each sensor's separation D: `|d_x|` and `|d_y|` are at least `max(D_x, D_y)` apart.
    pub separation: Vec<u32>,
    /// Each sensor's listening window R, before which it does not fire again.
    pub window: Vec<u32>,
    /// True if `2 |d_x| >= D_x` is required.
    pub stale_echo: bool,
    /// Groups of sensors that fire at the same instants; separation does not count within a group.
    pub together: Vec<Vec<usize>>,
    /// `(x, y, after_x, after_y)` with x < y: y fires no sooner than `after_x` after x, and x no sooner than `after_y`
    /// after y.
    pub gaps: Vec<(usize, usize, u32, u32)>,
}

/// The largest number of sensors.
pub const MAX_SENSORS: usize = 64;
/// The largest number that a certificate may state.
pub const MAX_NUMBER: u32 = 1 << 20;

/// A claim: the schedule keeps the needs, and no period below `bound` can.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// The needs.
    pub problem: Problem,
    /// The schedule's period, in ticks.
    pub period: u32,
    /// The firing times in phases a and b, sensor by sensor, in ticks after the phase's start.
    pub fire: [Vec<u32>; 2],
    /// Proven bound of the period; equal to `period` if that is shortest.
    pub bound: u32,
}

impl Claim {
    /// Checks that a certificate can state the claim, and that the schedule keeps the needs.
    ///
    /// # Errors
    /// The first number that a certificate cannot state, or the need that is not kept, in words.
    pub fn check(&self) -> Result<(), String> {
        let Problem { tick_us, separation, window, together, gaps, .. } = &self.problem;
        let sensors = self.problem.sensors();
        let within = |what: &str, numbers: &[u32], least: u32, most: u32| match numbers
            .iter()
            .find(|number| !(least..=most).contains(*number))
        {
            Some(number) => Err(format!("{what}: {number}; expected {least} to {most}")),
            None => Ok(()),
        };
        within("sensors", &[sensors as u32], 1, MAX_SENSORS as u32)?;
        within("windows", &[window.len() as u32], sensors as u32, sensors as u32)?;
        within("tick_us", &[tick_us.0, tick_us.1], 1, MAX_NUMBER)?;
        within("separation", separation, 1, MAX_NUMBER)?;
        within("window", window, 1, MAX_NUMBER)?;
        for (at, group) in together.iter().enumerate() {
            let is_sorted = group.windows(2).all(|pair| pair[0] < pair[1]);
            let is_known = group.iter().all(|&sensor| sensor < sensors);
            let is_alone = together[..at].iter().flatten().all(|sensor| !group.contains(sensor));
            if !(group.len() > 1 && is_sorted && is_known && is_alone) {
                return Err(format!("together: {group:?}; expected sensors in ascending order, each in one group"));
            }
        }
        if gaps.windows(2).any(|pair| (pair[0].0, pair[0].1) >= (pair[1].0, pair[1].1))
            || gaps.iter().any(|&(x, y, ..)| x >= y || y >= sensors)
        {
            return Err("gaps; expected pairs x < y in ascending order".to_owned());
        }
        let gaps: Vec<u32> = gaps.iter().flat_map(|&(.., after_x, after_y)| [after_x, after_y]).collect();
        within("gap", &gaps, 1, MAX_NUMBER)?;
        within("period", &[self.period], 1, MAX_NUMBER)?;
        for times in &self.fire {
            within("firing times", &[times.len() as u32], sensors as u32, sensors as u32)?;
            within("firing time", times, 0, self.period - 1)?;
        }
        within("bound", &[self.bound], 1, self.period)?;
        if self.problem.is_kept_by(self.period, &self.fire) {
            Ok(())
        } else {
            Err("a schedule that does not keep the needs".to_owned())
        }
    }

    /// The head of a certificate.
    pub(crate) fn head(&self) -> String {
        let problem = &self.problem;
        let row = |numbers: &[u32]| numbers.iter().map(|number| format!(" {number}")).collect::<String>();
        let mut text = format!("eeruf-certificate 2\ntick_us {} {}\n", problem.tick_us.0, problem.tick_us.1);
        text += &format!("sensors {}\n", problem.sensors());
        text += &format!("separation{}\nwindow{}\n", row(&problem.separation), row(&problem.window));
        text += &format!("stale_echo {}\n", u32::from(problem.stale_echo));
        for group in &problem.together {
            text += &format!("together{}\n", group.iter().map(|sensor| format!(" {sensor}")).collect::<String>());
        }
        for (x, y, after_x, after_y) in &problem.gaps {
            text += &format!("gap {x} {y} {after_x} {after_y}\n");
        }
        text += &format!("period {}\nfire_a{}\nfire_b{}\n", self.period, row(&self.fire[0]), row(&self.fire[1]));
        text + &format!("no_period_below {}\n", self.bound)
    }
}

/// The problem with each group of sensors that fire together taken as one sensor: they share their firing times, so
/// the strictest requirement of the group is the requirement of all.
#[derive(Clone, Debug)]
pub(crate) struct Merged {
    /// The merged sensor of each sensor.
    pub(crate) of_sensor: Vec<usize>,
    pub(crate) separation: Vec<i32>,
    pub(crate) window: Vec<i32>,
    pub(crate) stale_echo: bool,
    /// `gap[x][y]`: the least time from x to y; 0 without a requirement.
    pub(crate) gap: Vec<Vec<i32>>,
    /// The pairs x < y with a gap.
    pub(crate) pairs: Vec<(usize, usize)>,
    /// For each sensor, those with which it has a gap.
    pub(crate) neighbours: Vec<Vec<usize>>,
    /// The least distance of any two |d|.
    pub(crate) least_apart: i32,
}

impl Problem {
    /// A problem of identical sensors, in ticks of 1 ms: row x of `neighbours` has bit y if x and y have a gap.
    #[must_use]
    pub fn alike(neighbours: &[u64], separation: u32, gap: u32, window: u32) -> Self {
        let sensors = neighbours.len();
        let pairs = (0..sensors).flat_map(|x| (x + 1..sensors).map(move |y| (x, y)));
        Self {
            tick_us: (1000, 1),
            separation: vec![separation; sensors],
            window: vec![window; sensors],
            stale_echo: false,
            together: Vec::new(),
            gaps: pairs.filter(|&(x, y)| neighbours[x] >> y & 1 == 1).map(|(x, y)| (x, y, gap, gap)).collect(),
        }
    }

    /// The number of sensors.
    #[must_use]
    pub fn sensors(&self) -> usize {
        self.separation.len()
    }

    /// All times of the problem, in ticks.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = u32> + '_ {
        let gaps = self.gaps.iter().flat_map(|&(.., after_x, after_y)| [after_x, after_y]);
        self.separation.iter().chain(&self.window).copied().chain(gaps)
    }

    /// Returns the problem with the smallest separation raised to the second smallest. For any two sensors the larger
    /// counts, so a single smaller one matters only for that sensor's own stale echoes.
    pub(crate) fn with_separations_that_count(&self) -> Self {
        let merged = self.merged();
        let raised = |of: &usize, own: u32| {
            let is_alone = merged.separation.iter().filter(|&&other| other < merged.least_apart).count() == 1;
            let is_least = merged.separation[*of] < merged.least_apart;
            if is_alone && is_least && !self.stale_echo { merged.least_apart as u32 } else { own }
        };
        let separation = merged.of_sensor.iter().zip(&self.separation).map(|(of, &own)| raised(of, own)).collect();
        Self { separation, ..self.clone() }
    }

    /// The even ring that requires no more: all sensors have the smallest separation that counts, the smallest gap and
    /// the smallest window. `None` if that is the problem itself.
    pub(crate) fn evened(&self) -> Option<Self> {
        let counts = self.with_separations_that_count();
        let least = |times: &[u32]| times.iter().copied().min().unwrap_or(1);
        let gap = counts.gaps.iter().map(|&(.., after_x, after_y)| after_x.min(after_y)).min().unwrap_or(1);
        let even = Self {
            separation: vec![least(&counts.separation); self.sensors()],
            window: vec![least(&counts.window); self.sensors()],
            gaps: counts.gaps.iter().map(|&(x, y, ..)| (x, y, gap, gap)).collect(),
            ..counts.clone()
        };
        (even != counts).then_some(even)
    }

    /// The problem with low windows and gaps raised to the most common value: its schedules serve the problem, and it
    /// often has more symmetries. `None` if no values, or many, are lower.
    pub(crate) fn raised(&self) -> Option<Self> {
        /// Largest number of windows and pairs to raise: with more, a search of the problem itself takes no longer.
        const MOST: usize = 8;
        let [windows, _, gaps] = self.limits();
        let (window, gap) = (most_common(&windows)?.0, most_common(&gaps).map_or(0, |(gap, _)| gap));
        let raised = Self {
            window: self.window.iter().map(|&own| own.max(window)).collect(),
            gaps: self.gaps.iter().map(|&(x, y, to, from)| (x, y, to.max(gap), from.max(gap))).collect(),
            ..self.clone()
        };
        let pairs = raised.gaps.iter().zip(&self.gaps).filter(|(to, from)| to != from).count();
        let sensors = raised.window.iter().zip(&self.window).filter(|(to, from)| to != from).count();
        (1..=MOST).contains(&(sensors + pairs)).then_some(raised)
    }

    /// Returns true if all sensors are alike, and so are all pairs that need a gap.
    pub(crate) fn is_even(&self) -> bool {
        let alike = |limits: &Vec<u32>| limits.windows(2).all(|pair| pair[0] == pair[1]);
        self.together.is_empty() && self.limits().iter().all(alike)
    }

    /// All windows, separations and gaps, by kind.
    pub(crate) fn limits(&self) -> [Vec<u32>; 3] {
        let gaps = self.gaps.iter().flat_map(|&(.., after_x, after_y)| [after_x, after_y]).collect();
        [self.window.clone(), self.separation.clone(), gaps]
    }

    /// Returns true if some kind of limit has no value that half of the sensors or pairs share.
    pub(crate) fn is_mixed(&self) -> bool {
        self.limits().into_iter().any(|limits| most_common(&limits).is_some_and(|(_, alike)| 2 * alike < limits.len()))
    }

    pub(crate) fn merged(&self) -> Merged {
        let mut of_sensor: Vec<usize> = (0..self.sensors()).collect();
        for group in &self.together {
            for &sensor in group {
                of_sensor[sensor] = group[0];
            }
        }
        // Number the first of each group in the order of the sensors.
        let firsts: Vec<usize> = (0..self.sensors()).filter(|&sensor| of_sensor[sensor] == sensor).collect();
        for one in &mut of_sensor {
            *one = firsts.iter().position(|first| first == one).unwrap_or(0);
        }
        let count = firsts.len();
        let (mut separation, mut window) = (vec![0; count], vec![0; count]);
        let mut gap = vec![vec![0; count]; count];
        for sensor in 0..self.sensors() {
            let one = of_sensor[sensor];
            separation[one] = separation[one].max(self.separation[sensor] as i32);
            window[one] = window[one].max(self.window[sensor] as i32);
        }
        for &(x, y, after_x, after_y) in &self.gaps {
            let (x, y) = (of_sensor[x], of_sensor[y]);
            gap[x][y] = gap[x][y].max(after_x as i32);
            gap[y][x] = gap[y][x].max(after_y as i32);
        }
        let pairs = (0..count).flat_map(|x| (x + 1..count).map(move |y| (x, y)));
        let pairs = pairs.filter(|&(x, y)| gap[x][y] > 0).collect();
        let neighbours = gap.iter().map(|row| (0..count).filter(|&y| row[y] > 0).collect()).collect();
        let stale_echo = self.stale_echo;
        // For two sensors the larger separation counts, so the smallest of all never does.
        let mut ascending = separation.clone();
        ascending.sort_unstable();
        let least_apart = ascending.get(1).or(ascending.first()).copied().unwrap_or(0);
        Merged { of_sensor, separation, window, stale_echo, gap, pairs, neighbours, least_apart }
    }
}

/// The most common number (of equally common ones the largest), and its count.
pub(crate) fn most_common(numbers: &[u32]) -> Option<(u32, usize)> {
    let often = |number: u32| numbers.iter().filter(|other| **other == number).count();
    numbers.iter().map(|&number| (number, often(number))).max_by_key(|&(number, often)| (often, number))
}

impl Merged {
    pub(crate) fn count(&self) -> usize {
        self.separation.len()
    }

    /// The first sensor of each sensor's group, or the sensor itself.
    pub(crate) fn firsts(&self) -> Vec<usize> {
        (0..self.count()).map(|one| self.of_sensor.iter().position(|of| *of == one).unwrap_or(0)).collect()
    }

    /// The least distance of `|d_x|` and `|d_y|`.
    pub(crate) fn apart(&self, x: usize, y: usize) -> i32 {
        self.separation[x].max(self.separation[y])
    }
}
