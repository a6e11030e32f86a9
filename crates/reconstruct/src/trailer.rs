//! Partners whose trailer touches: who draws it gets by, and the trailer, which is wider, does not.

use crate::side::Side;
use crate::told::Told;
use recrash_metrics::contact::ContactGeometry;
use recrash_model::account::{ContactState, Kind, Origin, Party, Source, told};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::rollout::Rollout;
use recrash_model::scenario::{Part, PartKind, Size};
use recrash_model::zones::ContactZone;

/// Who draws a trailer, and the trailer; usual ones, assumed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rig {
    pub(crate) tractor: Size,
    pub(crate) trailer: Size,
}

/// From who draws it to a trailer. [m]
const GAP_M: f64 = 0.4;

/// The name of its part.
const ID: &str = "trailer";

impl Rig {
    pub(crate) fn of(kind: Kind) -> Option<Self> {
        let size = |length_m: f64, width_m: f64| Size { length_m, width_m };
        match kind {
            Kind::SemiTrailerTruck => Some(Self { tractor: size(5.0, 2.3), trailer: size(10.6, 2.6) }),
            Kind::PickupWithTrailer => Some(Self { tractor: size(5.6, 2.0), trailer: size(5.0, 2.3) }),
            _ => None,
        }
    }

    /// From the middle of the trailer to that of who draws it. [m]
    fn ahead_m(&self) -> f64 {
        0.5 * (self.trailer.length_m + self.tractor.length_m) + GAP_M
    }

    pub(crate) fn part(&self) -> Part {
        let axle_m = Some(0.8 * self.trailer.length_m);
        let x_m = -0.5 * self.tractor.length_m - GAP_M;
        let Size { length_m, width_m } = self.trailer;
        Part { id: ID.to_owned(), kind: PartKind::Trailer, x_m, y_m: 0.0, length_m, width_m, axle_m }
    }

    /// Where who draws the trailer is when that is here, behind it in line.
    pub(crate) fn tractor(&self, trailer: &OrientedBox) -> OrientedBox {
        let position = trailer.centre + trailer.axis * self.ahead_m();
        let (half_length, half_width) = (0.5 * self.tractor.length_m, 0.5 * self.tractor.width_m);
        OrientedBox { centre: position, half_length, half_width, ..*trailer }
    }

    /// The zone of the two together where the trailer is touched.
    pub(crate) fn zone(&self, trailer: &OrientedBox, geometry: &ContactGeometry) -> ContactZone {
        let longer_m = self.tractor.length_m + GAP_M;
        let centre = trailer.centre + trailer.axis * (0.5 * longer_m);
        let both = OrientedBox { centre, half_length: trailer.half_length + 0.5 * longer_m, ..*trailer };
        ContactZone::at(&both, geometry.point)
    }
}

/// Whether it is told that the trailer touched: "the left side of the truck's trailer", by which the partner is named, or which is what
/// touched.
pub(crate) fn touches(partner: &Party) -> bool {
    let words = |source: &Source| match source {
        Source::Words { text, .. } => text.to_lowercase(),
        _ => String::new(),
    };
    let named = partner.kind.as_ref().is_some_and(|kind| {
        let text = words(&kind.source);
        text.contains("trailer") && [" side", " corner", " end", " rear"].iter().any(|word| text.contains(word))
    });
    let part = |text: String| ["the ", "its "].iter().any(|word| text.starts_with(word)) && text.ends_with("trailer");
    let touched = partner.zones.iter().any(|zone| part(words(&zone.source)));
    (named || touched) && told(&partner.kind).and_then(Rig::of).is_some()
}

/// What is drawn of somebody who comes by with a trailer that touches.
pub(crate) fn rig(partner: &Party, side: &Side, origin: Origin) -> Option<Rig> {
    let beside = matches!(origin, Origin::Opposite | Origin::Beside { .. } | Origin::Behind);
    let comes_by = beside && matches!(side.state, ContactState::Moving | ContactState::SettingOff);
    told(&partner.kind).and_then(Rig::of).filter(|_| comes_by && touches(partner))
}

/// Whether the partner draws one.
pub(crate) fn is_drawn(rollout: &Rollout) -> bool {
    rollout.actors.iter().any(|track| track.part_of.is_some() && track.id == format!("cp.{ID}"))
}

/// From the front of a rigid one to its trailer. [m]
fn tractor_m(told: &Told) -> f64 {
    told.trailer_of.and_then(Rig::of).map_or(0.0, |rig| rig.tractor.length_m)
}

/// Whether the place of a contact is on the trailer, of a rigid one.
pub(crate) fn is_on_trailer(told: &Told, outline: &OrientedBox, point: Vec2) -> bool {
    outline.to_local(point).x < outline.half_length - tractor_m(told)
}

/// The pose of who draws a trailer that is here.
pub(crate) fn pose(rig: Option<Rig>, trailer: Pose) -> Pose {
    let ahead_m = rig.map_or(0.0, |rig| rig.ahead_m());
    Pose { position: trailer.position + Vec2::from_heading(trailer.heading) * ahead_m, ..trailer }
}
