//! [`Run`]: one geometry of Set I under one method.

use serde::{Deserialize, Serialize};

use super::step::Steps;
use crate::results::Summary;

/// The result of one geometry under one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// The geometry's number, which seeds all that is random.
    pub seed: u64,
    /// The figures of the alcove as it is.
    pub summary: Summary,
    /// Those of its back wall going to and fro.
    #[serde(flatten)]
    pub steps: Steps,
}
