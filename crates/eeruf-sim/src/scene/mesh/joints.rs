//! Joints of walls: ends that touch become one vertex of the mesh, a wall is cut where another ends on it, and walls
//! that cross or overlap are refused.

use super::Piece;
use crate::geometry::{Point, TOUCH_M, cross};
use crate::scene::error::SceneError;
use crate::scene::wall::Wall;
use parry2d_f64::{bounding_volume::Aabb, partitioning::Bvh};

/// Returns the box around a wall.
pub(crate) fn wall_box(wall: &Wall) -> Aabb {
    let (low, high) = (wall.from.inf(&wall.to), wall.from.sup(&wall.to));
    Aabb::new(low.coords.into(), high.coords.into())
}

/// Merges end points that touch and cuts walls where others end on them.
pub(crate) fn join_walls(walls: &[Wall], boxes: &Bvh) -> Result<(Vec<Point>, Vec<Piece>), SceneError> {
    // Corner 2 i is the start of wall i, 2 i + 1 its end; `same` maps a corner to the first corner at its place.
    let corner = |c: usize| {
        if c.is_multiple_of(2) { walls[c / 2].from } else { walls[c / 2].to }
    };
    let mut same: Vec<usize> = (0..2 * walls.len()).collect();
    let mut cuts: Vec<(usize, usize)> = Vec::new();
    for (b, wall) in walls.iter().enumerate() {
        let margin = parry2d_f64::math::Vector::splat(TOUCH_M);
        let mut grown = wall_box(wall);
        grown.mins -= margin;
        grown.maxs += margin;
        for a in boxes.intersect_aabb(&grown) {
            let a = a as usize;
            if a >= b {
                continue;
            }
            let meeting = meet(&walls[a], &walls[b]);
            let touching = meeting.joined.iter().flatten().count()
                + meeting.on_first.iter().chain(&meeting.on_second).filter(|on| **on).count();
            if touching > 1 {
                return Err(SceneError::WallsOverlap { walls: [a, b] });
            }
            for (end_a, ends) in meeting.joined.iter().enumerate() {
                if let Some(end_b) = ends {
                    let (ra, rb) = (root(&mut same, 2 * a + end_a), root(&mut same, 2 * b + end_b));
                    same[ra.max(rb)] = ra.min(rb);
                }
            }
            for end in 0..2 {
                if meeting.on_first[end] {
                    cuts.push((a, 2 * b + end));
                }
                if meeting.on_second[end] {
                    cuts.push((b, 2 * a + end));
                }
            }
            if let (0, Some(at)) = (touching, meeting.crossing) {
                return Err(SceneError::WallsCross { walls: [a, b], at: [at.x, at.y] });
            }
        }
    }

    let mut vertex_of = vec![usize::MAX; 2 * walls.len()];
    let mut vertices = Vec::new();
    for c in 0..2 * walls.len() {
        let first = root(&mut same, c);
        if vertex_of[first] == usize::MAX {
            vertex_of[first] = vertices.len();
            vertices.push(corner(first));
        }
        vertex_of[c] = vertex_of[first];
    }
    cuts.sort_unstable();
    let mut pieces = Vec::with_capacity(walls.len() + cuts.len());
    let mut cut = 0;
    let mut stops: Vec<(f64, usize)> = Vec::new();
    for (index, wall) in walls.iter().enumerate() {
        stops.clear();
        while let Some(&(_, c)) = cuts.get(cut).filter(|(cut_wall, _)| *cut_wall == index) {
            stops.push(((corner(c) - wall.from).dot(&(wall.to - wall.from)), vertex_of[c]));
            cut += 1;
        }
        stops.sort_by(|p, q| p.0.total_cmp(&q.0));
        let mut from = vertex_of[2 * index];
        for to in stops.iter().map(|stop| stop.1).chain([vertex_of[2 * index + 1]]) {
            if from != to {
                pieces.push(Piece { ends: [from, to], wall: index });
                from = to;
            }
        }
    }
    Ok((vertices, pieces))
}

fn root(same: &mut [usize], mut corner: usize) -> usize {
    while same[corner] != corner {
        same[corner] = same[same[corner]];
        corner = same[corner];
    }
    corner
}

/// The contact of two walls.
#[derive(Default)]
struct Meeting {
    /// For each end of the first wall, the end of the second to which it is joined.
    joined: [Option<usize>; 2],
    /// Ends of the second wall that lie within the first.
    on_first: [bool; 2],
    /// Ends of the first wall that lie within the second.
    on_second: [bool; 2],
    crossing: Option<Point>,
}

fn meet(a: &Wall, b: &Wall) -> Meeting {
    let mut meeting = Meeting::default();
    let (ends_a, ends_b) = ([a.from, a.to], [b.from, b.to]);
    let mut joined_b = [false; 2];
    for i in 0..2 {
        for j in 0..2 {
            if (ends_a[i] - ends_b[j]).norm() <= TOUCH_M {
                meeting.joined[i] = Some(j);
                joined_b[j] = true;
            }
        }
    }
    for end in 0..2 {
        meeting.on_first[end] = !joined_b[end] && within(a, ends_b[end]);
        meeting.on_second[end] = meeting.joined[end].is_none() && within(b, ends_a[end]);
    }
    let (u, v) = (a.to - a.from, b.to - b.from);
    let side = |along, from, point| cross(along, point - from);
    let (s0, s1) = (side(u, a.from, b.from), side(u, a.from, b.to));
    let (t0, t1) = (side(v, b.from, a.from), side(v, b.from, a.to));
    if (s0 < 0.0) != (s1 < 0.0) && (t0 < 0.0) != (t1 < 0.0) {
        meeting.crossing = Some(b.from + v * (s0 / (s0 - s1)));
    }
    meeting
}

/// Returns true if a point lies on a wall but not at its ends.
fn within(wall: &Wall, point: Point) -> bool {
    let (along, to) = (wall.to - wall.from, point - wall.from);
    let length = along.norm();
    let (s, off) = (along.dot(&to) / length, cross(along, to) / length);
    off.abs() <= TOUCH_M && s > 0.0 && s < length
}
