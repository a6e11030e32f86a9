//! Control of traffic: where stop lines lie.

use super::remarks::{Remarks, shown};
use crate::network::RoadNetwork;
use crate::scenario::ControlPlacement;
use recrash_model::scenario::{Device, ScenarioDraft};

/// The stop lines of signals and signs, in the draft's order.
pub(super) fn place(draft: &ScenarioDraft, network: &RoadNetwork, remarks: &mut Remarks) -> Vec<ControlPlacement> {
    let place = |(position, control): (usize, &recrash_model::scenario::Control)| {
        let (mut lines, stops) = (Vec::new(), !matches!(control.device, Device::YieldSign {}));
        let Some(road) = network.named.iter().find(|road| road.name == control.at) else {
            let known: Vec<&str> = network.named.iter().map(|road| road.name.as_str()).take(24).collect();
            let message = format!("there is no road {:?}", control.at.chars().take(40).collect::<String>());
            let hint = format!("roads with direction here: {}", known.join(", "));
            remarks.error("scenario.unknown-road", format!("control[{position}].at"), message, hint);
            return ControlPlacement { lines, stops };
        };
        let Some(&last) = road.pieces.last() else { return ControlPlacement { lines, stops } };
        for (number, &lane) in network.road(last).lanes.iter().enumerate() {
            if !control.lanes.is_empty() && !control.lanes.iter().any(|wanted| usize::from(*wanted) == number) {
                continue;
            }
            let length_m = network.lane(lane).length_m;
            if control.set_back_m > length_m {
                let message = format!("the last piece of {} is {} m long", control.at, shown(length_m));
                let hint = format!("allowed: up to {} m", shown((length_m * 1000.0).floor() / 1000.0));
                remarks.error("scenario.control", format!("control[{position}].set_back_m"), message, hint);
            }
            lines.push((lane, length_m - control.set_back_m));
        }
        if lines.is_empty() {
            let message = format!("{} has no such lanes", control.at);
            let hint = format!("allowed: 0 to {}", network.road(last).lanes.len().saturating_sub(1));
            remarks.error("scenario.control", format!("control[{position}].lanes"), message, hint);
        }
        ControlPlacement { lines, stops }
    };
    draft.control.iter().enumerate().map(place).collect()
}
