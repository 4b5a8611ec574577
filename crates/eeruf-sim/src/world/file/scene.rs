//! The walls, poles and air of a world file.

use eeruf_files::FileError;
use toml::Spanned;

use super::format::{WorldFile, material};
use super::source::Source;
use crate::scene::{Air, Material, Pole, Scene, SceneError, Wall};

/// Builds the scene.
pub(super) fn scene(source: &Source, file: &WorldFile) -> Result<Scene, FileError> {
    let mut walls = Vec::new();
    // Entry of the file that each wall comes from.
    let mut entries = Vec::new();
    for (index, entry) in file.walls.iter().enumerate() {
        let wall = entry.get_ref();
        if wall.points_m.len() < 2 {
            let message = format!("points_m has {}; expected at least 2 points", wall.points_m.len());
            return Err(source.error(Some(entry.span()), "points_m", message));
        }
        let mut corners = wall.points_m.clone();
        if wall.closed == Some(true) {
            corners.push(corners[0]);
        }
        let material = material(Material::SMOOTH, wall.material, wall.reflection, wall.roughness_m);
        let faces = wall.faces.unwrap_or_default();
        walls.extend(Wall::polyline(&corners).map(|piece| piece.with_faces(faces).with_material(material)));
        entries.resize(walls.len(), index);
    }
    let poles = file.poles.iter().map(|entry| {
        let pole = entry.get_ref();
        let material = material(Material::PERFECT, pole.material, pole.reflection, pole.roughness_m);
        Pole { material, ..Pole::new(pole.at_m[0], pole.at_m[1], pole.radius_m) }
    });
    let air = file.air.as_ref().map_or(Air::default(), |air| *air.get_ref());
    let room = file.height.as_ref().and_then(|height| height.get_ref().room());
    let scene = Scene::new(walls, poles.collect(), air).and_then(|scene| scene.with_room(room));
    scene.map_err(|error| {
        let wall = |wall: usize| entries.get(wall).and_then(|&entry| file.walls.get(entry)).map(Spanned::span);
        let pole = |pole: usize| file.poles.get(pole).map(Spanned::span);
        let (part, field) = match error {
            SceneError::WallCoordinate { wall: index, .. }
            | SceneError::WallTooShort { wall: index, .. }
            | SceneError::WallsCross { walls: [_, index], .. }
            | SceneError::WallsOverlap { walls: [_, index] } => (wall(index), "points_m"),
            SceneError::WallMaterial { wall: index } => (wall(index), "reflection"),
            SceneError::Pole { pole: index, .. } | SceneError::SamePole { poles: [_, index] } => (pole(index), "at_m"),
            SceneError::PoleMaterial { pole: index } => (pole(index), "reflection"),
            SceneError::Air { quantity, .. } => (file.air.as_ref().map(Spanned::span), quantity),
            SceneError::Ceiling { .. } => (file.height.as_ref().map(Spanned::span), "ceiling_m"),
            SceneError::RoomMaterial { surface } => (file.height.as_ref().map(Spanned::span), surface),
            _ => (None, ""),
        };
        source.error(part, field, error)
    })
}
