//! Objects in a scene: shared between a `Scene` and the `Paths` found in it.

use std::sync::{Arc, Mutex};

use eeruf_sim::{Scene, Tracer, World};

/// Walls alone, or a world with robots.
pub(crate) enum Objects {
    Walls(Box<Scene>),
    World(Arc<World>),
}

/// The objects, and the buffers of the last tracer, which are as large as the scene.
pub(crate) struct Contents {
    objects: Objects,
    pub(crate) tracer: Mutex<Tracer>,
}

impl From<Objects> for Contents {
    fn from(objects: Objects) -> Self {
        Self { objects, tracer: Mutex::default() }
    }
}

impl Contents {
    pub(crate) fn scene(&self) -> &Scene {
        match &self.objects {
            Objects::Walls(scene) => scene,
            Objects::World(world) => world.scene(),
        }
    }

    /// The world, if there are robots.
    pub(crate) fn world(&self) -> Option<&Arc<World>> {
        match &self.objects {
            Objects::Walls(_) => None,
            Objects::World(world) => Some(world),
        }
    }
}
