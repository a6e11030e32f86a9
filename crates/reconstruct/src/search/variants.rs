//! The same crash, told or chosen otherwise: what is tried in turn.

use crate::told::choices::Choices;
use crate::told::crash::Told;
use crate::told::doing::Doing;
use crate::told::others::Extra;
use crate::told::phase::{CHECKED_PHASES, checked};
use crate::told::side::{Side, Turning};
use recrash_model::account::{LeftRight, Origin, PlaceKind};

impl Told {
    /// The same, choosing otherwise.
    pub(crate) fn choosing(mut self, choices: Choices) -> Self {
        self.choices = choices;
        if self.origin_told {
            self.assumed.retain(|assumed| !assumed.contains("speed at the contact"));
            self.speeds();
        }
        self
    }

    /// The same with a partner that comes straight to where it touches.
    pub(super) fn coming_straight(&self) -> Self {
        Self { back_straight: true, ..self.clone() }
    }

    /// The same with one who touched the partner first wherever it can, where it is told how.
    pub(super) fn touched_anyhow(&self) -> Option<Self> {
        self.touch.is_some().then(|| Self { touch: None, ..self.clone() })
    }

    /// The same without what they did to each other, where that is staged: it is asked for, and said not to be seen.
    pub(super) fn plainly(&self) -> Option<Self> {
        let staged = self.enters() || self.sets_off_first() || self.sv.goes_round || self.does_before();
        staged.then(|| {
            let mut told = Self { plainly: true, ..self.clone() };
            if told.sv.goes_round {
                (told.sv.aside, told.sv.goes_round, told.sv.dodges) = (None, false, false);
            }
            told
        })
    }

    /// Everything to try: with those whom the ego stood for, with one of them, then without them.
    pub(super) fn variants(self) -> Vec<Self> {
        let with_extras = |told: Self| {
            let all = choices(&told.wanted);
            all.into_iter().map(|extras| Self { extras, ..told.clone() }).collect::<Vec<_>>()
        };
        let with_rig = |told: Self| {
            let drawn = told.wanted_rig.map(|rig| {
                let cp = Side { size: Some(rig.tractor), ..told.cp.clone() };
                Self { rig: Some(rig), cp, ..told.clone() }
            });
            drawn.into_iter().chain([told])
        };
        // Who has no room in the ego's direction has it on a wider road.
        let with_lanes = |told: Self| {
            let may = told.lanes.is_none() && told.edge.is_none() && told.keeps_direction();
            let more = may.then(|| Self { more_lanes: true, ..told.clone() });
            [told].into_iter().chain(more)
        };
        // Who turns does so out of the lane for that, where it can with all of them.
        let with_any_lane = |told: Self| {
            let any = told.turns_out_of_other_way().then(|| Self { any_lane: true, ..told.clone() });
            [told].into_iter().chain(any)
        };
        let told = self.by_origin().into_iter().flat_map(Self::with_junction).flat_map(with_rig);
        told.flat_map(with_extras).flat_map(with_lanes).flat_map(with_any_lane).collect()
    }
}

/// What to try: all of them, all but one, one of them, and none.
fn choices(wanted: &[Extra]) -> Vec<Vec<Extra>> {
    let wanted: Vec<Extra> = wanted.iter().filter(|extra| extra.near.is_none()).cloned().collect();
    let without = |left_out: usize| {
        let kept = wanted.iter().enumerate().filter(|(number, _)| *number != left_out);
        kept.map(|(_, extra)| extra.clone()).collect::<Vec<_>>()
    };
    let mut list = vec![wanted.to_vec()];
    if wanted.len() > 2 {
        list.extend((0..wanted.len()).rev().map(without));
    }
    if wanted.len() > 1 {
        list.extend(wanted.iter().map(|extra| vec![extra.clone()]));
    }
    list.extend((!wanted.is_empty()).then(Vec::new));
    list
}

impl Told {
    /// The same with the partner farther behind the ego, where that matters.
    pub(super) fn afar(&self) -> Option<Self> {
        let comes_round = self.waits_behind() && self.comes_round_ego();
        let told = (self.close && (self.queued || comes_round)).then(|| Self { close: false, ..self.clone() });
        told.map(|told| {
            let choices = told.choices;
            told.choosing(choices)
        })
    }
}

