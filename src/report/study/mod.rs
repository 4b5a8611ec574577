//! Result of a study: printed, as JSON, and drawn.

pub(crate) mod fooled;
pub(crate) mod found;
pub(crate) mod json;
pub(crate) mod pictures;
pub(crate) mod text;
