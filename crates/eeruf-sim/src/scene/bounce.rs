//! What a path meets on its way: one of the scene's walls, poles or edges.

/// One bounce of a path.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Bounce {
    /// At the wall with this index.
    Wall(u32),
    /// At the pole with this index.
    Pole(u32),
    /// Around the edge with this index, among [`Scene::edges`](super::Scene::edges).
    Edge(u32),
}