/// How much longer the ego and the partner stand, and in shares of what is usual how fast the partner is, and an ego that comes to a stop, where that
/// brings what they do into the told order. [s, -]
const OTHER_TIMES: [([f64; 2], [f64; 2]); 10] = [
    ([-0.8, 0.0], [1.0, 1.0]),
    ([2.0, 0.0], [1.0, 1.0]),
    ([0.0, 2.0], [1.0, 1.0]),
    ([-0.8, 0.0], [0.6, 1.0]),
    ([-0.8, 0.0], [1.0, SLOWLY]),
    ([-0.8, 0.0], [0.6, SLOWLY]),
    ([4.0, 0.0], [1.0, 1.0]),
    ([0.0, 4.0], [1.0, 1.0]),
    ([7.0, 0.0], [1.0, 1.0]),
    ([0.0, 7.0], [1.0, 1.0]),
];

/// An ego that comes along more slowly brakes for a shorter time. [-]
const SLOWLY: f64 = 0.6;

impl Told {
    /// The same at other times, to try where what one of the two did before or behind the other is not shown as it is told: the ego's acts
    /// come later against the partner's where that stands for longer, or the ego for a shorter time; the partner's, where the ego stands for
    /// longer; who is slower may be for both. Of each whether it is for the ego's acts, and for the partner's.
    pub(super) fn in_other_times(&self) -> impl Iterator<Item = (Self, [bool; 2])> {
        let differs = self.sv.acts.iter().chain(&self.cp.acts).any(Doing::is_behind_other);
        let tried = OTHER_TIMES.into_iter().filter(move |_| differs);
        tried.map(|(longer_s, [slower, rolling])| {
            let mut told = self.clone();
            told.contact_s += longer_s[0].max(longer_s[1]).max(0.0);
            let choices = Choices {
                longer_s,
                partner_speed: slower * self.choices.partner_speed,
                rolling_mps: rolling * self.choices.rolling_mps,
                ..self.choices
            };
            (told.choosing(choices), [longer_s[0] <= 0.0, longer_s[0] > 0.0 || slower < 1.0])
        })
    }

    /// The same with the last steps alone that are checked, where there are more.
    pub(super) fn in_fewer_steps(&self) -> Option<Self> {
        let long = |side: &Side| side.phases.len() > CHECKED_PHASES;
        let mut told = (long(&self.sv) || long(&self.cp)).then(|| self.clone())?;
        for side in [&mut told.sv, &mut told.cp] {
            side.phases = checked(&side.phases).to_vec();
        }
        told.phases();
        Some(told)
    }

    /// The same with every origin to try: the told one; where none is told the one that the type leaves, then the others.
    fn by_origin(self) -> Vec<Self> {
        if self.origin_told {
            return vec![self];
        }
        let (left, right) = (LeftRight::Left, LeftRight::Right);
        let mut origins = vec![self.origin];
        for other in [
            Origin::Behind,
            Origin::Cross { side: left },
            Origin::Cross { side: right },
            Origin::Opposite,
            Origin::Beside { side: left },
            Origin::Beside { side: right },
            Origin::Ahead,
            Origin::Stall { side: Some(left) },
            Origin::Stall { side: Some(right) },
        ] {
            if !origins.contains(&other) {
                origins.push(other);
            }
        }
        let with = |origin: Origin| {
            let mut told = Self { origin, ..self.clone() };
            told.assumed.push(format!("the partner comes {}", origin.words()));
            told.speeds();
            told
        };
        origins.into_iter().map(with).collect()
    }

    /// The same at a junction too, where somebody on a street crosses nearby, or turns; and where the partner turns out of a driveway, if
    /// it cannot without.
    fn with_junction(self) -> Vec<Self> {
        let crossed = self.place == PlaceKind::Street && self.wanted.iter().any(Extra::is_at_junction);
        let turns = self.comes_off_drive() && self.cp.turning != Turning::No;
        let at_one = (crossed || turns).then(|| Self { crossed_near: true, ..self.clone() });
        match crossed {
            true => at_one.into_iter().chain([self]).collect(),
            false => [self].into_iter().chain(at_one).collect(),
        }
    }
}
