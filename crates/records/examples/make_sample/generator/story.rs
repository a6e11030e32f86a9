//! The kinds of conflict: what the columns say, and the ways to tell it.
//!
//! Words in braces are filled in by `telling.rs`: `{sv}` the subject vehicle, `{cp}` the partner when first named, `{it}`
//! the partner after that, `{heading}` and `{cp_heading}` compass directions, `{street}` and `{cross}` the two roads,
//! `{at}` and `{cp_at}` a speed or nothing, `{llane}` a lane that has a neighbour on its right, `{rlane}` one that has a
//! neighbour on its left, `{lane}` any. A first letter in upper case asks for one in the text.

use recrash_model::template::Movement::{self, LeftTurn, RightTurn, Straight};
use recrash_model::template::RoadType::{self, Highway, Intersection, TrafficCircle};
use recrash_model::zones::ContactZone::{self, Front, FrontLeft, FrontRight, Left, Rear, RearLeft, RearRight, Right};

/// Where the partner comes from, seen from the subject vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum From {
    Same,
    Opposite,
    Left,
    Right,
}

/// Who can be the partner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Partners {
    Any,
    Motor,
    Light,
    Riders,
    Trucks,
}

/// One kind of conflict.
pub struct Story {
    pub road: RoadType,
    pub sv: Movement,
    pub cp: Movement,
    pub work_zone: bool,
    /// How many usable rows tell it.
    pub rows: usize,
    pub from: From,
    pub partners: Partners,
    /// Least and greatest speed of the subject vehicle. [mi/h]
    pub sv_mph: (u32, u32),
    /// Least and greatest speed of the partner. [mi/h]
    pub cp_mph: (u32, u32),
    /// Zones hit, on the subject vehicle and on the partner.
    pub contacts: &'static [(&'static [ContactZone], &'static [ContactZone])],
    pub tellings: &'static [&'static str],
}

type Contacts = &'static [(&'static [ContactZone], &'static [ContactZone])];

const REAR_OF_SV: Contacts = &[
    (&[Rear], &[Front]),
    (&[RearLeft, Rear, RearRight], &[FrontLeft, Front, FrontRight]),
    (&[RearLeft], &[FrontRight]),
    (&[Rear, RearRight], &[FrontLeft, Front]),
];
const FROM_LEFT: Contacts = &[
    (&[Left], &[Front]),
    (&[FrontLeft, Left], &[Front, FrontRight]),
    (&[Front], &[Right]),
    (&[Front, FrontLeft], &[FrontRight]),
    (&[RearLeft], &[Front]),
];
const FROM_RIGHT: Contacts = &[
    (&[Right], &[Front]),
    (&[Right, FrontRight], &[FrontLeft, Front]),
    (&[Front], &[Left]),
    (&[Front, FrontRight], &[FrontLeft]),
    (&[RearRight], &[Front]),
];
const CUT_IN_FROM_LEFT: Contacts =
    &[(&[FrontLeft], &[RearRight]), (&[FrontLeft], &[Right]), (&[FrontLeft, Left], &[RearRight, Right])];
const CUT_IN_FROM_RIGHT: Contacts =
    &[(&[FrontRight], &[RearLeft]), (&[FrontRight], &[Left]), (&[Right, FrontRight], &[Left, RearLeft])];
const DRIFT_FROM_LEFT: Contacts = &[(&[Left], &[Right]), (&[Left, RearLeft], &[Right, FrontRight])];
const DRIFT_FROM_RIGHT: Contacts = &[(&[Right], &[Left]), (&[RearRight, Right], &[FrontLeft, Left])];

const fn at_intersection(sv: Movement, cp: Movement, rows: usize) -> Story {
    Story {
        road: Intersection,
        sv,
        cp,
        work_zone: false,
        rows,
        from: From::Same,
        partners: Partners::Motor,
        sv_mph: (4, 28),
        cp_mph: (8, 40),
        contacts: REAR_OF_SV,
        tellings: &[],
    }
}

