//! An independent check of the paths: plain image sources over all wall sequences, followed back from the receiver with
//! parry's ray casts. It shares no code with the beam tree; it is slow, and reports doubtful cases.

use crate::random::{free_point, scene};
use eeruf_sim::{Air, Bounce, Faces, Point, Pole, Random, Scene, Wall};
use parry2d_f64::{
    math::Vector,
    query::{Ray, RayCast},
    shape::Segment,
};

/// Change of the walls' length that must not change the answer; otherwise a path is doubtful. Parry's hit points are
/// good to 1e-7 m, and rays aimed at corners may leak.
const MARGIN_M: f64 = 1e-6;

#[derive(Clone, Copy, PartialEq)]
enum Answer {
    Yes,
    No,
    Doubtful,
}

fn mirrored(wall: &Wall, point: Point) -> Point {
    let along = (wall.to - wall.from).normalize();
    let to = point - wall.from;
    wall.from + along * (2.0 * along.dot(&to)) - to
}

fn left_of(wall: &Wall, point: Point) -> f64 {
    let (along, to) = ((wall.to - wall.from).normalize(), point - wall.from);
    along.x * to.y - along.y * to.x
}

fn grown(wall: &Wall, by: f64) -> Segment {
    let along = (wall.to - wall.from).normalize() * by;
    Segment::new((wall.from - along).coords.into(), (wall.to + along).coords.into())
}

/// Returns true if the segment crosses no wall except the two that it connects.
fn free(walls: &[Wall], from: Point, to: Point, skip: [Option<usize>; 2]) -> Answer {
    let way = to - from;
    let length = way.norm();
    let ray = Ray::new(Vector::new(from.x, from.y), Vector::new(way.x / length, way.y / length));
    let blocked = |by: f64, reach: f64| {
        let others = walls.iter().enumerate().filter(|(w, _)| !skip.contains(&Some(*w)));
        others.into_iter().any(|(_, wall)| grown(wall, by).cast_local_ray(&ray, reach, true).is_some())
    };
    match (blocked(MARGIN_M, length + MARGIN_M), blocked(-MARGIN_M, length - MARGIN_M)) {
        (false, _) => Answer::Yes,
        (true, true) => Answer::No,
        (true, false) => Answer::Doubtful,
    }
}

/// Follows one wall sequence back from the receiver.
fn unfold(walls: &[Wall], images: &[Point], sequence: &[usize], receiver: Point) -> Answer {
    let mut at = receiver;
    let mut last = None;
    let mut answer = Answer::Yes;
    for (depth, &w) in sequence.iter().enumerate().rev() {
        let wall = &walls[w];
        let target = images[depth + 1];
        // The real point must be on the reflecting side, the image behind it.
        let (here, there) = (left_of(wall, at), left_of(wall, target));
        let side = if wall.faces == Faces::Both { here.signum() } else { 1.0 };
        if here * side <= 0.0 || there * side >= 0.0 {
            return if (here * side).abs().min((there * side).abs()) < MARGIN_M {
                Answer::Doubtful
            } else {
                Answer::No
            };
        }
        let hit = at + (target - at) * (here / (here - there));
        let along = (wall.to - wall.from).normalize();
        let s = along.dot(&(hit - wall.from));
        let inside = s.min(wall.length_m() - s);
        if inside < -MARGIN_M {
            return Answer::No;
        }
        if inside < MARGIN_M {
            answer = Answer::Doubtful;
        }
        match free(walls, at, hit, [last, Some(w)]) {
            Answer::No => return Answer::No,
            Answer::Doubtful => answer = Answer::Doubtful,
            Answer::Yes => {}
        }
        at = hit;
        last = Some(w);
    }
    match free(walls, at, images[0], [last, None]) {
        Answer::Yes => answer,
        other => other,
    }
}

/// Bounces and length of a path.
type Found = (Vec<Bounce>, f64);
type Sequences = Vec<Found>;

/// Asserts equal sequences with equal lengths; returns their number.
fn assert_agree(mut ours: Sequences, mut expected: Sequences, setting: impl Fn() -> String) -> usize {
    ours.sort_by(|a, b| a.0.cmp(&b.0));
    expected.sort_by(|a, b| a.0.cmp(&b.0));
    let alike = |(o, e): (&Found, &Found)| o.0 == e.0 && (o.1 - e.1).abs() < 1e-9;
    let same = ours.len() == expected.len() && ours.iter().zip(&expected).all(alike);
    assert!(same, "{}\n{ours:?}\n{expected:?}", setting());
    ours.len()
}

/// Returns all paths of a receiver as (sequence, length); `None` if one of them is doubtful.
fn image_sources(scene: &Scene, source: Point, receiver: Point, max_order: usize) -> Option<Sequences> {
    let walls = scene.walls();
    let mut found = Vec::new();
    let mut images = vec![source];
    let mut sequence: Vec<usize> = Vec::new();
    // The loop counts through all sequences up to the order, like digits.
    let mut next = 0;
    loop {
        if next == 0 {
            match unfold(walls, &images, &sequence, receiver) {
                Answer::Yes => {
                    let bounces = sequence.iter().map(|w| Bounce::Wall(*w as u32)).collect();
                    found.push((bounces, (receiver - images[images.len() - 1]).norm()));
                }
                Answer::Doubtful => return None,
                Answer::No => {}
            }
        }
        let deeper = sequence.len() < max_order;
        let candidate =
            (next..walls.len()).find(|w| deeper && walls[*w].faces != Faces::Open && sequence.last() != Some(w));
        if let Some(w) = candidate {
            images.push(mirrored(&walls[w], images[images.len() - 1]));
            sequence.push(w);
            next = 0;
        } else if let Some(w) = sequence.pop() {
            images.pop();
            next = w + 1;
        } else {
            return Some(found);
        }
    }
}

