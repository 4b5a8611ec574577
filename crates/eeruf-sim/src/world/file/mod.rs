//! Worlds in TOML files: walls, poles, air, robots, noise and seed. Errors are reported in one line: file, line, field,
//! value, expectation.

mod fault;
mod format;
mod ring_file;
mod robot;
mod scene;
mod sketch;
mod source;
mod write;

use core::ops::Range;
use std::path::Path;

use eeruf_files::FileError;
use toml::Spanned;

use super::error::WorldError;
use super::fault::Fault;
use super::noise::Noise;
use super::robot::Robot;
use super::world::World;
use crate::{acoustics::Physics, scene::Scene};
use fault::fault;
use format::WorldFile;
use ring_file::no_reader;
use robot::robot;
use scene::scene;
use source::Source;

pub use ring_file::{ReadRing, cover_motion};
pub use write::{heading_rad, world_file};

impl World {
    /// Reads a world from a TOML file. Schedules that it names are searched for in its folder; ring files need a
    /// [reader](Self::from_text_with).
    ///
    /// # Errors
    /// The first error found.
    pub fn from_toml(file: &Path) -> Result<Self, FileError> {
        Self::parse(&Source::read(file)?, no_reader)
    }

    /// Reads a text; `file` is named in errors, and schedules are searched for in its folder.
    ///
    /// # Errors
    /// See [`from_toml`](Self::from_toml).
    ///
    /// ```
    /// use eeruf_sim::World;
    /// let text = "
    ///     [[wall]]
    ///     points_m = [[2, -1], [2, 1]]
    ///     [[robot]]
    ///     pose = { x_m = 0, y_m = 0 }
    ///     ring = { sensors = 65, spacing_deg = 5, radius_m = 0.3 }
    /// ";
    /// let error = World::from_text("pillars.toml".as_ref(), text).unwrap_err();
    /// assert_eq!(error.to_string(), "pillars.toml, line 6: robot 1 has 65 sensors; expected 1 to 64");
    /// ```
    pub fn from_text(file: &Path, text: &str) -> Result<Self, FileError> {
        Self::from_text_with(file, text, no_reader)
    }

    /// Reads a text, with a reader for ring files that robots name, which are also searched for in the file's folder.
    ///
    /// # Errors
    /// See [`from_toml`](Self::from_toml).
    pub fn from_text_with(file: &Path, text: &str, read_ring: ReadRing) -> Result<Self, FileError> {
        Self::parse(&Source { file: file.to_owned(), text: text.to_owned() }, read_ring)
    }

    fn parse(source: &Source, read_ring: ReadRing) -> Result<Self, FileError> {
        let file: WorldFile = source.toml()?;
        let WorldParts { scene, robots, noise, physics, max_order, seed, faults } =
            WorldParts::of(source, &file, read_ring)?;
        let world = Self::new(scene, robots, noise)
            .and_then(|world| world.with_physics(physics))
            .and_then(|world| world.with_max_order(max_order))
            .and_then(|world| world.with_faults(faults));
        world.map(|world| world.with_seed(seed)).map_err(|error| {
            let (part, field) = blame(&file, &error);
            source.error(part, field, error)
        })
    }
}

/// Contents of a world file, which may have no robots. Robots and noise are not yet checked against the scene.
#[derive(Debug)]
pub struct WorldParts {
    /// Walls, poles and air.
    pub scene: Scene,
    /// The robots, if there are any.
    pub robots: Vec<Robot>,
    /// The noise.
    pub noise: Noise,
    /// The effects.
    pub physics: Physics,
    /// Largest number of bounces of sound.
    pub max_order: u32,
    /// Seed of all random values.
    pub seed: u64,
    /// The faults.
    pub faults: Vec<Fault>,
}

impl WorldParts {
    /// Reads the parts from a text; `file` is named in errors, and schedules are searched for in its folder.
    ///
    /// # Errors
    /// Errors of [`World::from_text`] about the text or the scene.
    ///
    /// ```
    /// use eeruf_sim::WorldParts;
    /// let parts = WorldParts::from_text("pole.toml".as_ref(), "[[pole]]\nat_m = [1, 2]\nradius_m = 0.1")?;
    /// assert_eq!((parts.scene.poles().len(), parts.robots.len()), (1, 0));
    /// let again = WorldParts::from_text("again.toml".as_ref(), &parts.to_toml())?;
    /// assert_eq!(again.to_toml(), parts.to_toml());
    /// # Ok::<(), eeruf_files::FileError>(())
    /// ```
    pub fn from_text(file: &Path, text: &str) -> Result<Self, FileError> {
        Self::from_text_with(file, text, no_reader)
    }

    /// Reads a text, with a reader for ring files that robots name, which are also searched for in the file's folder.
    ///
    /// # Errors
    /// See [`World::from_text`].
    pub fn from_text_with(file: &Path, text: &str, read_ring: ReadRing) -> Result<Self, FileError> {
        let source = Source { file: file.to_owned(), text: text.to_owned() };
        Self::of(&source, &source.toml()?, read_ring)
    }

    fn of(source: &Source, file: &WorldFile, read_ring: ReadRing) -> Result<Self, FileError> {
        let scene = scene(source, file)?;
        let mut robots = Vec::new();
        for (index, entry) in file.robots.iter().enumerate() {
            robots.push(robot(source, index, entry, file.firing.as_ref(), read_ring)?);
        }
        let noise = file.noise.as_ref().map_or(Noise::default(), |noise| *noise.get_ref());
        let physics = match &file.physics {
            None => Physics::DEFAULT,
            Some(entry) => {
                entry.get_ref().physics().map_err(|error| source.error(Some(entry.span()), "preset", error))?
            }
        };
        let faults = file.faults.iter().enumerate().map(|(index, entry)| fault(source, index, entry));
        let faults = faults.collect::<Result<_, _>>()?;
        Ok(Self { scene, robots, noise, physics, max_order: file.max_order, seed: file.seed, faults })
    }

    /// Writes this world as a scene file; see [`world_file`].
    pub fn to_toml(&self) -> String {
        world_file(&self.scene, &self.robots, &self.noise, &self.physics, self.max_order, self.seed, &self.faults)
    }
}

/// Returns the part of the file to which an error belongs, and its field.
fn blame(file: &WorldFile, error: &WorldError) -> (Option<Range<usize>>, &'static str) {
    let robot = |robot: usize| file.robots.get(robot).map(Spanned::span);
    match *error {
        WorldError::Sensors { robot: index, .. } => (robot(index), "ring"),
        WorldError::Field { robot: index, field, .. } => (robot(index), field),
        WorldError::Fault { fault, field, .. } => (file.faults.get(fault).map(Spanned::span), field),
        WorldError::Schedule { robot: index, .. } => (robot(index), "schedule"),
        WorldError::Window { robot: index, .. } => (robot(index), "window_us"),
        WorldError::Contact { robot: index, .. }
        | WorldError::SensorContact { robot: index, .. }
        | WorldError::SensorInside { robot: index, .. }
        | WorldError::Bodies { robots: (_, index) }
        | WorldError::Overlap { robots: (_, index), .. } => (robot(index), "pose"),
        WorldError::Physics { field, .. } => (file.physics.as_ref().map(Spanned::span), field),
        WorldError::Noise { field, .. } => (file.noise.as_ref().map(Spanned::span), field),
        WorldError::Order { .. } => (Some(0..usize::MAX), "max_order"),
        WorldError::Scene(_) | WorldError::Robots { .. } => (None, ""),
    }
}
