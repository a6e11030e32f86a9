//! From rows to usable records: the paper's filter, in its order, each loss with its reason.

use crate::row::Draft;
use recrash_model::profile::{SystemProfile, Tells};
use recrash_model::record::{FunnelStep, Redaction, RejectReason};

/// A step of the funnel: its name and what it takes away.
pub struct Step {
    name: &'static str,
    takes: fn(&Draft, &SystemProfile) -> Option<RejectReason>,
}

/// The steps after merging, in the paper's order.
pub const STEPS: [Step; 2] = [
    Step { name: "narrative readable", takes: unreadable },
    Step { name: "expressible by the profile", takes: foreign },
];

fn unreadable(draft: &Draft, _: &SystemProfile) -> Option<RejectReason> {
    match draft.record.redaction {
        Redaction::Open => None,
        Redaction::Redacted => Some(RejectReason::RedactedNarrative),
        Redaction::Empty => Some(RejectReason::EmptyNarrative),
    }
}

fn foreign(draft: &Draft, profile: &SystemProfile) -> Option<RejectReason> {
    let record = &draft.record;
    let expresses = &profile.expresses;
    let sv = record.sv_movement.known().is_some_and(|movement| expresses.sv_movements.contains(&movement));
    let cp = record.cp_movement.known().is_some_and(|movement| expresses.cp_movements.contains(&movement));
    let template = record.template();
    if draft.not_a_crash {
        Some(RejectReason::NotACrash)
    } else if !(sv && cp) {
        Some(RejectReason::MovementNotExpressible)
    } else if !template.is_some_and(|template| profile.expresses(&template)) {
        Some(RejectReason::RoadNotExpressible)
    } else {
        None
    }
}

/// The only step of a profile that goes by accounts.
const CRASHES: Step = Step { name: "crash reports", takes: no_crash };

fn no_crash(draft: &Draft, _: &SystemProfile) -> Option<RejectReason> {
    draft.not_a_crash.then_some(RejectReason::NotACrash)
}

/// Runs the steps over the drafts that are still in (`fates[i]` is `None`), and fills in the fates of the others.
pub fn run(
    drafts: &[Draft],
    profile: &SystemProfile,
    fates: &mut [Option<RejectReason>],
    funnel: &mut Vec<FunnelStep>,
) {
    let steps: &[Step] = match profile.records.tells {
        Tells::Templates => &STEPS,
        Tells::Accounts => &[CRASHES],
    };
    for step in steps {
        for (draft, fate) in drafts.iter().zip(fates.iter_mut()) {
            if fate.is_none() {
                *fate = (step.takes)(draft, profile);
            }
        }
        funnel.push(tally(step.name, fates, funnel));
    }
}

/// The state after a step: what remains, and what went that no earlier step took.
pub fn tally(name: &str, fates: &[Option<RejectReason>], before: &[FunnelStep]) -> FunnelStep {
    let mut counts: Vec<(RejectReason, usize)> = Vec::new();
    for reason in fates.iter().flatten() {
        match counts.iter_mut().find(|(known, _)| known == reason) {
            Some((_, count)) => *count += 1,
            None => counts.push((*reason, 1)),
        }
    }
    let earlier = |reason| before.iter().flat_map(|step| &step.lost).any(|(known, _)| *known == reason);
    counts.retain(|(reason, _)| !earlier(*reason));
    counts.sort();
    let remaining = fates.iter().filter(|fate| fate.is_none()).count();
    FunnelStep { name: name.to_owned(), remaining, lost: counts }
}
