//! Paths around one edge that is visible from both source and receiver: first-order diffraction at rigid wedges.

mod join;

use super::audibility::Audibility;
use super::ends::Ends;
use super::limits::Limits;
use crate::{
    acoustics::{LOUDEST_PANEL, edge_diffraction},
    geometry::{Point, TOUCH_M, Vector},
    scene::{MAX_COORDINATE_M, NONE, Scene},
    threads::Stop,
};
use parry2d_f64::bounding_volume::Aabb;

/// A path around an edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgePath {
    pub(crate) receiver: u32,
    pub(crate) edge: u32,
    pub(crate) length_m: f64,
    pub(crate) departure_rad: f64,
    pub(crate) arrival_rad: f64,
    /// Share of the amplitude after diffraction and spreading, at the wave number of the query.
    pub(crate) spread: f64,
    /// Share without the upper bound, and its wave number; `None` for two paths heard as one.
    unbounded: Option<[f64; 2]>,
    /// The position of the edge, for recognising duplicates.
    pub(crate) at: Point,
}

impl EdgePath {
    /// Returns the share of the amplitude at another wave number: Keller's coefficient falls with its square root.
    pub(crate) fn spread_at(&self, wave_number: f64) -> f64 {
        match self.unbounded {
            Some([unbounded, at]) if wave_number != at => {
                let (spread, most) = (unbounded * (at / wave_number).sqrt(), MOST / self.length_m);
                if spread < most { spread } else { most }
            }
            _ => self.spread,
        }
    }
}

/// A search for paths around edges, with buffers.
#[derive(Debug, Default)]
pub(crate) struct EdgeSearch {
    pub(crate) found: Vec<EdgePath>,
    /// The triangles of a point on a surface.
    triangles: Vec<u32>,
    /// The edges to be examined, in order.
    wanted: Vec<u32>,
    // These are kept between queries for their memory.
    places: Vec<u32>,
    surfaces: Vec<u32>,
    /// For each edge its index among the examined edges, or [`NONE`].
    chosen: Vec<u32>,
}

/// The input of a search.
#[derive(Clone, Copy)]
pub(crate) struct EdgeQuery<'a> {
    pub(crate) scene: &'a Scene,
    /// Audibility, if certainly inaudible sound may be left out.
    pub(crate) audibility: Option<&'a Audibility>,
    pub(crate) source: Point,
    pub(crate) receivers: &'a [Point],
    pub(crate) ends: &'a Ends,
    pub(crate) limits: Limits,
    /// Wave number, in rad/m.
    pub(crate) wave_number: f64,
    /// Difference in length, in metres, below which paths over the two ends of a wall are merged. `None` to keep all
    /// separate.
    pub(crate) joined_m: Option<f64>,
}

impl EdgeSearch {
    pub(crate) fn clear(&mut self) {
        self.found.clear();
    }

    /// Finds all paths around an edge to these receivers, except those that are certainly too faint. Returns true
    /// unless the work was stopped.
    pub(crate) fn search(&mut self, query: &EdgeQuery<'_>, stop: &Stop) -> bool {
        self.choose(query);
        let Some(joined_m) = query.joined_m else { return self.search_each(query, stop) };
        // The decision to merge two paths must not depend on which of them is audible alone.
        let limits = Limits { max_length_m: query.limits.max_length_m + joined_m, ..query.limits };
        if !self.search_each(&EdgeQuery { audibility: None, limits, ..*query }, stop) {
            return false;
        }
        self.join(query, joined_m);
        self.found.retain(|path| {
            let [out, home] = [query.source, query.receivers[path.receiver as usize]].map(|end| path.at - end);
            let heard = |audibility: &Audibility| {
                audibility.may_hear_around(path.spread, path.receiver as usize, out, home, path.length_m)
            };
            path.length_m <= query.limits.max_length_m && query.audibility.is_none_or(heard)
        });
        true
    }

