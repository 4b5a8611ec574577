//! The ways of firing that Set III compares: methods, and time hopping by other settings.

use core::fmt;
use core::str::FromStr;

use eeruf_core::hopping::HoppingSettings;
use serde::{Serialize, Serializer};

use crate::methods::{Method, UnknownMethod};

/// A method, or time hopping for robots that drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// A method by its usual settings.
    Method(Method),
    /// [`Method::EerufHopping`] by [`HoppingSettings::DRIVING`].
    Driving,
}

impl Way {
    /// The ways that are compared unless others are asked for.
    pub const USUAL: [Self; 8] = [
        Self::Method(Method::Simultaneous),
        Self::Method(Method::Sequential),
        Self::Method(Method::SequentialVotes),
        Self::Method(Method::Dither),
        Self::Method(Method::Eeruf),
        Self::Method(Method::EerufHopping),
        Self::Driving,
        Self::Method(Method::Flow),
    ];

    /// The name in the program, in JSON and in Python.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Method(method) => method.as_str(),
            Self::Driving => "driving",
        }
    }

    /// The method.
    pub const fn method(self) -> Method {
        match self {
            Self::Method(method) => method,
            Self::Driving => Method::EerufHopping,
        }
    }

    /// Settings of time hopping, if it hops.
    pub const fn hopping(self) -> HoppingSettings {
        match self {
            Self::Method(_) => HoppingSettings::BALANCED,
            Self::Driving => HoppingSettings::DRIVING,
        }
    }
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl Serialize for Way {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

impl FromStr for Way {
    type Err = UnknownMethod;

    /// ```
    /// use eeruf_sim::{Method, experiments::set_three::Way};
    /// assert_eq!("driving".parse(), Ok(Way::Driving));
    /// assert_eq!("eeruf".parse(), Ok(Way::Method(Method::Eeruf)));
    /// assert!("fast".parse::<Way>().is_err());
    /// ```
    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        if name == Self::Driving.as_str() { Ok(Self::Driving) } else { name.parse().map(Self::Method) }
    }
}
