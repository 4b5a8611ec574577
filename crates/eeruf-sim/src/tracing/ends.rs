//! The ends of the paths of one query.

use crate::{geometry::Point, scene::Mesh};

/// The triangles around the source and around each receiver of a query, found once.
#[derive(Debug, Default)]
pub(crate) struct Ends {
    /// Triangles of the source, then of each receiver.
    triangles: Vec<u32>,
    /// For each point, the end of its triangles in the list.
    until: Vec<usize>,
    around: Vec<u32>,
}

impl Ends {
    /// Finds the triangles. All points must be covered by the mesh.
    pub(crate) fn find(&mut self, mesh: &Mesh, source: Point, receivers: &[Point]) {
        self.triangles.clear();
        self.until.clear();
        for &at in core::iter::once(&source).chain(receivers) {
            mesh.containing(at, &mut self.around);
            self.triangles.extend_from_slice(&self.around);
            self.until.push(self.triangles.len());
        }
    }

    pub(crate) fn of_source(&self) -> &[u32] {
        &self.triangles[..self.until[0]]
    }

    pub(crate) fn of_receiver(&self, receiver: usize) -> &[u32] {
        &self.triangles[self.until[receiver]..self.until[receiver + 1]]
    }
}