    /// Selects the edges around which some receiver may hear, and all edges that share a surface with one of these,
    /// since the two ends of a surface may be heard as one.
    fn choose(&mut self, query: &EdgeQuery<'_>) {
        let EdgeQuery { scene, audibility, source, receivers, .. } = *query;
        let edges = scene.edges();
        for edge in self.wanted.drain(..) {
            self.chosen[edge as usize] = NONE;
        }
        self.chosen.resize(edges.len(), NONE);
        let Some(audibility) = audibility else {
            let reach_m = query.limits.max_length_m + query.joined_m.unwrap_or(0.0);
            scene.edges_seen(source, query.ends.of_source(), reach_m, &mut self.wanted);
            return self.number();
        };
        let count = receivers.len().max(1) as f64;
        let middle = Point::from(receivers.iter().fold(Vector::zeros(), |sum, at| sum + at.coords) / count);
        let spread_m = receivers.iter().map(|at| (at - middle).norm()).fold(0.0, f64::max);
        // A more distant edge leads to no receiver on a path that is short enough.
        let loudest = MOST * LOUDEST_PANEL;
        let there_and_back_m = audibility.reach_m(loudest) + (source - middle).norm() + spread_m;
        let half = Vector::repeat((0.5 * there_and_back_m + TOUCH_M).min(3.0 * MAX_COORDINATE_M));
        let square = Aabb::new((source.coords - half).into(), (source.coords + half).into());
        for index in scene.edge_boxes().intersect_aabb(&square) {
            let edge = &edges[index as usize];
            let out = edge.at - source;
            let least_m = out.norm() + ((edge.at - middle).norm() - spread_m).max(0.0);
            if !audibility.may_ensonify(loudest, out, least_m) {
                continue;
            }
            self.wanted.push(index);
            if query.joined_m.is_some() {
                let extents = scene.extents();
                let surfaces =
                    extents.at_edge(index as usize).iter().map(|&surface| &extents.surfaces[surface as usize]);
                self.wanted.extend(surfaces.flat_map(|surface| surface.ends).flatten().filter_map(|end| end.edge));
            }
        }
        self.wanted.sort_unstable();
        self.wanted.dedup();
        self.number();
    }

    /// Numbers the selected edges.
    fn number(&mut self) {
        for (place, &edge) in (0..).zip(&self.wanted) {
            self.chosen[edge as usize] = place;
        }
    }

    fn search_each(&mut self, query: &EdgeQuery<'_>, stop: &Stop) -> bool {
        let EdgeQuery { scene, audibility, source, receivers, ends, limits, wave_number, .. } = *query;
        self.found.clear();
        if limits.max_order == 0 {
            return true;
        }
        let wanted = core::mem::take(&mut self.wanted);
        for index in wanted.iter().map(|&edge| edge as usize) {
            let edge = &scene.edges()[index];
            if stop.is_stopped() {
                self.wanted = wanted;
                return false;
            }
            let out = edge.at - source;
            let before_m = out.norm();
            let Some(from_rad) = edge.around(source).filter(|_| before_m > TOUCH_M) else { continue };
            let mut in_sight = None;
            for (receiver, &at) in receivers.iter().enumerate() {
                let home = edge.at - at;
                let after_m = home.norm();
                let length_m = before_m + after_m;
                let Some(to_rad) = edge.around(at).filter(|_| after_m > TOUCH_M) else { continue };
                let most = MOST / length_m;
                let heard = |audibility: &Audibility| audibility.may_hear_around(most, receiver, out, home, length_m);
                if length_m > limits.max_length_m || !audibility.is_none_or(heard) {
                    continue;
                }
                let sees = |from, starts| scene.mesh().sees(from, starts, edge.at, scene.triangles_at(index));
                if !*in_sight.get_or_insert_with(|| sees(source, ends.of_source())) {
                    break;
                }
                if !sees(at, ends.of_receiver(receiver)) {
                    continue;
                }
                let bent = edge_diffraction(wave_number, edge.outside_rad, from_rad, to_rad).abs();
                let spread = bent / (before_m * after_m * length_m).sqrt();
                self.found.push(EdgePath {
                    receiver: receiver as u32,
                    edge: index as u32,
                    length_m,
                    departure_rad: libm::atan2(out.y, out.x),
                    arrival_rad: libm::atan2(home.y, home.x),
                    // The series is NaN where two of its poles meet.
                    spread: if spread < most { spread } else { most },
                    unbounded: Some([spread, wave_number]),
                    at: edge.at,
                });
            }
        }
        self.wanted = wanted;
        true
    }
}

/// Upper bound relative to an undisturbed wave of the same length. It is the exact value on the limit of a shadow or of
/// a reflection, where Keller's coefficient grows without bound.
const MOST: f64 = 0.5;

#[cfg(test)]
mod tests {
    use crate::*;

    fn around(walls: Vec<Wall>, source: Point, receiver: Point) -> Vec<(f64, f64)> {
        let scene = Scene::new(walls, vec![], Air::default()).unwrap();
        let mut tracer = Tracer::new();
        tracer.edges = true;
        let mut paths = Paths::default();
        tracer.trace(&scene, source, &[receiver], Limits::order(2), &mut paths).unwrap();
        let bent = (0..paths.len()).filter(|&k| matches!(paths.bounces(k), [Bounce::Edge(_)]));
        bent.map(|k| (paths.length_m[k], paths.amplitude[k])).collect()
    }

    fn air(length_m: f64) -> f64 {
        libm::exp10(-Air::default().absorption_db_per_m(49_400.0) * length_m / 20.0)
    }

