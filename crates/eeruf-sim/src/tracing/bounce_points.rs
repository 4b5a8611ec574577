//! Points at which a path bounces, for drawing and for checks.

use crate::{
    geometry::{Mirror, Point, alhazen, alhazen_twice},
    scene::{Bounce, Scene},
};

impl Scene {
    /// Returns the corners of a path in the plan: source, every bounce except at floor and ceiling, receiver. `bounces`
    /// must belong to a path between the two points that was found in this scene; otherwise the result is empty or
    /// meaningless.
    ///
    /// ```
    /// use eeruf_sim::{Air, Point, Scene, Wall};
    /// let scene = Scene::new(vec![Wall::new(-9.0, 0.0, 9.0, 0.0)], vec![], Air::default())?;
    /// let (source, receiver) = (Point::new(0.0, 1.0), Point::new(1.0, 1.0));
    /// let paths = scene.paths(source, &[receiver], 1, f64::INFINITY)?;
    /// let corners = scene.bounce_points(source, receiver, paths.bounces(1)).unwrap();
    /// assert!((corners[1] - Point::new(0.5, 0.0)).norm() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn bounce_points(&self, source: Point, receiver: Point, bounces: &[Bounce]) -> Option<Vec<Point>> {
        let bounces = Bounce::in_plan(bounces);
        let mirrors = |bounces: &[Bounce]| -> Option<Vec<&Mirror>> {
            let walls = bounces.iter().map(|bounce| match *bounce {
                Bounce::Wall(wall) => self.mirrors().get(wall as usize),
                _ => None,
            });
            walls.collect()
        };
        let pole = |bounce: &Bounce| match *bounce {
            Bounce::Pole(pole) => self.poles().get(pole as usize).map(|pole| (pole.centre, pole.radius_m)),
            _ => None,
        };
        let mut corners = vec![source];
        if let [Bounce::Edge(edge)] = *bounces {
            corners.extend([self.edges().get(edge as usize)?.at, receiver]);
            return Some(corners);
        }
        let Some(first) = bounces.iter().position(|bounce| matches!(bounce, Bounce::Pole(_))) else {
            unfold(source, &mirrors(bounces)?, receiver, &mut corners);
            corners.push(receiver);
            return Some(corners);
        };
        let (before, rest) = bounces.split_at(first);
        let circle = pole(rest.first()?)?;
        if let Some(second) = rest.get(1).and_then(pole) {
            let (one, two) = alhazen_twice(source, receiver, circle, second)?;
            corners.extend([one.point, two.point, receiver]);
            return Some(corners);
        }
        let (before, mut after) = (mirrors(before)?, mirrors(rest.get(1..)?)?);
        after.reverse();
        let hit = alhazen(image(source, &before), image(receiver, &after), circle.0, circle.1)?.point;
        unfold(source, &before, hit, &mut corners);
        corners.push(hit);
        let mut back = vec![receiver];
        unfold(receiver, &after, hit, &mut back);
        corners.extend(back.into_iter().rev());
        Some(corners)
    }
}

/// Corners of paths, with reusable memory.
#[derive(Debug, Default)]
pub(super) struct Corners {
    images: Vec<Point>,
    corners: Vec<Point>,
}

impl Corners {
    /// Returns the corners of a path that was found in a scene; see [`Scene::bounce_points`].
    pub(super) fn of(&mut self, scene: &Scene, source: Point, receiver: Point, bounces: &[Bounce]) -> Option<&[Point]> {
        self.corners.clear();
        if !bounces.iter().all(|bounce| matches!(bounce, Bounce::Wall(_))) {
            self.corners.extend(scene.bounce_points(source, receiver, bounces)?);
            return Some(&self.corners);
        }
        let mirror = |bounce: &Bounce| match *bounce {
            Bounce::Wall(wall) => scene.mirrors().get(wall as usize),
            _ => None,
        };
        self.images.clear();
        let mut at = source;
        for bounce in bounces {
            let mirror = mirror(bounce)?;
            at = mirror.image(at, mirror.distance(at));
            self.images.push(at);
        }
        self.corners.push(receiver);
        let mut at = receiver;
        for (bounce, &target) in bounces.iter().zip(&self.images).rev() {
            let mirror = mirror(bounce)?;
            let (here, there) = (mirror.distance(at), mirror.distance(target));
            at += (target - at) * (here / (here - there));
            self.corners.push(at);
        }
        self.corners.push(source);
        self.corners.reverse();
        Some(&self.corners)
    }
}

/// Returns the first and the last corner of each part of a path in which walls are only mirrors. Poles and edges
/// separate parts, because sound spreads again there.
pub(super) fn parts(bounces: &[Bounce]) -> impl Iterator<Item = (usize, usize)> + '_ {
    let corners = (1..).zip(bounces).filter(|(_, bounce)| !matches!(bounce, Bounce::Wall(_))).map(|(corner, _)| corner);
    let last = bounces.len() + 1;
    corners.chain([last]).scan(0, |start, end| Some((core::mem::replace(start, end), end)))
}

fn image(start: Point, mirrors: &[&Mirror]) -> Point {
    mirrors.iter().fold(start, |at, mirror| mirror.image(at, mirror.distance(at)))
}

/// Appends the bounces from `start` over the mirrors to `end`.
fn unfold(start: Point, mirrors: &[&Mirror], end: Point, corners: &mut Vec<Point>) {
    let first = corners.len();
    let mut at = end;
    for depth in (0..mirrors.len()).rev() {
        let target = image(start, &mirrors[..=depth]);
        let (here, there) = (mirrors[depth].distance(at), mirrors[depth].distance(target));
        at += (target - at) * (here / (here - there));
        corners.push(at);
    }
    corners[first..].reverse();
}
