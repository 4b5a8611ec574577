//! Simplification of outlines by Douglas and Peucker; if lines would cross, corners are added again.
//!
//! D. Douglas and T. Peucker, "Algorithms for the reduction of the number of points required to represent a digitized
//! line or its caricature", The Canadian Cartographer 10(2), 1973.

use std::collections::BTreeSet;

use super::contours::Corner;

/// Returns closed lines through some of the corners. Every omitted corner is within `tolerance` of its line, and every
/// line within `tolerance` of the outline; two lines share at most an end. Lengths are in cells.
pub(super) fn simplified(outlines: &[Vec<Corner>], tolerance: f64) -> Vec<Vec<Corner>> {
    let mut kept: Vec<Kept> = outlines.iter().map(|corners| Kept::new(corners, tolerance)).collect();
    loop {
        let lines: Vec<Line> = kept.iter().enumerate().flat_map(|(outline, kept)| kept.lines(outline)).collect();
        let crossing = crossing(&lines);
        let mut refined = false;
        for line in crossing {
            let Line { outline, first, .. } = lines[line];
            refined |= kept[outline].refine(first);
        }
        if !refined {
            return kept.iter().map(|kept| kept.corners.iter().map(|&corner| kept.of[corner]).collect()).collect();
        }
    }
}

/// An outline, and the corners of it that are kept.
struct Kept<'a> {
    of: &'a [Corner],
    tolerance: f64,
    corners: BTreeSet<usize>,
}

/// One line of a simplified outline.
#[derive(Clone, Copy)]
struct Line {
    outline: usize,
    /// Index in the outline of the corner at which the line begins.
    first: usize,
    ends: [Corner; 2],
}

impl<'a> Kept<'a> {
    fn new(of: &'a [Corner], tolerance: f64) -> Self {
        // The first corner is the lowest; the corner farthest from it is also always an end of a line.
        let farthest = (0..of.len()).max_by_key(|&corner| square(of[corner], of[0])).unwrap_or(0);
        let mut kept = Self { of, tolerance, corners: BTreeSet::from([0, farthest]) };
        kept.refine_until_near(vec![0, farthest]);
        kept
    }

    /// Keeps more corners of the lines that begin at `open`, until all omitted corners are near enough.
    fn refine_until_near(&mut self, mut open: Vec<usize>) {
        while let Some(first) = open.pop() {
            if let Some((corner, off)) = self.farthest(first)
                && off > self.tolerance
            {
                self.corners.insert(corner);
                open.extend([first, corner]);
            }
        }
    }

    /// Returns the index of the corner at which a line ends; the last line ends at the first corner.
    fn end(&self, first: usize) -> usize {
        self.corners.range(first + 1..).next().copied().unwrap_or(self.of.len())
    }

    fn at(&self, place: usize) -> Corner {
        self.of[place % self.of.len()]
    }

    /// Returns the corner farthest from the line that omits it, and its distance; `None` if the line omits none.
    fn farthest(&self, first: usize) -> Option<(usize, f64)> {
        let end = self.end(first);
        let (from, to) = (self.at(first), self.at(end));
        let passed = first + 1..end;
        passed.map(|corner| (corner, off(self.at(corner), from, to))).max_by(|(_, a), (_, b)| a.total_cmp(b))
    }

    /// Adds a corner to the line that begins here, and more to its halves as needed; `false` if the line omits none.
    fn refine(&mut self, first: usize) -> bool {
        let Some((corner, _)) = self.farthest(first) else { return false };
        self.corners.insert(corner);
        self.refine_until_near(vec![first, corner]);
        true
    }

    fn lines(&self, outline: usize) -> impl Iterator<Item = Line> + '_ {
        self.corners.iter().map(move |&first| {
            let ends = [self.at(first), self.at(self.end(first))];
            Line { outline, first, ends }
        })
    }
}

fn square(a: Corner, b: Corner) -> i64 {
    (a[0] - b[0]).pow(2) + (a[1] - b[1]).pow(2)
}

/// Returns the distance of a corner from a line between two corners.
pub(super) fn off(corner: Corner, from: Corner, to: Corner) -> f64 {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]].map(|way| way as f64);
    let [x, y] = [corner[0] - from[0], corner[1] - from[1]].map(|way| way as f64);
    let squared = dx * dx + dy * dy;
    let share = if squared > 0.0 { ((x * dx + y * dy) / squared).clamp(0.0, 1.0) } else { 0.0 };
    libm::hypot(x - share * dx, y - share * dy)
}

/// Returns the lines that share more than an end with another line.
fn crossing(lines: &[Line]) -> BTreeSet<usize> {
    let span = |line: &Line, axis: usize| {
        let [a, b] = line.ends;
        (a[axis].min(b[axis]), a[axis].max(b[axis]))
    };
    let mut by_x: Vec<usize> = (0..lines.len()).collect();
    by_x.sort_by_key(|&line| span(&lines[line], 0));
    let mut found = BTreeSet::new();
    let mut open: Vec<usize> = Vec::new();
    for line in by_x {
        let (left, _) = span(&lines[line], 0);
        open.retain(|&other| span(&lines[other], 0).1 >= left);
        let (low, high) = span(&lines[line], 1);
        for &other in &open {
            let (other_low, other_high) = span(&lines[other], 1);
            if other_low <= high && low <= other_high && meet(lines[line].ends, lines[other].ends) {
                found.extend([line, other]);
            }
        }
        open.push(line);
    }
    found
}

