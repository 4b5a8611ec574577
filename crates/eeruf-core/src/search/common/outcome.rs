//! The three ways in which a search ends.

/// The end of a search. A search that hands its answer out elsewhere, as those for waits do, finds `()`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Outcome<T = ()> {
    /// Found.
    Found(T),
    /// Every possibility was searched or excluded: a proof that there is none, or none left.
    Exhausted,
    /// The budget was spent or the caller stopped the search: neither found nor excluded.
    BudgetSpent,
}

impl<T> Outcome<T> {
    /// Returns true if something was found.
    pub const fn is_found(&self) -> bool {
        matches!(self, Self::Found(_))
    }
}
