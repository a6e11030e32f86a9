//! What a replay shows besides who drives where: signals and signs at their stop lines, when the system under test takes
//! over, and where the ego's task has it stop.

use crate::numbers::short;
use crate::words;
use recrash_model::geometry::Vec2;
use recrash_model::run::JudgedRun;
use recrash_model::scenario::{Control, Device, ScenarioDraft};
use recrash_roads::{LineKind, RoadDrawing};
use serde_json::{Value, json};

/// Adds it to the data of a run of this scenario.
pub fn on(mut trace: Value, draft: &ScenarioDraft, drawing: &RoadDrawing, run: &JudgedRun) -> Value {
    trace["signals"] = signals(&draft.control, drawing);
    trace["stops"] = stops(draft);
    if let Some(handover_s) = draft.ego.handover_s.filter(|_| run.ego != words::RECORDED) {
        trace["handover"] = short(handover_s, 3);
        let event = json!([short(handover_s, 3), "handover", format!("{} takes over", words::clean(&run.ego, 40))]);
        if let Value::Array(events) = &mut trace["events"] {
            let later = |other: &Value| other[0].as_f64().is_some_and(|time_s| time_s > handover_s);
            let at = events.iter().position(later).unwrap_or(events.len());
            events.insert(at, event);
        }
    }
    trace
}

/// Of each device its stop line, and what it shows: phases with their lengths and how long they have run, or the name of a
/// sign. Nothing where the drawing has not one line for each.
fn signals(control: &[Control], drawing: &RoadDrawing) -> Value {
    let lines: Vec<&[Vec2]> =
        drawing.lines.iter().filter(|line| line.kind == LineKind::Stop).map(|line| &line.points[..]).collect();
    if lines.len() != control.len() {
        return json!([]);
    }
    let line = |points: &[Vec2]| points.iter().map(|p| json!([short(p.x, 2), short(p.y, 2)])).collect::<Vec<_>>();
    let device = |device: &Device| match device {
        Device::Signal { program, offset_s } => {
            let phases: Vec<_> =
                program.iter().map(|phase| json!([words::name(&phase.show), short(phase.for_s, 3)])).collect();
            json!([phases, short(*offset_s, 3)])
        }
        Device::StopSign {} => json!("stop"),
        Device::YieldSign {} => json!("yield"),
    };
    lines.into_iter().zip(control).map(|(points, control)| json!([line(points), device(&control.device)])).collect()
}

/// Where the ego is to stop.
fn stops(draft: &ScenarioDraft) -> Value {
    if draft.ego.stops.is_empty() {
        return json!([]);
    }
    let Ok(checked) = recrash_roads::check(draft.clone()) else { return json!([]) };
    let path = &checked.value.ego().path;
    let place = |stop: &recrash_model::scenario::MissionStop| {
        let at = path.pose(stop.s_m, stop.t_m).position;
        json!([short(at.x, 2), short(at.y, 2)])
    };
    draft.ego.stops.iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::scenario::{Aspect, Phase};
    use recrash_roads::RoadLine;

    #[test]
    fn every_stop_line_gets_what_stands_there() {
        let control = |device| Control { at: "west+".into(), set_back_m: 0.0, lanes: Vec::new(), device };
        let program = vec![Phase { show: Aspect::FlashingRed, for_s: 4.0 }, Phase { show: Aspect::Green, for_s: 6.5 }];
        let devices = [control(Device::Signal { program, offset_s: 1.5 }), control(Device::StopSign {})];
        let stop = |x: f64| RoadLine { kind: LineKind::Stop, points: vec![Vec2::new(x, 0.0), Vec2::new(x, 3.5)] };
        let mut drawing = RoadDrawing { lines: vec![stop(1.0), stop(2.0)], ..RoadDrawing::default() };
        let told =
            json!([[[[1, 0], [1, 3.5]], [[["flashing red", 4], ["green", 6.5]], 1.5]], [[[2, 0], [2, 3.5]], "stop"]]);
        assert_eq!(signals(&devices, &drawing), told);
        drawing.lines.pop();
        assert_eq!(signals(&devices, &drawing), json!([]), "a line that is nobody's must not be another's");
    }
}
