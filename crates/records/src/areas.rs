//! What a tick under a contact area means.
//!
//! In the files that NHTSA publishes since June 2025 the ticks of front and rear stand under each other's names: who is told to be
//! touched at "the rear" has its tick under `Rear Right`, "the front left" stands under `Front`. Of the 508 sides in the file of
//! June 2025 to January 2026 that have one such tick and words to hold against it, the words agree with the names in 9, and with
//! the names moved on in 499. Which of the two a file holds is therefore asked of its own narratives, by plain words alone.

use crate::row::Draft;
use recrash_model::record::{CrashRecord, Edition};
use recrash_model::zones::ContactZone;
use recrash_model::{Diagnostic, Location, Severity};

/// The area that a tick under this one is for, in the published files since June 2025.
fn moved_on(named: ContactZone) -> ContactZone {
    match named {
        ContactZone::Front => ContactZone::FrontLeft,
        ContactZone::FrontLeft => ContactZone::FrontRight,
        ContactZone::FrontRight => ContactZone::Front,
        ContactZone::Rear => ContactZone::RearLeft,
        ContactZone::RearLeft => ContactZone::RearRight,
        ContactZone::RearRight => ContactZone::Rear,
        same => same,
    }
}

/// How a narrative names an area at one of the ends; none for the others, which never moved.
fn words(area: ContactZone) -> &'static [&'static str] {
    match area {
        ContactZone::Front => &["front of", "front bumper"],
        ContactZone::FrontLeft => &["front left", "left front"],
        ContactZone::FrontRight => &["front right", "right front"],
        ContactZone::Rear => &["rear of", "rear bumper"],
        ContactZone::RearLeft => &["rear left", "left rear"],
        ContactZone::RearRight => &["rear right", "right rear"],
        _ => &[],
    }
}

/// How many narratives name the area as ticked, and how many the one that it is moved on to.
#[derive(Debug, Default, Clone, Copy)]
struct Votes {
    as_named: usize,
    moved: usize,
}

impl Votes {
    /// Of one side: only where a single area is ticked, and the narrative names one of the two and not the other.
    fn add(&mut self, narrative: &str, ticked: &[ContactZone]) {
        let [area] = ticked else { return };
        let named = |area: ContactZone| words(area).iter().any(|words| narrative.contains(words));
        match (named(*area), named(moved_on(*area))) {
            (true, false) => self.as_named += 1,
            (false, true) => self.moved += 1,
            _ => {}
        }
    }

    fn of(records: &[&CrashRecord]) -> Self {
        let mut votes = Self::default();
        for record in records {
            let narrative = record.narrative.to_lowercase();
            votes.add(&narrative, &record.sv_zones);
            votes.add(&narrative, &record.cp_zones);
        }
        votes
    }
}

/// Puts the contact areas of a file's rows since June 2025 right, and says so. Where no narrative tells they are taken as all
/// published files have them.
pub fn put_right(drafts: &mut [Draft], file: &str) -> Option<Diagnostic> {
    let is_third = |record: &CrashRecord| record.provenance.edition == Edition::Third;
    let records: Vec<&CrashRecord> =
        drafts.iter().map(|draft| &draft.record).filter(|record| is_third(record)).collect();
    let votes = Votes::of(&records);
    if votes.as_named > votes.moved {
        return None;
    }
    let mut sides = 0;
    for Draft { record, .. } in drafts.iter_mut().filter(|draft| is_third(&draft.record)) {
        for zones in [&mut record.sv_zones, &mut record.cp_zones] {
            sides += usize::from(zones.iter().any(|zone| moved_on(*zone) != *zone));
            zones.iter_mut().for_each(|zone| *zone = moved_on(*zone));
            zones.sort();
        }
    }
    let Votes { as_named, moved } = votes;
    let message = format!(
        "contact areas of {sides} sides are ticked under each other's names, as in all files published since June 2025 (\"Rear Right\" is \
         the rear, \"Front\" the front left); of the narratives that can tell {moved} say so and {as_named} say otherwise; read as meant"
    );
    let location = Location { file: Some(file.to_owned()), ..Location::default() };
    (sides > 0).then(|| Diagnostic::new(Severity::Note, "records.contact-areas", location, message))
}
