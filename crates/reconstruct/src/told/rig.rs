//! Who draws a trailer, and the trailer.

use recrash_metrics::contact::ContactGeometry;
use recrash_model::account::Kind;
use recrash_model::geometry::OrientedBox;
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
pub(crate) const ID: &str = "trailer";

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
    pub(crate) fn ahead_m(&self) -> f64 {
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
