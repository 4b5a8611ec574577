//! Output: tables, JSON, pictures, and the progress of a long task.
//!
//! Uses the libraries and `files`; knows nothing of commands and their arguments.

pub(crate) mod bounces;
pub(crate) mod design;
pub(crate) mod diagnose;
pub(crate) mod draw;
pub(crate) mod experiment;
pub(crate) mod json;
pub(crate) mod paths;
pub(crate) mod percent;
pub(crate) mod questions;
pub(crate) mod replay;
pub(crate) mod replay_flow;
pub(crate) mod rooms;
pub(crate) mod search;
pub(crate) mod study;
pub(crate) mod survey;
pub(crate) mod table;
pub(crate) mod three;
pub(crate) mod timing;
pub(crate) mod verify;
pub(crate) mod watch;