    // A pillar's corner is heard at 1 m 36.8 dB below a wall.
    #[test]
    fn pillars_corner_is_36_8_db_below_a_wall_at_1_m() {
        // The corner is at the origin with open space on three sides; the sensor is 1 m away on the bisector.
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
        let pillar: Vec<_> = Wall::polyline(&corners.map(|[x, y]| [y, x])).collect();
        let here = Point::new(-(0.5f64.sqrt()), -(0.5f64.sqrt()));
        let heard = around(pillar, here, here);
        // The two neighbouring corners are visible too, the corner behind is not.
        assert_eq!(heard.len(), 3, "{heard:?}");
        let (length_m, amplitude) = heard[0];
        let below_db = 20.0 * libm::log10(amplitude / (0.5 * air(2.0)));
        assert!((length_m - 2.0).abs() < 1e-12 && (below_db + 36.8).abs() < 0.05, "{length_m} {below_db}");
    }

    // Sound bends around a panel's end, and less in deeper shadow.
    #[test]
    fn sound_bends_less_into_deeper_shadow() {
        let panel = vec![Wall::new(0.0, -5.0, 0.0, 0.0).with_faces(Faces::Both)];
        let source = Point::new(-2.0, -0.5);
        let behind = |y: f64| around(panel.clone(), source, Point::new(2.0, y))[0];
        for (y, deeper) in [(0.4, 0.0), (0.0, -1.0), (-1.0, -3.0)] {
            let ((length_m, amplitude), (_, fainter)) = (behind(y), behind(deeper));
            assert!((length_m - (libm::hypot(2.0, 0.5) + libm::hypot(2.0, y))).abs() < 1e-12);
            assert!(amplitude > fainter, "{y}: {amplitude} {fainter}");
        }
        // Half of the wave remains exactly on the limit of the shadow.
        let (length_m, amplitude) = behind(0.5);
        assert!((amplitude - 0.5 * air(length_m) / length_m).abs() < 1e-9);
    }

    // Rooms have rows of pillars, whose corners are in line with each other and with the source.
    #[test]
    fn every_edge_in_sight_is_looked_at() {
        let mut random = Random::new(7);
        let (mut sighted, mut all) = (0, 0);
        for number in 0..60 {
            let at = |k: u32| 2.0 * f64::from(k) + if number % 2 == 0 { 0.0 } else { 0.001 * f64::from(k * k) };
            let pillar = |(x, y): (f64, f64)| {
                Wall::polyline(&[[x, y], [x, y + 1.0], [x + 1.0, y + 1.0], [x + 1.0, y], [x, y]]).collect::<Vec<_>>()
            };
            let walls = (0..5).flat_map(|x| (0..5).map(move |y| (x, y))).map(|(x, y)| (at(x), at(y))).flat_map(pillar);
            let scene = Scene::new(walls.collect(), vec![], Air::default()).unwrap();
            let source = match number % 3 {
                0 => Point::new(random.between(-3.0, 12.0), random.between(-3.0, 12.0)),
                1 => Point::new(-1.0, f64::from(number % 7)),
                _ => Point::new(1.5, random.between(-3.0, 12.0)),
            };
            let (mut starts, mut seen) = (vec![], vec![]);
            scene.mesh().containing(source, &mut starts);
            let reach_m = if number < 30 { f64::INFINITY } else { 4.0 };
            scene.edges_seen(source, &starts, reach_m, &mut seen);
            let sees = |edge: u32| {
                let at = scene.edges()[edge as usize].at;
                (at - source).norm() <= reach_m
                    && scene.mesh().sees(source, &starts, at, scene.triangles_at(edge as usize))
            };
            let in_sight: Vec<u32> = (0..scene.edges().len() as u32).filter(|&edge| sees(edge)).collect();
            assert!(in_sight.iter().all(|edge| seen.contains(edge)), "{number}: {source}");
            (sighted, all) = (sighted + in_sight.len(), all + seen.len());
        }
        assert!(sighted > 1000 && all < 3 * sighted, "{sighted} {all}");
    }

    #[test]
    fn edges_are_silent_unless_asked_for_and_behind_walls() {
        let panel = Wall::new(0.0, -1.0, 0.0, 1.0).with_faces(Faces::Both);
        let (here, screen) = (Point::new(-2.0, 0.0), Wall::new(-1.0, -2.0, -1.0, 2.0).with_faces(Faces::Both));
        assert_eq!(around(vec![panel], here, here).len(), 2);
        let screened = around(vec![panel, screen], here, here);
        assert!(screened.iter().all(|(length_m, _)| *length_m < 4.5), "the screen's own ends alone: {screened:?}");
        let scene = Scene::new(vec![panel], vec![], Air::default()).unwrap();
        assert_eq!(scene.paths(here, &[here], 1, 9.0).unwrap().len(), 1);
    }
}
