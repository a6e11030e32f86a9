//! When the two touch, by what they did before.

use crate::told::crash::Told;
use crate::told::phase::{BACKED_IN, CHECKED_PHASES};
use crate::told::side::{Slant, Turning};
use recrash_model::account::{Act, ContactState, Origin};

/// When they touch, and when where more is told of what they did before. [s]
pub(crate) const CONTACT_S: f64 = 9.0;
const LATE_CONTACT_S: f64 = 12.0;

/// Each step more than are checked takes so much longer. [s]
const PHASE_S: f64 = 2.0;

/// Who drives through a junction comes along for so far, and so long at most. [m, s]
const OVER_LINE_M: f64 = 19.5;
const LATEST_CONTACT_S: f64 = 22.0;

impl Told {
    /// What the two did before, and when they touch then, as far as it can be drawn: of who comes from beside the road, or stood across it, the state says enough.
    pub(crate) fn phases(&mut self) {
        let along = matches!(
            self.origin,
            Origin::Ahead | Origin::Behind | Origin::Beside { .. } | Origin::Opposite | Origin::Cross { .. }
        );
        if !along || matches!(self.cp.slants, Some(Slant::Stood { .. })) {
            self.cp.phases.clear();
        }
        if self.cp.backs_in && self.cp.phases.is_empty() {
            self.cp.phases = BACKED_IN.to_vec();
        }
        // Who came back into the lane in which it stopped had left it before.
        let came_back = self.sv.returns && self.sv.stopped_aside == Some(Act::LaneChange);
        // So does who comes to the kerb, and is passed there.
        let to_kerb = self.sv.state == ContactState::Stopped && self.is_at_kerb() && !self.stays_at_kerb();
        let more = to_kerb || !self.sv.phases.is_empty() || !self.cp.phases.is_empty() || self.backs_out() || came_back;
        let steps = self.sv.phases.len().max(self.cp.phases.len()).saturating_sub(CHECKED_PHASES) as f64;
        self.contact_s = if more { LATE_CONTACT_S + steps * PHASE_S } else { CONTACT_S };
        // Who is slow has come over the line of its signal or sign.
        let drives = self.sv.state == ContactState::Moving && self.sv.slowed_from.is_none() && !self.sv.stood_first;
        let over_line = self.sv.control.is_some() && drives && self.origin != Origin::Behind;
        // So has who stood before its turn.
        let turns = matches!(self.sv.turning, Turning::Left | Turning::Right);
        let from_line = turns && self.sv.stood_first && self.sv.slowed_from.is_none();
        if let Some(mps) = self.sv.impact_mps.filter(|_| over_line && self.sv.turning == Turning::No || from_line) {
            self.contact_s =
                (OVER_LINE_M / mps.max(0.4)).ceil().clamp(self.contact_s, LATEST_CONTACT_S.max(self.contact_s));
        }
    }
}