/// Returns true if two lines share more than an end. Exact, since corners are whole numbers.
fn meet([a, b]: [Corner; 2], [c, d]: [Corner; 2]) -> bool {
    let side = |from: Corner, to: Corner, of: Corner| {
        ((to[0] - from[0]) * (of[1] - from[1]) - (to[1] - from[1]) * (of[0] - from[0])).signum()
    };
    let between = |from: Corner, to: Corner, of: Corner| {
        (0..2).all(|axis| from[axis].min(to[axis]) <= of[axis] && of[axis] <= from[axis].max(to[axis]))
    };
    let [sa, sb, sc, sd] = [side(c, d, a), side(c, d, b), side(a, b, c), side(a, b, d)];
    if [sa, sb, sc, sd] == [0; 4] {
        // Both lie on one line: they meet if an end of one lies within the other, or if both are the same.
        let within = |from: Corner, to: Corner, of: Corner| of != from && of != to && between(from, to, of);
        let same = (a == c && b == d) || (a == d && b == c);
        return same || within(a, b, c) || within(a, b, d) || within(c, d, a) || within(c, d, b);
    }
    if sa * sb < 0 && sc * sd < 0 {
        return true;
    }
    // They also meet if an end of one lies within the other.
    let ends_in =
        |side: i64, from: Corner, to: Corner, of: Corner| side == 0 && of != from && of != to && between(from, to, of);
    ends_in(sa, c, d, a) || ends_in(sb, c, d, b) || ends_in(sc, a, b, c) || ends_in(sd, a, b, d)
}

#[cfg(test)]
mod tests {
    use super::super::contours::contours;
    use super::*;
    use proptest::prelude::*;

    /// Returns the distance of a point from the nearest of some lines.
    fn off_lines(point: [f64; 2], corners: &[Corner]) -> f64 {
        let lines = corners.iter().zip(corners.iter().cycle().skip(1));
        let each = lines.map(|(a, b)| {
            let [dx, dy] = [b[0] - a[0], b[1] - a[1]].map(|way| way as f64);
            let [x, y] = [point[0] - a[0] as f64, point[1] - a[1] as f64];
            let share = ((x * dx + y * dy) / (dx * dx + dy * dy).max(1e-300)).clamp(0.0, 1.0);
            libm::hypot(x - share * dx, y - share * dy)
        });
        each.fold(f64::INFINITY, f64::min)
    }

    /// Returns points along closed lines.
    fn along(corners: &[Corner]) -> impl Iterator<Item = [f64; 2]> + '_ {
        let lines = corners.iter().zip(corners.iter().cycle().skip(1));
        lines.flat_map(|(a, b)| {
            (0..=8).map(move |k| [0, 1].map(|axis| a[axis] as f64 + f64::from(k) / 8.0 * (b[axis] - a[axis]) as f64))
        })
    }

    proptest! {
        // Every simplified wall lies within the tolerance of the map, and none crosses another.
        #[test]
        fn simplified_walls_stay_within_tolerance(
            blobs in prop::collection::vec((0_usize..30, 0_usize..24, 1_usize..14, 1_usize..14), 1..12),
            slant in 0_usize..4,
            tolerance in 0.0..4.0_f64,
        ) {
            let occupied = |x: usize, y: usize| {
                let inside = |&(left, low, wide, high): &(usize, usize, usize, usize)| {
                    let left = left + slant * y / 3;
                    (left..left + wide).contains(&x) && (low..low + high).contains(&y)
                };
                blobs.iter().filter(|blob| inside(blob)).count() % 2 == 1
            };
            let outlines = contours(48, 32, occupied);
            let found = simplified(&outlines, tolerance);
            prop_assert_eq!(found.len(), outlines.len());
            for (corners, outline) in found.iter().zip(&outlines) {
                prop_assert!(corners.len() >= 3);
                for point in along(corners) {
                    prop_assert!(off_lines(point, outline) <= tolerance + 1e-9, "{point:?} {outline:?} {corners:?}");
                }
                for point in along(outline) {
                    prop_assert!(off_lines(point, corners) <= tolerance + 1e-9, "{point:?} {outline:?} {corners:?}");
                }
            }
            let walls: Vec<_> = found.iter().flat_map(|corners| {
                let mut closed: Vec<_> = corners.iter().map(|corner| corner.map(|at| at as f64)).collect();
                closed.push(closed[0]);
                crate::scene::Wall::polyline(&closed).collect::<Vec<_>>()
            }).collect();
            let scene = crate::scene::Scene::new(walls, vec![], crate::scene::Air::default());
            prop_assert!(scene.is_ok(), "{:?}", scene.err());
        }
    }

    #[test]
    fn a_slanted_wall_of_stairs_becomes_few_lines() {
        let outlines = contours(60, 60, |x, y| 3 * x >= 2 * y && 3 * x < 2 * y + 9);
        let [stairs, straight] = [0.0, 1.5].map(|tolerance| simplified(&outlines, tolerance)[0].len());
        assert!(stairs > 100 && straight <= 8, "{stairs} {straight}");
    }

    // Lines that share an end do not meet, all others that touch do.
    #[test]
    fn touching_lines_meet_unless_they_share_an_end() {
        let a = [[0, 0], [4, 4]];
        for (b, expected) in [
            ([[0, 0], [4, 0]], false),
            ([[0, 0], [8, 8]], true),
            ([[4, 4], [8, 8]], false),
            ([[4, 4], [0, 0]], true),
            ([[2, 2], [5, 0]], true),
            ([[0, 4], [4, 0]], true),
            ([[0, 1], [3, 4]], false),
            ([[5, 5], [7, 7]], false),
        ] {
            assert_eq!((meet(a, b), meet(b, a)), (expected, expected), "{b:?}");
        }
    }
}