// Beam tree and image sources agree on thousands of random rooms.
#[test]
fn beam_tree_agrees_with_image_sources() {
    let mut random = Random::from_state(7);
    let (mut rooms, mut doubtful, mut paths) = (0, 0, 0);
    while rooms < 3000 {
        // Every tenth room is large, at a low order.
        let scene = scene(&mut random, if rooms % 10 == 0 { 40 } else { 7 });
        let order = match scene.walls().len() {
            ..=6 => 4,
            7..=14 => 3,
            _ => 2,
        };
        let (source, receiver) = (free_point(&mut random, &scene), free_point(&mut random, &scene));
        let Some(expected) = image_sources(&scene, source, receiver, order) else {
            doubtful += 1;
            continue;
        };
        rooms += 1;
        let found = scene.paths(source, &[receiver], order as u32, f64::INFINITY).unwrap();
        let ours = (0..found.len()).map(|k| (found.bounces(k).to_vec(), found.length_m[k]));
        paths += assert_agree(ours.collect(), expected, || format!("{:?}, {source} to {receiver}", scene.walls()));
    }
    assert!(doubtful < rooms / 50, "{doubtful} of {rooms} rooms were doubtful");
    assert!(paths > 20_000, "only {paths} paths compared");
}

/// Finds the point of a circle where a broken line bounces with equal angles, by plain search: the way over the circle
/// is shortest there.
fn shortest_over(from: Point, to: Point, pole: &Pole) -> Option<Point> {
    let at = |angle: f64| pole.centre + eeruf_sim::Vector::new(angle.cos(), angle.sin()) * pole.radius_m;
    let way = |angle: f64| (at(angle) - from).norm() + (to - at(angle)).norm();
    let steps = 720;
    let step = std::f64::consts::TAU / f64::from(steps);
    let best = (0..steps).map(|k| f64::from(k) * step).min_by(|a, b| way(*a).total_cmp(&way(*b)))?;
    let (mut low, mut high) = (best - step, best + step);
    while high - low > 1e-9 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if way(a) < way(b) { high = b } else { low = a }
    }
    let point = at(low);
    let normal = point - pole.centre;
    (normal.dot(&(from - point)) > 0.0 && normal.dot(&(to - point)) > 0.0).then_some(point)
}

#[test]
fn pole_paths_agree_with_a_plain_search_over_image_sources() {
    let mut random = Random::from_state(11);
    let (mut rooms, mut doubtful, mut paths) = (0, 0, 0);
    while rooms < 150 {
        let bare = scene(&mut random, 5);
        let (source, receiver) = (free_point(&mut random, &bare), free_point(&mut random, &bare));
        let axis = free_point(&mut random, &bare);
        let pole = Pole::new(axis.x, axis.y, random.between(0.004, 0.05));
        let walls = bare.walls().to_vec();
        let far = |p: Point| (p - axis).norm() > 2.0 * pole.radius_m;
        // The pole is well clear of the walls and of the two points, so that the search is well behaved.
        let clear = walls.iter().all(|wall| {
            let along = wall.to - wall.from;
            let s = (along.dot(&(axis - wall.from)) / along.norm_squared()).clamp(0.0, 1.0);
            far(wall.from + along * s)
        });
        if !(clear && far(source) && far(receiver)) {
            continue;
        }
        let mut sequences: Vec<Vec<usize>> = vec![vec![]];
        for w in 0..walls.len() {
            sequences.push(vec![w]);
            sequences.extend((0..walls.len()).filter(|v| *v != w).map(|v| vec![w, v]));
        }
        sequences.retain(|sequence| sequence.iter().all(|w| walls[*w].faces != Faces::Open));
        let images = |start: Point, sequence: &[usize]| {
            let mut images = vec![start];
            for &w in sequence {
                images.push(mirrored(&walls[w], images[images.len() - 1]));
            }
            images
        };
        let mut expected = Vec::new();
        let mut unsure = false;
        for before in &sequences {
            let out = images(source, before);
            for after in sequences.iter().filter(|after| before.len() + after.len() < 3) {
                let home = images(receiver, after);
                let (from, to) = (out[out.len() - 1], home[home.len() - 1]);
                let Some(hit) = shortest_over(from, to, &pole) else {
                    continue;
                };
                match (unfold(&walls, &out, before, hit), unfold(&walls, &home, after, hit)) {
                    (Answer::No, _) | (_, Answer::No) => {}
                    (Answer::Yes, Answer::Yes) => {
                        let wall = |w: &usize| Bounce::Wall(*w as u32);
                        let bounces: Vec<_> = before
                            .iter()
                            .map(wall)
                            .chain([Bounce::Pole(0)])
                            .chain(after.iter().rev().map(wall))
                            .collect();
                        expected.push((bounces, (hit - from).norm() + (to - hit).norm()));
                    }
                    _ => unsure = true,
                }
            }
        }
        if unsure {
            doubtful += 1;
            continue;
        }
        rooms += 1;
        let with_pole = Scene::new(walls, vec![pole], Air::default()).unwrap();
        let found = with_pole.paths(source, &[receiver], 3, f64::INFINITY).unwrap();
        let ours = (0..found.len()).map(|k| (found.bounces(k).to_vec(), found.length_m[k]));
        let over_pole = ours.filter(|path| path.0.contains(&Bounce::Pole(0)));
        paths += assert_agree(over_pole.collect(), expected, || {
            format!("{:?}, {pole:?}, {source} to {receiver}", with_pole.walls())
        });
    }
    assert!(doubtful < rooms, "{doubtful} of {rooms} rooms were doubtful");
    assert!(paths > 1000, "only {paths} paths compared");
}
