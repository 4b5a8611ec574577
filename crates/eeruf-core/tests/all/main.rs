//! The paper's claims, and the searches against shared tables, slow judges and their own limits, in one binary.

mod by_hardware;
mod claims;
mod common;
mod comparing;
mod conditions_naive;
mod contract;
mod corpus;
mod edges;
mod fired;
mod flow;
#[cfg(feature = "serde")]
#[path = "../formats.rs"]
mod formats;
mod immediate;
mod lateness;
mod listening;
mod m_of_n;
mod odometry;
mod pairs;
mod plans_and_judges;
mod promises;
mod settings;
mod sound;
mod theory;
mod uncertain;
mod uneven;
mod uneven_ring;
mod wait_answers;
mod wait_limits;
mod wait_small;
mod wait_tables;
mod watch;