/// Every kind of conflict of the usable rows. The rows add up to the paper's template counts.
pub const STORIES: &[Story] = &[
    // Intersection, straight and straight: 104.
    Story {
        sv_mph: (0, 3),
        cp_mph: (2, 14),
        tellings: &[
            "{Sv} was stopped at a red light on {heading} {street} at {cross}, second in line. The light changed, {sv} began to roll, and {cp} behind it moved off faster and ran into it.",
            "Waiting at the signal on {heading} {street}, {sv} had just started forward on green when {cp} that had been standing behind it drove into its back{cp_at}.",
            "{Sv} was {heading} on {street} in {lane} and had come to a halt for the red signal at {cross}. {Cp} approaching from behind did not stop in time.",
            "After stopping at the stop sign on {street}, {sv} crept forward to see past a parked trailer. {Cp} following it looked left for cross traffic, moved up and bumped it from behind.",
            "{Sv} pulled away from a stop sign, {heading} on {street}, then paused for a person stepping off the curb. {Cp} behind kept rolling{cp_at}.",
            "Traffic on {street} was queued at {cross}. {Sv} advanced one car length with the queue, stopped, and was struck from behind by {cp}.",
        ],
        ..at_intersection(Straight, Straight, 20)
    },
    Story {
        sv_mph: (3, 22),
        cp_mph: (10, 35),
        tellings: &[
            "{Sv} was {heading} on {street} in {lane}{at}. The light at {cross} turned yellow, {sv} slowed to stop, and {cp} following closely hit it from behind{cp_at}.",
            "As {sv} neared {cross} on a green light it braked for a dog that ran off the median. {Cp} behind it braked late and made contact.",
            "While approaching a crosswalk on {heading} {street}, {sv} slowed for two pedestrians. {Cp} in the same lane did not slow down.",
            "{Sv} braked for an ambulance that was crossing the intersection of {street} and {cross} with its siren on. {Cp} behind {sv} could not stop and rear-ended it.",
            "{Sv} let a bus merge back into {lane} just before {cross}. The driver of {cp} behind it was said to be looking at a phone and ran into the rear of {sv}{cp_at}.",
        ],
        ..at_intersection(Straight, Straight, 12)
    },
    Story {
        from: From::Left,
        contacts: FROM_LEFT,
        cp_mph: (15, 45),
        tellings: &[
            "{Sv} was {heading} on {street} in {lane} and entered the intersection with {cross} on a green light{at}. {Cp} traveling {cp_heading} on {cross} ran the red light{cp_at} and came from the left into the path of {sv}.",
            "With a green light, {sv} proceeded straight across {cross}{at}. {Cp} came from its left without stopping for the red signal.",
            "{Sv} had made a full stop at the four-way stop of {street} and {cross} and went ahead as its turn came. {Cp} coming {cp_heading} from the left rolled through its own stop sign{cp_at}.",
            "{Sv} was crossing {cross}{at}. A parked moving van hid {cp}, which entered from the left{cp_at} against a stop sign. {Sv} braked hard, but the two still met.",
            "While {sv} was going straight on {heading} {street} under a green signal, {cp} on {cross} approached from the left{cp_at}, tried to beat the changing light and entered the intersection about one second after its signal had gone red.",
            "The signals at {street} and {cross} were dark after a power cut. {Sv} stopped, then proceeded. {Cp} from the left did not treat the junction as an all-way stop and entered{cp_at}.",
        ],
        ..at_intersection(Straight, Straight, 20)
    },
    Story {
        from: From::Right,
        contacts: FROM_RIGHT,
        cp_mph: (12, 45),
        tellings: &[
            "{Sv} traveling {heading} on {street} entered the intersection at {cross} on green{at}. From the right, {cp} {cp_heading} on {cross} ran a red light{cp_at}.",
            "{Sv} was passing through the intersection of {street} and {cross} in {lane}. {Cp} entered from the right side street past its stop sign{cp_at} and the two collided.",
            "At the all-way stop of {street} and {cross}, {sv} arrived first and proceeded. {Cp} arriving from its right did not stop.",
            "As {sv} crossed {cross} with the light in its favor{at}, {cp} came out from behind a stopped truck on the right, {cp_heading}, and crossed in front of it.",
            "{Sv} entered on a stale green, {heading} on {street}. {Cp} on {cross}, {cp_heading}, set off early from the right before its own light was green, and reached the lane of {sv} first.",
            "{Street} has the right of way at {cross}. {Sv} was going straight on{at} when {cp} failed to yield at the yield sign on the right and pulled out in front of it{cp_at}.",
        ],
        ..at_intersection(Straight, Straight, 20)
    },
    Story {
        contacts: CUT_IN_FROM_LEFT,
        sv_mph: (8, 28),
        cp_mph: (15, 38),
        tellings: &[
            "{Sv} was {heading} in {rlane} of {street} on a green light{at}. {Cp} in the lane to its left sped up{cp_at}, and inside the intersection with {cross} changed lanes to the right directly in front of it.",
            "Just past the stop line at {cross}, {cp} overtook {sv} on the left and cut in so closely that it touched the left front of {sv}.",
            "{Sv} was going straight in {rlane}. {Cp} came out of the left turn lane at the last moment and moved right into the lane of {sv}{cp_at}.",
        ],
        ..at_intersection(Straight, Straight, 8)
    },
    Story {
        contacts: CUT_IN_FROM_RIGHT,
        sv_mph: (8, 28),
        cp_mph: (15, 38),
        tellings: &[
            "{Sv} was {heading} in {llane} of {street}{at}. {Cp} in the lane to its right met a double-parked car near {cross} and swerved left into the lane of {sv}.",
            "A right-turn-only lane ends at {cross}. {Cp} in that lane went straight on instead and merged left into {sv}, which was proceeding in {llane} under a green light{at}.",
            "{Cp} passed {sv} on the right{cp_at} and changed lanes to the left in front of it in the middle of the intersection. {Sv} braked but could not open the gap.",
        ],
        ..at_intersection(Straight, Straight, 6)
    },
    Story {
        contacts: DRIFT_FROM_LEFT,
        sv_mph: (6, 25),
        cp_mph: (8, 30),
        tellings: &[
            "{Sv} and {cp} crossed the intersection side by side, {heading}, {sv} in {rlane}. The lane lines shift there, and the partner, on the left, drifted over into the lane of {sv} and scraped along it.",
            "While {sv} was proceeding straight through {cross}{at}, {cp} to its left drifted right over the dashed line.",
        ],
        ..at_intersection(Straight, Straight, 4)
    },
    Story {
        contacts: DRIFT_FROM_RIGHT,
        sv_mph: (6, 25),
        cp_mph: (8, 30),
        partners: Partners::Any,
        tellings: &[
            "{Cp} traveling next to {sv} on the right moved left around an open car door at {cross} and sideswiped {sv}, which was holding its lane{at}.",
            "{Sv} was {heading} in {llane} of {street}. {Cp} on its right drifted across the lane line in the intersection and rubbed against it.",
        ],
        ..at_intersection(Straight, Straight, 4)
    },
    Story {
        from: From::Right,
        partners: Partners::Riders,
        contacts: &[(&[Front], &[Left]), (&[FrontRight], &[Left]), (&[Right], &[Front])],
        sv_mph: (2, 18),
        cp_mph: (6, 16),
        tellings: &[
            "{Sv} had a green light on {heading} {street}{at}. {Cp} left the sidewalk on the right and rode across the crosswalk against the signal{cp_at}.",
            "{Sv} was leaving a stop sign at {cross} when {cp} came from the right on the wrong side of the road and crossed in front of it.",
        ],
        ..at_intersection(Straight, Straight, 4)
    },
    Story {
        from: From::Left,
        partners: Partners::Light,
        contacts: &[(&[Front], &[Right]), (&[FrontLeft], &[Right]), (&[Left], &[Front])],
        sv_mph: (2, 18),
        cp_mph: (6, 18),
        tellings: &[
            "{Cp} going {cp_heading} on {cross} ran the red light from the left{cp_at} while {sv} was crossing on green{at}.",
            "{Sv} was about halfway through the intersection, {heading}, when {cp} emerged from the left between stopped cars.",
        ],
        ..at_intersection(Straight, Straight, 4)
    },
    Story {
        sv_mph: (6, 20),
        cp_mph: (0, 8),
        contacts: &[(&[Front], &[Rear]), (&[FrontLeft, Front, FrontRight], &[RearLeft, Rear, RearRight])],
        tellings: &[
            "{Sv} was following {cp} through {cross}{at}. Its driver stopped abruptly for a squirrel, and {sv} braked but touched its rear.",
        ],
        ..at_intersection(Straight, Straight, 2)
    },
    // Intersection, subject vehicle straight, partner left: 32.
    Story {
        from: From::Opposite,
        cp_mph: (8, 22),
        sv_mph: (12, 34),
        contacts: &[
            (&[Front], &[Right]),
            (&[FrontLeft], &[FrontRight]),
            (&[FrontLeft, Left], &[Front]),
            (&[Front, FrontLeft], &[RearRight]),
        ],
        tellings: &[
            "{Sv} was {heading} on {street} in {lane} and entered {cross} on a green light{at}. {Cp} coming {cp_heading} the other way turned left across its path{cp_at}.",
            "An oncoming driver in {cp} waiting to turn left from {street} onto {cross} misjudged the gap and turned in front of {sv}, which was going straight on{at}.",
            "{Sv} proceeded through the intersection on yellow. {Cp} facing it began an unprotected left turn and crossed its lane.",
            "{Cp}, {cp_heading} on {street}, made a left turn without yielding to {sv}, which was crossing {cross} with a green light.",
        ],
        ..at_intersection(Straight, LeftTurn, 13)
    },
    Story {
        from: From::Left,
        cp_mph: (6, 20),
        contacts: &[(&[FrontLeft], &[Right]), (&[FrontLeft, Left], &[FrontRight]), (&[Left], &[Front, FrontRight])],
        tellings: &[
            "{Sv} was {heading} in {lane} of {street}{at}. {Cp} stopped at the stop sign on {cross}, to the left, then turned left into the lane of {sv} without waiting for it to pass.",
            "{Cp} coming from the left on {cross} turned left onto {heading} {street} against a red light{cp_at} and merged into the side of {sv}, which had green.",
            "As {sv} crossed the intersection, {cp} entered from its left, making a left turn to go the same way as {sv}, and swung wide into its lane.",
        ],
        ..at_intersection(Straight, LeftTurn, 8)
    },
    Story {
        from: From::Right,
        cp_mph: (6, 20),
        contacts: &[(&[Front], &[Left]), (&[FrontRight], &[FrontLeft]), (&[Right, FrontRight], &[Front])],
        tellings: &[
            "{Cp} came out of {cross} on the right, {cp_heading}, to turn left onto {street}, and crossed in front of {sv}, which was proceeding {heading} on a green light{at}.",
            "{Sv} was going straight through the intersection when {cp} ran the stop sign on the right{cp_at} and turned left across its lane.",
            "A driver in {cp} waved through by a third car made a left turn from the right-hand side street and did not see {sv} coming in {lane}.",
        ],
        ..at_intersection(Straight, LeftTurn, 7)
    },
    Story {
        cp_mph: (5, 18),
        sv_mph: (6, 24),
        contacts: &[(&[FrontRight], &[Left]), (&[Front, FrontRight], &[FrontLeft, Left])],
        tellings: &[
            "{Sv} was in {llane} going straight on through {cross}{at}. {Cp} in the lane to its right turned left from there, across the front of {sv}.",
            "From the lane on the right of {sv}, {cp} began a left turn onto {cross} where only straight travel is allowed, and cut off {sv}.",
        ],
        ..at_intersection(Straight, LeftTurn, 4)
    },
    // Intersection, subject vehicle left, partner straight: 24, and 2 in work zones.
    Story {
        from: From::Opposite,
        sv_mph: (3, 15),
        cp_mph: (15, 42),
        contacts: &[(&[Right], &[Front]), (&[FrontRight], &[FrontLeft]), (&[RearRight, Right], &[Front])],
        tellings: &[
            "{Sv} was making a left turn from {heading} {street} onto {cross} on a green arrow{at}. {Cp} coming {cp_heading} ran the red light{cp_at} and struck it.",
            "While {sv} was completing an unprotected left turn at {cross}, {cp} coming the other way sped up to make the yellow light and hit it on the passenger side.",
            "{Sv} waited in the intersection for a gap, then turned left as the signal went red. Oncoming, {cp} entered late{cp_at}.",
        ],
        ..at_intersection(LeftTurn, Straight, 9)
    },
    Story {
        partners: Partners::Any,
        sv_mph: (3, 14),
        cp_mph: (10, 30),
        contacts: &[(&[Left], &[Right]), (&[FrontLeft], &[FrontRight]), (&[FrontLeft, Left], &[Right, FrontRight])],
        tellings: &[
            "{Sv} was turning left from the left turn lane of {street} onto {cross}{at}. {Cp} behind it crossed the double yellow line and tried to pass on the left.",
            "With its turn signal on, {sv} began a left turn at {cross}. {Cp} overtook it on the left{cp_at} and the two touched.",
        ],
        ..at_intersection(LeftTurn, Straight, 6)
    },
    Story {
        from: From::Right,
        sv_mph: (4, 15),
        contacts: &[(&[RearRight], &[Front]), (&[Right], &[FrontLeft]), (&[RearRight, Right], &[Front, FrontLeft])],
        tellings: &[
            "{Sv} had stopped at the stop sign and was turning left onto {cross}. {Cp}, {cp_heading} on {cross}, came from the right{cp_at} and struck it before the turn was finished.",
            "{Sv} was turning left on a green light{at} when {cp} ran the red light from the right.",
        ],
        ..at_intersection(LeftTurn, Straight, 4)
    },
    Story {
        from: From::Left,
        sv_mph: (2, 12),
        contacts: &[(&[Left], &[Front]), (&[FrontLeft], &[Front, FrontRight])],
        tellings: &[
            "{Sv} nosed out of {street} to turn left onto {cross}. {Cp} coming {cp_heading} from the left did not slow down{cp_at} and hit it.",
            "On a green light {sv} started a left turn{at}. From its left, {cp} entered the intersection against the red signal.",
        ],
        ..at_intersection(LeftTurn, Straight, 3)
    },
    Story {
        sv_mph: (0, 5),
        cp_mph: (4, 18),
        tellings: &[
            "{Sv} was in the left turn lane of {heading} {street}, inching forward behind a gap in oncoming traffic. {Cp} behind it moved off as if to follow and hit it from behind.",
        ],
        ..at_intersection(LeftTurn, Straight, 2)
    },
    Story {
        work_zone: true,
        from: From::Opposite,
        sv_mph: (4, 12),
        cp_mph: (12, 30),
        contacts: &[(&[Right, FrontRight], &[Front]), (&[FrontRight], &[FrontLeft])],
        tellings: &[
            "Road work narrows {street} to one lane each way at {cross}, with cones along the center line. {Sv} was turning left through an opening in the cones{at} when {cp} coming the other way, {cp_heading}, entered the intersection{cp_at} on a late yellow.",
            "Traffic cones closed the left turn lane at {cross}. {Sv} made its left turn from the through lane as the signs ask. Oncoming, {cp} went straight on and struck it.",
        ],
        ..at_intersection(LeftTurn, Straight, 2)
    },
    // Intersection, subject vehicle right, partner straight: 16.
    Story {
        sv_mph: (0, 4),
        cp_mph: (3, 15),
        tellings: &[
            "{Sv} had pulled up to the line to turn right on red from {street}, moved a little, and stopped for a cyclist. {Cp} behind it drove on and hit it from behind{cp_at}.",
            "{Sv} was turning right onto {cross} and paused for pedestrians in the crosswalk. {Cp} following it did not.",
        ],
        ..at_intersection(RightTurn, Straight, 4)
    },
    Story {
        from: From::Left,
        sv_mph: (3, 12),
        contacts: &[(&[RearLeft], &[FrontRight]), (&[Left], &[Front]), (&[FrontLeft, Left], &[Front, FrontRight])],
        tellings: &[
            "{Sv} was making a right turn from {street} onto {cross}{at} after a full stop. {Cp} coming {cp_heading} on {cross} from the left changed into the near lane at that moment and struck it.",
            "On a green light {sv} turned right. {Cp} came from the left{cp_at} having run the red light, and hit it in the turn.",
        ],
        ..at_intersection(RightTurn, Straight, 5)
    },
    Story {
        partners: Partners::Light,
        sv_mph: (3, 11),
        cp_mph: (8, 20),
        contacts: &[(&[Right], &[Left]), (&[FrontRight], &[FrontLeft]), (&[Right, FrontRight], &[Front, FrontLeft])],
        tellings: &[
            "{Sv} was turning right onto {cross} with its signal on{at}. {Cp} tried to pass between it and the curb on the right{cp_at}.",
            "{Sv} had checked the bike lane and begun its right turn. {Cp} came up from behind on the right at speed and made contact.",
        ],
        ..at_intersection(RightTurn, Straight, 4)
    },
    Story {
        partners: Partners::Any,
        sv_mph: (2, 12),
        contacts: &[(&[Left], &[Right]), (&[FrontLeft], &[RearRight]), (&[RearLeft], &[FrontRight])],
        tellings: &[
            "{Sv} slowed to turn right from {rlane}. {Cp} behind it pulled out to the left, went past straight on{cp_at}, and brushed its left side.",
        ],
        ..at_intersection(RightTurn, Straight, 3)
    },
    // Intersection, both right: 14.
    Story {
        sv_mph: (0, 5),
        cp_mph: (2, 14),
        tellings: &[
            "{Sv} was in the right turn slip lane from {street} to {cross} and stopped at the yield sign for a car. {Cp} also turning right looked left and ran into its back{cp_at}.",
            "{Sv} and {cp} were both turning right on red. {Sv} stopped again for cross traffic and the one behind did not.",
            "Turning right at {cross}, {sv} yielded to a person with a stroller. {Cp} behind it in the turn bumped it.",
        ],
        ..at_intersection(RightTurn, RightTurn, 5)
    },
    Story {
        sv_mph: (4, 12),
        cp_mph: (6, 18),
        contacts: &[(&[Left], &[Right]), (&[FrontLeft], &[Right]), (&[FrontLeft, Left], &[RearRight, Right])],
        tellings: &[
            "Two lanes turn right from {street} onto {cross}. {Sv} was in the inner one{at}. {Cp} in the outer lane on its left cut the corner and came into its lane.",
            "{Cp} turned right from the lane to the left of {sv}, which was turning right as well, and squeezed it towards the curb.",
        ],
        ..at_intersection(RightTurn, RightTurn, 5)
    },
    Story {
        partners: Partners::Any,
        sv_mph: (4, 12),
        cp_mph: (6, 18),
        contacts: &[(&[Right], &[Left]), (&[FrontRight], &[FrontLeft])],
        tellings: &[
            "{Sv} swung out slightly for a tight right turn onto {cross}. {Cp} drove up on its right side, turning right too, and the two came together.",
            "While {sv} was turning right from {heading} {street}{at}, {cp} passed it on the inside, over the painted gore, also turning right.",
        ],
        ..at_intersection(RightTurn, RightTurn, 4)
    },
    // Intersection, subject vehicle straight, partner right: 9.
    Story {
        from: From::Right,
        sv_mph: (10, 30),
        cp_mph: (5, 16),
        contacts: &[(&[FrontRight], &[Left]), (&[Front, FrontRight], &[RearLeft]), (&[Right], &[FrontLeft])],
        tellings: &[
            "{Sv} was {heading} on {street} in the right lane{at} with a green light. {Cp} on {cross} turned right on red from the right side into its lane{cp_at}.",
            "{Cp} rolled past the stop sign on the right and made a wide right turn into the lane in which {sv} was going straight on.",
        ],
        ..at_intersection(Straight, RightTurn, 5)
    },
    Story {
        sv_mph: (6, 25),
        cp_mph: (8, 22),
        contacts: &[(&[FrontLeft], &[Right]), (&[Front, FrontLeft], &[RearRight, Right])],
        tellings: &[
            "{Sv} was going straight through {cross} in the right lane{at}. {Cp} in the lane to its left turned right across its front.",
            "{Cp} overtook {sv} on the left, then made a right turn onto {cross} directly in front of it. {Sv} braked hard.",
        ],
        ..at_intersection(Straight, RightTurn, 4)
    },
    // Intersection, both left: 8.
    Story {
        sv_mph: (5, 15),
        cp_mph: (6, 18),
        contacts: &[(&[Right], &[Left]), (&[FrontRight], &[Left]), (&[RearRight, Right], &[FrontLeft])],
        tellings: &[
            "Two lanes turn left from {street} to {cross}. {Sv} was in the inner one{at}, {cp} in the outer one, on the right. The partner cut across the dotted guide line into {sv}.",
            "During a double left turn on a green arrow, {cp} on the right of {sv} turned too tightly and sideswiped it.",
        ],
        ..at_intersection(LeftTurn, LeftTurn, 3)
    },
    Story {
        sv_mph: (5, 15),
        cp_mph: (6, 18),
        contacts: &[(&[Left], &[Right]), (&[FrontLeft], &[RearRight])],
        tellings: &[
            "{Sv} was turning left in the outer of two left turn lanes{at}. {Cp} in the inner lane, on its left, ran wide and came over the guide line.",
        ],
        ..at_intersection(LeftTurn, LeftTurn, 2)
    },
    Story {
        from: From::Opposite,
        sv_mph: (4, 12),
        cp_mph: (6, 16),
        contacts: &[(&[FrontRight], &[FrontRight])],
        tellings: &[
            "{Sv} and {cp}, which came the other way, were both turning left at {cross} at the same time. The partner cut its turn short and the two clipped each other.",
        ],
        ..at_intersection(LeftTurn, LeftTurn, 1)
    },
    Story {
        sv_mph: (0, 6),
        cp_mph: (3, 12),
        tellings: &[
            "{Sv} was turning left behind a line of cars and stopped inside the turn because the exit was full. {Cp} turning left behind it rolled into it{cp_at}.",
        ],
        ..at_intersection(LeftTurn, LeftTurn, 2)
    },
    // Intersection, subject vehicle left and partner right (4), and the other way round (1).
    Story {
        from: From::Opposite,
        sv_mph: (5, 14),
        cp_mph: (5, 16),
        contacts: &[(&[FrontRight], &[Left]), (&[Right], &[FrontLeft]), (&[Right, FrontRight], &[FrontLeft, Left])],
        tellings: &[
            "{Sv} was turning left from {street} onto {cross} on a green arrow{at}. {Cp} coming the other way turned right on red at the same time and took the same exit lane.",
            "{Cp}, {cp_heading}, made a wide right turn onto {cross} and met {sv}, which was finishing its left turn into the far lane.",
        ],
        ..at_intersection(LeftTurn, RightTurn, 4)
    },
    Story {
        from: From::Opposite,
        sv_mph: (5, 11),
        cp_mph: (8, 18),
        contacts: &[(&[FrontLeft], &[FrontRight])],
        tellings: &[
            "{Sv} was turning right from {street} onto {cross} on a green light{at}. {Cp} coming the other way turned left, did not yield, and ran wide into the lane {sv} was turning into.",
        ],
        ..at_intersection(RightTurn, LeftTurn, 1)
    },
    // Highway: 9 straight, 7 of them more in work zones, 4 with a left turn.
    Story {
        road: Highway,
        partners: Partners::Trucks,
        sv_mph: (45, 65),
        cp_mph: (50, 75),
        contacts: CUT_IN_FROM_LEFT,
        tellings: &[
            "{Sv} was {heading} on {street} in {rlane}{at}. {Cp} passing on the left{cp_at} changed lanes to the right before it had cleared the front of {sv}.",
            "{Cp} crossed from the left lane to reach the exit and cut in ahead of {sv}.",
        ],
        ..at_intersection(Straight, Straight, 3)
    },
    Story {
        road: Highway,
        partners: Partners::Motor,
        sv_mph: (30, 62),
        cp_mph: (45, 75),
        tellings: &[
            "Traffic on {street} slowed for a stalled car. {Sv} slowed with it, in {lane}, and was hit from behind by {cp}{cp_at}.",
            "{Sv} was holding {lane} of {heading} {street}{at} when {cp} came up from behind much faster and did not change lanes.",
        ],
        ..at_intersection(Straight, Straight, 3)
    },
    Story {
        road: Highway,
        partners: Partners::Trucks,
        sv_mph: (50, 65),
        cp_mph: (50, 70),
        contacts: DRIFT_FROM_RIGHT,
        tellings: &[
            "{Cp} in the lane to the right of {sv} drifted left over the lane line, {heading} on {street}, and scraped its side{at}.",
            "A gust of wind pushed {cp} on the right of {sv} into its lane while both were going straight on at highway speed.",
        ],
        ..at_intersection(Straight, Straight, 3)
    },
    Story {
        road: Highway,
        work_zone: true,
        partners: Partners::Trucks,
        sv_mph: (30, 55),
        cp_mph: (35, 60),
        contacts: CUT_IN_FROM_RIGHT,
        tellings: &[
            "The right lane of {street} was closed for road work with a taper of cones. {Cp} stayed in it to the end and merged left into {sv}, which was in {llane}{at}.",
            "In a construction zone on {heading} {street}, {cp} beside {sv} on the right ran out of lane at the traffic cones and moved left{cp_at}.",
        ],
        ..at_intersection(Straight, Straight, 3)
    },
    Story {
        road: Highway,
        work_zone: true,
        partners: Partners::Trucks,
        sv_mph: (35, 55),
        cp_mph: (35, 60),
        contacts: DRIFT_FROM_LEFT,
        tellings: &[
            "The lanes of {street} are shifted and narrow in the work zone, with barrels on the right. {Cp} on the left of {sv} did not follow the shift and drifted into its lane.",
        ],
        ..at_intersection(Straight, Straight, 2)
    },
    Story {
        road: Highway,
        work_zone: true,
        partners: Partners::Motor,
        sv_mph: (3, 25),
        cp_mph: (20, 50),
        tellings: &[
            "{Sv} slowed for the end of a queue before a lane closure marked with cones on {heading} {street}. {Cp} behind it did not slow down in time{cp_at}.",
        ],
        ..at_intersection(Straight, Straight, 2)
    },
    Story {
        road: Highway,
        partners: Partners::Trucks,
        sv_mph: (35, 60),
        cp_mph: (15, 45),
        contacts: &[(&[FrontRight], &[Left]), (&[Front, FrontRight], &[FrontLeft, Left])],
        tellings: &[
            "{Sv} was {heading} in {llane} of {street}{at}. {Cp} in the lane to its right turned left towards an opening in the median, across the path of {sv}.",
            "Wanting to turn back through a median crossover, {cp} made a left turn from the lane on the right of {sv}{cp_at}. {Sv} braked hard and could not avoid it.",
        ],
        ..at_intersection(Straight, LeftTurn, 4)
    },
    // Traffic circle: 1.
    Story {
        road: TrafficCircle,
        from: From::Right,
        sv_mph: (8, 14),
        cp_mph: (8, 18),
        contacts: &[(&[FrontRight], &[FrontLeft])],
        tellings: &[
            "{Sv} was circulating in the roundabout at {street} and {cross} to take the third exit{at}. {Cp} entered from the right past the yield sign, also going around to the left, and did not give way.",
        ],
        ..at_intersection(LeftTurn, LeftTurn, 1)
    },
];
