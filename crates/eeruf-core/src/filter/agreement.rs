//! [`Agreement`]: how many readings must agree, and for how long a missing echo is waited for.

use super::error::FilterError;

/// How many readings in a row confirm a track, and for how many firings it may then coast, in one byte.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Agreement(u8);

impl Agreement {
    /// As much as four bits hold; a track's score has as many.
    pub(super) const MAX_PATIENCE: u8 = 0b1111;

    pub(crate) const fn new(consecutive: u8, patience: u8) -> Result<Self, FilterError> {
        if consecutive < 2 || consecutive > 8 {
            return Err(FilterError::Consecutive { consecutive });
        }
        if patience > Self::MAX_PATIENCE {
            return Err(FilterError::Patience { patience });
        }
        Ok(Self(consecutive | patience << 4))
    }

    pub(super) const fn consecutive(self) -> u8 {
        self.0 & 0b1111
    }

    pub(super) const fn patience(self) -> u8 {
        self.0 >> 4
    }
}
