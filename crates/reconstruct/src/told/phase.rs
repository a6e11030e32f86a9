//! What somebody did, in steps: it stood, drove or reversed.

/// A part of the way to the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Phase {
    Stands,
    Drives,
    Reverses,
}

impl Phase {
    const fn word(self) -> &'static str {
        match self {
            Self::Stands => "stood",
            Self::Drives => "drove",
            Self::Reverses => "reversed",
        }
    }
}

/// So many phases are checked, and drawn in any case, the last one counted.
pub(crate) const CHECKED_PHASES: usize = 4;

/// The last of them, which are checked.
pub(crate) fn checked(phases: &[Phase]) -> &[Phase] {
    phases.split_at(phases.len().saturating_sub(CHECKED_PHASES)).1
}

/// For sentences.
pub(crate) fn words(phases: &[Phase]) -> String {
    phases.iter().map(|phase| phase.word()).collect::<Vec<_>>().join(", ")
}

/// What somebody did who backed into a space: it came along, stood beside it, and reversed.
pub(super) const BACKED_IN: [Phase; 3] = [Phase::Drives, Phase::Stands, Phase::Reverses];
