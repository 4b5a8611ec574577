//! Work on all cores, and how it ends early.

mod pool;
mod stop;

pub(crate) use pool::on_all_cores;
pub use pool::sweep;
pub use stop::Stop;
