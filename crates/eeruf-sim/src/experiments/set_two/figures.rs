//! A method's figures over the courses of Set II.

use serde::Serialize;

use super::run::{Ending, Run};
use crate::experiments::spread::share_95;

/// A method's figures over all courses; shares are fractions of 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Number of courses.
    pub courses: usize,
    /// Number of courses finished without contact.
    pub finished: usize,
    /// 95 % confidence interval of the share of finished courses, by Wilson's interval.
    pub finished_95: [f64; 2],
    /// Number of courses in which the robot touched something.
    pub contacts: usize,
    /// Number of courses in which the robot was stuck, or too slow.
    pub timed_out: usize,
    /// Way over time of all courses together, in m/s.
    pub mean_speed_m_s: f64,
    /// The highest speed in any course, in m/s.
    pub top_speed_m_s: f64,
    /// Distance of the nearest pole from the robot's outline: the mean over the courses, in metres.
    pub nearest_m: f64,
    /// Share of all readings that were accepted and wrong.
    pub wrong_of_all: f64,
    /// Share of all readings that were not accepted.
    pub rejected: f64,
    /// Echoes entered into the grid where there is no object, on average per course.
    pub phantom_echoes: f64,
    /// Cells of the grid that are certain at the end although there is no object, on average per course.
    pub phantom_cells: f64,
    /// Share of the poles within 1 m of the robot's way that it never saw.
    pub poles_missed: f64,
    /// Accepted readings per second, all sensors together.
    pub readings_per_s: f64,
}

impl Figures {
    /// Returns the figures of one method's runs.
    pub fn of(runs: &[Run]) -> Self {
        let ended = |ending| runs.iter().filter(|run| run.ending == ending).count();
        let sum = |value: fn(&Run) -> f64| runs.iter().map(value).sum::<f64>();
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        let courses = runs.len() as f64;
        let (readings, rejected) = (sum(|run| run.readings.into()), sum(|run| run.rejected.into()));
        Self {
            courses: runs.len(),
            finished: ended(Ending::Finished),
            finished_95: share_95(ended(Ending::Finished), runs.len()),
            contacts: ended(Ending::Contact),
            timed_out: ended(Ending::TimeOut),
            mean_speed_m_s: share(sum(|run| run.way_m), sum(|run| run.time_s)),
            top_speed_m_s: runs.iter().map(|run| run.top_speed_m_s).fold(0.0, f64::max),
            nearest_m: share(sum(|run| if run.nearest_m.is_finite() { run.nearest_m } else { 0.0 }), courses),
            wrong_of_all: share(sum(|run| run.wrong.into()), readings),
            rejected: share(rejected, readings),
            phantom_echoes: share(sum(|run| run.phantom_echoes.into()), courses),
            phantom_cells: share(sum(|run| run.phantom_cells.into()), courses),
            poles_missed: share(sum(|run| run.poles_missed.into()), sum(|run| run.poles_passed.into())),
            readings_per_s: share(readings - rejected, sum(|run| run.time_s)),
        }
    }
}
