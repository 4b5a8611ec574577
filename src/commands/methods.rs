//! Methods that a command simulates, and the settings of time hopping, by their names on the command line.

use clap::ValueEnum;
use eeruf_core::hopping::HoppingSettings;
use eeruf_sim::Method;

/// Those asked for, in the order of the tables; if none is named the usual ones, and those of sketches if `sketched`.
pub(crate) fn chosen(asked: &[Method], sketched: bool) -> Vec<Method> {
    let usual = |method: &Method| asked.is_empty() && !method.is_on_demand() && (sketched || !method.is_sketch());
    Method::ALL.into_iter().filter(|method| usual(method) || asked.contains(method)).collect()
}

/// The named settings of time hopping.
#[derive(Clone, Copy, clap::ValueEnum)]
pub(crate) enum Hopping {
    /// For most robots
    Balanced,
    /// For robots that must stop early
    Quick,
    /// For robots that drive: no solo periods, and lags stay
    Driving,
    /// For maps: confirmed echoes alone
    Maps,
}

impl Hopping {
    /// The name on the command line.
    pub(crate) fn name(self) -> String {
        // No value is skipped.
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }

    pub(crate) fn settings(self) -> HoppingSettings {
        match self {
            Self::Balanced => HoppingSettings::BALANCED,
            Self::Quick => HoppingSettings::QUICK,
            Self::Driving => HoppingSettings::DRIVING,
            Self::Maps => HoppingSettings::MAPS,
        }
    }
}
