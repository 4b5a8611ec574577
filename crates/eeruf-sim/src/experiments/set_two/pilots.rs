//! Pilots: one set of parameters for every method, or one for each.

use core::fmt;
use core::str::FromStr;

use super::own_pilots::OWN;
use crate::{
    methods::Method,
    navigation::{Piloting, Vfh},
};

/// A choice of pilots.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[non_exhaustive]
pub enum Pilots {
    /// Each method has its own pilot, the default. All were found by a search with the same effort, on courses below
    /// 2,000, scored equally alone, behind a second robot and ahead of one.
    #[default]
    Own,
    /// One pilot for all, which an earlier search optimised mainly for `eeruf`. Its figures show the success of each
    /// method with a pilot made for EERUF, not which method is best.
    Shared,
    /// The published vector field histogram for all, [`Vfh::default`], with echoes entered from up to 2.0 m.
    Published,
    /// The published pilot with the grid's growth rate operator ([`Himm::growth`](crate::Himm::growth)).
    PublishedGro,
    /// A given pilot for all.
    Given(Piloting),
}

impl Pilots {
    /// The pilots that have names.
    pub const NAMED: [Self; 4] = [Self::Own, Self::Shared, Self::Published, Self::PublishedGro];

    /// Returns the name in the program and in Python; `given` for a given pilot.
    pub const fn as_str(&self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Shared => "shared",
            Self::Published => "published",
            Self::PublishedGro => "published-gro",
            Self::Given(_) => "given",
        }
    }

    /// Returns the pilot of a method.
    pub fn of(&self, method: Method) -> Piloting {
        let published = Piloting { vfh: Vfh::default(), turn_gain: 3.0, range_m: 2.0, growth: false };
        match *self {
            Self::Own => OWN.iter().find(|(of, _)| *of == steered_as(method)).map_or(published, |(_, own)| *own),
            Self::Shared => Piloting::SHARED,
            Self::Published => published,
            Self::PublishedGro => Piloting { growth: true, ..published },
            Self::Given(piloting) => piloting,
        }
    }
}

/// Returns the method whose pilot is used. A method that fires like another uses that method's pilot; any other method
/// without its own uses the pilot of one by one.
fn steered_as(method: Method) -> Method {
    match method {
        Method::AdaptiveMultiEcho => Method::MultiEcho,
        Method::FlowMultiEcho => Method::Flow,
        _ if OWN.iter().any(|(of, _)| *of == method) => method,
        _ => Method::Sequential,
    }
}

impl fmt::Display for Pilots {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for Pilots {
    type Err = UnknownPilot;

    /// ```
    /// use eeruf_sim::experiments::set_two::Pilots;
    /// assert_eq!("published-gro".parse(), Ok(Pilots::PublishedGro));
    /// let error = "mine".parse::<Pilots>().unwrap_err();
    /// assert_eq!(error.to_string(), "no pilot `mine`; expected own, shared, published, published-gro");
    /// ```
    fn from_str(name: &str) -> Result<Self, UnknownPilot> {
        let named = Self::NAMED.into_iter().find(|pilots| pilots.as_str() == name);
        named.ok_or_else(|| UnknownPilot(name.to_owned()))
    }
}

/// An unknown name of a pilot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownPilot(pub String);

impl fmt::Display for UnknownPilot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = Pilots::NAMED.map(|pilots| pilots.as_str()).join(", ");
        write!(f, "no pilot `{}`; expected {names}", self.0)
    }
}

impl core::error::Error for UnknownPilot {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_is_steered_by_exactly_one_pilot() {
        let methods: Vec<_> = OWN.iter().map(|(method, _)| *method).collect();
        let tuned: Vec<_> = Method::ALL.into_iter().filter(|&method| steered_as(method) == method).collect();
        assert_eq!(methods, tuned);
        assert!(Method::ALL.into_iter().all(|method| methods.contains(&steered_as(method))));
        for method in [Method::SequentialVotes, Method::Blocking, Method::Arrays, Method::Table] {
            assert_eq!(steered_as(method), Method::Sequential);
        }
    }
}
