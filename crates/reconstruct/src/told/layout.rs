//! What the words tell of the road, and of the places on it, beside kinds of places and of lanes: which lane, counted from a side; which
//! strip; who stands at the kerb; which door.

use recrash_model::account::{LaneWord, LeftRight};
use recrash_model::scenario::StripKind;

/// A lane that is counted from a side of the road: "the third lane from the right".
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Counted {
    pub(crate) from: LeftRight,
    /// 1 is the outermost.
    pub(crate) number: usize,
}

impl Counted {
    /// Its number from the left, 0 is the leftmost, on a road with so many; nothing where that has fewer.
    pub(crate) fn place(self, lanes: usize) -> Option<usize> {
        match self.from {
            LeftRight::Left => (self.number <= lanes).then(|| self.number - 1),
            LeftRight::Right => lanes.checked_sub(self.number),
        }
    }

    pub(crate) fn words(self) -> String {
        let number = ["second", "third"].get(self.number.wrapping_sub(2)).unwrap_or(&"fourth");
        let side = if self.from == LeftRight::Left { "left" } else { "right" };
        format!("the {number} lane from the {side}")
    }
}

/// What is told so of one side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Standing {
    pub(crate) counted: Option<Counted>,
    /// It stands at the kerb: "was stopped at the curb".
    pub(crate) at_kerb: bool,
    /// It is parked in a lane: "double parked", "parked in-lane".
    pub(crate) in_lane: bool,
    /// It stands at the edge of the road or of its lane.
    pub(crate) lane_edge: bool,
}

/// How the ego turns at a way off the street: a driveway, an alley, or the way into a lot or a garage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OffStreet {
    Into,
    OutOf,
}

/// What is told so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Layout {
    pub(crate) sv: Standing,
    pub(crate) cp: Standing,
    /// The street is narrow; it is one-way.
    pub(crate) narrow: bool,
    pub(crate) one_way: bool,
    /// There are stalls.
    pub(crate) stalls: bool,
    /// The ego turns into a way off the street, or out of one.
    pub(crate) off_street: Option<OffStreet>,
    /// The partner turns into one.
    pub(crate) cp_into: bool,
    /// The partner comes along one that crosses: out of an alley.
    pub(crate) cp_off_street: bool,
    /// The ego is told to be at a junction.
    pub(crate) at_junction: bool,
    /// The ego is told to be in a slip lane.
    pub(crate) slip_lane: bool,
    /// Three roads meet.
    pub(crate) three_arms: bool,
    /// The partner rides or drives between two lanes: "lane-splitting".
    pub(crate) splits: bool,
    /// The partner comes over the crosswalk, or off the sidewalk; and it is told to have been beside the crosswalk.
    pub(crate) crosswalk: bool,
    pub(crate) beside_crosswalk: bool,
    /// It comes by between the ego and the kerb, or who is parked there.
    pub(crate) along_kerb: bool,
    /// The partner is told to have been right behind the ego: "directly behind".
    pub(crate) right_behind: bool,
    /// The two are told to have driven side by side.
    pub(crate) abreast: bool,
    /// A double yellow line divides it.
    pub(crate) centre_line: bool,
    /// A lane for left turns lies beside the ego's, which is told to be the left one of those that go on.
    pub(crate) turn_lane: bool,
    /// A lane lies beside the ego's on the right, which is told to be the right one of those that go on.
    pub(crate) right_lane: bool,
    /// The ego goes to turn left, and has not begun to.
    pub(crate) left_to_come: bool,
    /// The ego's green light is told to be for its turn alone.
    pub(crate) arrow: bool,
    /// Words tell that the ego's light changed, or that it waited for green.
    pub(crate) light_changes: bool,
    /// The ego is told to have turned at red: "a right turn on red".
    pub(crate) on_red: bool,
    /// The door that took part is told to be a rear one, or a front one.
    pub(crate) rear_door: Option<bool>,
    /// That door is told to have stood open when the other came.
    pub(crate) stood_open: Option<StoodOpen>,
}

/// Since when a door stands open as the other comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StoodOpen {
    /// It was opened shortly before; also of an ego's of which nobody is told to have opened it.
    Shortly,
    /// It stands so from the start: nobody is told to have opened it, and it is not the ego's.
    AllAlong,
}

/// The strip that a word for a lane tells; nothing where it tells a driving lane.
pub(crate) const fn strip_of(word: LaneWord) -> Option<StripKind> {
    match word {
        LaneWord::Bike => Some(StripKind::Bike),
        LaneWord::Shoulder => Some(StripKind::Shoulder),
        LaneWord::Curb => Some(StripKind::Parking),
        LaneWord::Sidewalk => Some(StripKind::Sidewalk),
        _ => None,
    }
}
