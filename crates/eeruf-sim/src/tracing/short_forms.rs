//! Short form of the query: one source in a scene.

use super::error::PathsError;
use super::limits::Limits;
use super::paths::Paths;
use super::tracer::Tracer;
use crate::geometry::Point;
use crate::scene::Scene;

impl Scene {
    /// Finds every specular path from a source to each receiver at
    /// [`DEFAULT_FREQUENCY_HZ`](super::DEFAULT_FREQUENCY_HZ). Use [`Tracer::trace`] to reuse memory between queries.
    ///
    /// # Errors
    /// See [`Tracer::trace`].
    ///
    /// ```
    /// use eeruf_sim::{Air, Point, Scene, Wall};
    /// let room = Wall::polyline(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]]).collect();
    /// let scene = Scene::new(room, vec![], Air::default())?;
    /// let paths = scene.paths(Point::new(1.0, 1.0), &[Point::new(2.5, 1.2)], 6, f64::INFINITY)?;
    /// assert_eq!(paths.len(), 1 + 2 * 6 * 7); // one for each image of a rectangle
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn paths(
        &self,
        source: Point,
        receivers: &[Point],
        max_order: u32,
        max_length_m: f64,
    ) -> Result<Paths, PathsError> {
        let mut paths = Paths::default();
        Tracer::new().trace(self, source, receivers, Limits { max_order, max_length_m }, &mut paths)?;
        Ok(paths)
    }
}
