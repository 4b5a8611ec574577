//! The problem of a certificate, and what the checker makes of it.

/// Requirements of a ring of sensors on its firing times, in ticks. Sensors count from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// A tick is `tick_us.0 / tick_us.1` microseconds.
    pub tick_us: (u32, u32),
    /// Each sensor's separation D: `|d_x|` and `|d_y|` are at least `max(D_x, D_y)` apart.
    pub separation: Vec<u32>,
    /// Each sensor's listening window R: it fires again no sooner.
    pub window: Vec<u32>,
    /// True if `2 |d_x| >= D_x`.
    pub stale_echo: bool,
    /// True if the claim is about real firing times and periods; otherwise they are whole ticks.
    pub over_reals: bool,
    /// Groups of sensors that fire at the same instants; separation does not count within a group.
    pub together: Vec<Vec<usize>>,
    /// `(x, y, after_x, after_y)` with x < y: y fires no sooner than `after_x` after x, and x no sooner than `after_y`
    /// after y.
    pub gaps: Vec<(usize, usize, u32, u32)>,
}

/// The largest number of sensors.
pub const MAX_SENSORS: usize = 64;
/// The largest number in a certificate.
pub const MAX_NUMBER: u32 = 1 << 20;

/// The problem with each group of sensors that fire together taken as one sensor: they share their firing times, so
/// the strictest requirement of the group is the requirement of all.
#[derive(Clone, Debug)]
pub(crate) struct Merged {
    /// The one of each sensor.
    pub(crate) of_sensor: Vec<usize>,
    pub(crate) separation: Vec<i32>,
    pub(crate) window: Vec<i32>,
    pub(crate) stale_echo: bool,
    pub(crate) over_reals: bool,
    /// `gap[x][y]`: y fires no sooner than this after x; 0 where there is no requirement.
    pub(crate) gap: Vec<Vec<i32>>,
    /// The pairs x < y with a gap.
    pub(crate) pairs: Vec<(usize, usize)>,
    /// Those with which each has a gap.
    pub(crate) neighbours: Vec<Vec<usize>>,
}

impl Problem {
    /// The number of sensors.
    #[must_use]
    pub fn sensors(&self) -> usize {
        self.separation.len()
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
        let (stale_echo, over_reals) = (self.stale_echo, self.over_reals);
        Merged { of_sensor, separation, window, stale_echo, over_reals, gap, pairs, neighbours }
    }
}

impl Merged {
    pub(crate) fn count(&self) -> usize {
        self.separation.len()
    }

    /// A bound on the distance of `|d_x|` and `|d_y|`.
    pub(crate) fn apart(&self, x: usize, y: usize) -> i32 {
        2 * self.separation[x].max(self.separation[y])
    }
}
