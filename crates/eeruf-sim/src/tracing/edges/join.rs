//! Merges paths over the two ends of one wall that differ by less than a burst: they are heard as one, by Fresnel's
//! integral between them.

use super::{EdgePath, EdgeQuery, EdgeSearch, MOST};
use crate::{
    acoustics::{LOUDEST_PANEL, panel_share},
    geometry::{Point, TOUCH_M, cross},
    scene::{End, NONE, Surface},
};

impl EdgeSearch {
    /// Removes paths over the ends of a surface that also reflects, if they arrive less than a burst later: the
    /// reflection includes them. If the point of reflection lies beside the surface, it merges the two paths into one.
    pub(super) fn join(&mut self, query: &EdgeQuery<'_>, burst_m: f64) {
        let EdgeQuery { scene, receivers, ends, .. } = *query;
        self.places.clear();
        self.places.resize(self.wanted.len() * receivers.len(), NONE);
        for (place, path) in self.found.iter().enumerate() {
            let row = self.chosen[path.edge as usize] as usize;
            self.places[row * receivers.len() + path.receiver as usize] = place as u32;
        }
        let mut gone = vec![false; self.found.len()];
        let mut joined: Vec<EdgePath> = Vec::new();
        let extents = scene.extents();
        self.surfaces.clear();
        self.surfaces.extend(self.wanted.iter().flat_map(|&edge| extents.at_edge(edge as usize)));
        self.surfaces.sort_unstable();
        self.surfaces.dedup();
        for receiver in 0..receivers.len() {
            let first = joined.len();
            for surface in self.surfaces.iter().map(|&surface| &extents.surfaces[surface as usize]) {
                let place = |end: Option<End>| {
                    let row = self.chosen[end?.edge? as usize];
                    if row == NONE {
                        return None;
                    }
                    let place = self.places[row as usize * receivers.len() + receiver];
                    (place != NONE).then_some(place as usize)
                };
                let places = surface.ends.map(place);
                if places == [None; 2] {
                    continue;
                }
                let Some(seen) = Seen::new(surface, query.source, receivers[receiver]) else { continue };
                if seen.is_reflected {
                    let late = |place: usize| self.found[place].length_m - seen.length_m >= burst_m;
                    let here = places.map(|place| place.filter(|place| !late(*place)));
                    let point = surface.on + surface.along * seen.point_m;
                    if here == [None; 2] {
                        continue;
                    }
                    scene.mesh().containing(point, &mut self.triangles);
                    let sees = |from, starts| scene.mesh().sees(from, starts, point, &self.triangles);
                    if sees(query.source, ends.of_source()) && sees(receivers[receiver], ends.of_receiver(receiver)) {
                        here.into_iter().flatten().for_each(|place| gone[place] = true);
                    }
                } else if let [Some(a), Some(b)] = places {
                    let lengths_m = [a, b].map(|place| self.found[place].length_m);
                    if (lengths_m[0] - lengths_m[1]).abs() >= burst_m {
                        continue;
                    }
                    (gone[a], gone[b]) = (true, true);
                    let near = self.found[if lengths_m[0] <= lengths_m[1] { a } else { b }];
                    let wavelength_m = core::f64::consts::TAU / query.wave_number;
                    let detours = lengths_m.map(|length_m| (length_m - seen.length_m) / wavelength_m);
                    let spread = panel_share(detours, true) / near.length_m;
                    // Both surfaces of a corner may be seen beside their points of reflection.
                    match joined[first..].iter_mut().find(|path| path.edge == near.edge) {
                        Some(path) => path.spread = (path.spread + spread).min(MOST * LOUDEST_PANEL / near.length_m),
                        None => joined.push(EdgePath { spread, unbounded: None, ..near }),
                    }
                }
            }
        }
        let mut gone = gone.into_iter();
        self.found.retain(|_| !gone.next().unwrap_or_default());
        self.found.append(&mut joined);
    }
}

/// A surface seen from its reflecting side by both source and receiver.
struct Seen {
    /// Point of reflection, as the distance in metres from the surface's point along its direction.
    point_m: f64,
    /// Length of the path over the point of reflection.
    length_m: f64,
    /// True if the surface contains the point of reflection.
    is_reflected: bool,
}

impl Seen {
    fn new(surface: &Surface, source: Point, receiver: Point) -> Option<Self> {
        let [source, receiver] = [source, receiver].map(|at| at - surface.on);
        let heights_m = [source, receiver].map(|at| cross(surface.along, at));
        if !heights_m.iter().all(|height_m| *height_m > TOUCH_M) {
            return None;
        }
        let [from_m, to_m] = [source, receiver].map(|at| at.dot(&surface.along));
        let point_m = from_m + (to_m - from_m) * heights_m[0] / (heights_m[0] + heights_m[1]);
        let [start_m, end_m] = surface.ends.map(|end| end.map(|end| (end.at - surface.on).dot(&surface.along)));
        Some(Self {
            point_m,
            length_m: libm::hypot(to_m - from_m, heights_m[0] + heights_m[1]),
            is_reflected: start_m.is_none_or(|start_m| point_m >= start_m)
                && end_m.is_none_or(|end_m| point_m <= end_m),
        })
    }
}
