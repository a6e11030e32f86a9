//! Who stands or drives over a line of the road, and how far inside of that its middle is.

use crate::told::crash::Told;
use crate::told::phase::Phase;
use crate::told::side::{Side, Turning};
use recrash_model::account::{Act, Astride, AstrideWhen, ContactState, LaneLine, Origin};

/// The middle of who is over a line is so far inside of that. [m]
pub(crate) const INSIDE_M: f64 = 0.3;

impl Told {
    /// Whether one of the two stands partly in the lane beside which it would be parked.
    pub(crate) fn is_partly_in_lane(&self, of_ego: bool) -> bool {
        let side = if of_ego { &self.sv } else { &self.cp };
        let steps = side.phases.first().is_none_or(|phase| *phase == Phase::Stands);
        // Who stops on its way to another lane is between that and its own.
        let changes = side.stopped_aside == Some(Act::LaneChange);
        let stands = side.state.stands() && steps && side.turning == Turning::No && !changes;
        stands && side.is_over(LaneLine::Edge)
    }

    /// Over which line the ego stands that does not leave its own line for that.
    pub(crate) fn stands_over(&self) -> Option<Astride> {
        let plain = self.sv.state.stands() && self.sv.turning == Turning::No && self.sv_aside().is_none();
        self.sv.astride.filter(|over| if over.line == LaneLine::Edge { self.is_partly_in_lane(true) } else { plain })
    }

    /// Whether the partner drives over a line when the story begins, or stands over it and passes from there; over the edge of the lanes it
    /// comes so from behind alone, else it comes out from there.
    pub(crate) fn cp_drives_over(&self) -> bool {
        let behind = self.origin == Origin::Behind;
        let over = |over: Astride| {
            let first = over.when == AstrideWhen::Start || over.when == AstrideWhen::Stop && self.cp.stood_first;
            first && (behind || over.line != LaneLine::Edge)
        };
        let drives = self.cp.state == ContactState::Moving && self.cp.turning == Turning::No && self.thing.is_none();
        drives && self.cp.astride.is_some_and(over)
    }

    /// Whether it does so, and not between its lane and the ego's, past that.
    pub(crate) fn comes_over_line(&self) -> bool {
        self.cp_drives_over() && self.splits_lanes().is_none()
    }
}

impl Side {
    pub(crate) fn is_over(&self, line: LaneLine) -> bool {
        self.astride.is_some_and(|over| over.line == line)
    }
}
