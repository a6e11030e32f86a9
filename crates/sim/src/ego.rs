//! Which driver the subject vehicle gets: one of the simulator's own, or somebody outside.

use std::fmt;
use std::str::FromStr;

/// The subject vehicle's driver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Ego {
    /// MetaDrive's `IDMPolicy` with its quirks.
    MetadriveIdm,
    /// The intelligent driver model in SI units; sees crossing traffic and gives way.
    Idm,
    /// A competent and careful human driver, after UN Regulation No. 157.
    Reference,
    /// Whoever drove in the record: the scenario's own plan of the ego, to the end.
    Recorded,
}

impl Ego {
    /// Those that can be a system under test: they decide for themselves.
    pub const DRIVERS: [Self; 3] = [Self::MetadriveIdm, Self::Idm, Self::Reference];

    /// All of them.
    pub const ALL: [Self; 4] = [Self::MetadriveIdm, Self::Idm, Self::Reference, Self::Recorded];

    /// Their names, in the same order.
    pub const NAMES: [&'static str; 4] = ["metadrive-idm", "idm", "reference", "recorded"];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::MetadriveIdm => "metadrive-idm",
            Self::Idm => "idm",
            Self::Reference => "reference",
            Self::Recorded => "recorded",
        }
    }
}

impl fmt::Display for Ego {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Who sits in the ego's seat.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seat {
    /// A driver of the simulator's own.
    BuiltIn(Ego),
    /// Whoever gives the controls to [`crate::Run::step`].
    Outside,
}

/// No ego of that name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownEgo(pub String);

impl fmt::Display for UnknownEgo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = Ego::NAMES.join(", ");
        write!(f, "no ego is called `{}`; there are: {names}; a program is cmd:PROGRAM, Python py:MODULE:NAME", self.0)
    }
}

impl std::error::Error for UnknownEgo {}

impl FromStr for Ego {
    type Err = UnknownEgo;

    fn from_str(name: &str) -> Result<Self, UnknownEgo> {
        Self::ALL.into_iter().find(|ego| ego.name() == name).ok_or_else(|| UnknownEgo(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ego_is_found_by_its_name() {
        for (ego, name) in Ego::ALL.into_iter().zip(Ego::NAMES) {
            assert_eq!(name.parse(), Ok(ego));
            assert_eq!(ego.to_string(), name);
        }
        assert!("human".parse::<Ego>().unwrap_err().to_string().contains("metadrive-idm, idm, reference, recorded"));
    }
}
