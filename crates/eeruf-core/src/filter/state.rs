//! [`TrackState`]: how sure the filter is of one echo.

use super::agreement::Agreement;

/// The state of one echo's track, in one byte: whether it is confirmed, and its score. The score grows by one with each
/// firing that the echo is in, and shrinks by one with each that it is missing from. The greater of two is the better.
///
/// A track that is not confirmed ends when its echo is missing once. So every confirmed track began with firings in a
/// row. Crosstalk repeats in firings of one phase only, and no two of these come in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct TrackState(u8);

impl TrackState {
    /// There is no track.
    pub(super) const NONE: Self = Self(0);
    const SCORE: u8 = Agreement::MAX_PATIENCE;
    const CONFIRMED: u8 = 1 << 4;
    /// After the first firing.
    pub(super) const NEW: Self = Self(1);

    const fn score(self) -> u8 {
        self.0 & Self::SCORE
    }

    pub(super) const fn is_confirmed(self) -> bool {
        self.0 & Self::CONFIRMED != 0
    }

    /// After a firing that the echo is in.
    pub(super) fn seen(self, agreement: Agreement) -> Self {
        let most = agreement.consecutive().max(agreement.patience());
        let score = (self.score() + 1).min(most);
        let confirmed = if score >= agreement.consecutive() { Self::CONFIRMED } else { self.0 & Self::CONFIRMED };
        Self(score | confirmed)
    }

    /// After a firing that the echo is missing from: coasting, or ended.
    pub(super) const fn missed(self) -> Self {
        if self.score() > 1 { Self(self.0 - 1) } else { Self::NONE }
    }
}
