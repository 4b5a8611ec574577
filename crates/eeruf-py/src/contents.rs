//! Objects in a scene: shared between a `Scene` and the `Paths` found in it.

use std::sync::Arc;

use eeruf_sim::{Scene, World};

/// Walls alone, or a world with robots.
pub(crate) enum Contents {
    Walls(Box<Scene>),
    World(Arc<World>),
}

impl Contents {
    pub(crate) fn scene(&self) -> &Scene {
        match self {
            Self::Walls(scene) => scene,
            Self::World(world) => world.scene(),
        }
    }

    /// The world, if there are robots.
    pub(crate) fn world(&self) -> Option<&Arc<World>> {
        match self {
            Self::Walls(_) => None,
            Self::World(world) => Some(world),
        }
    }
}
