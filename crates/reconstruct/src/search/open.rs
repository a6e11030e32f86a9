//! What an account leaves open: the part of a crash that may be varied.

use crate::told::choices::Choices;
use crate::told::crash::Told;
use recrash_model::account::{Account, ContactState, SpeedMeaning};
use recrash_model::tuning::Parameter;

const PARTNER_SPEED: &str = "assumed:partner_speed";
const ROLLING: &str = "assumed:ego_speed_before_its_stop_mps";
const STOOD: &str = "assumed:ego_stood_s";

/// The numbers that an account leaves open, with how far each may move.
pub fn open_choices(account: &Account) -> Vec<Parameter> {
    let Some(told) = Told::read(account) else { return Vec::new() };
    let usual = Choices::default();
    let parameter = |pointer: &str, unit: &str, min: f64, max: f64, start: f64, reason: &str| Parameter {
        pointer: pointer.to_owned(),
        unit: unit.to_owned(),
        min,
        max,
        start,
        integer: false,
        reason: reason.to_owned(),
    };
    let mut list = Vec::new();
    if told.cp.impact_mps.is_none() && !told.cp.state.stands() && told.thing.is_none() {
        let reason = "nobody tells the partner's speed at the contact; shares of the usual one of its kind and state";
        list.push(parameter(PARTNER_SPEED, "", 0.6, 1.6, usual.partner_speed, reason));
    }
    let approach_told = account.sv.speeds.iter().any(|speed| speed.value.meaning == SpeedMeaning::Approach);
    if told.sv.state == ContactState::Stopped && !approach_told {
        let reason = "nobody tells how fast the ego came to its stop";
        list.push(parameter(ROLLING, "m/s", 4.0, 9.0, usual.rolling_mps, reason));
        let reason = "nobody tells how long it had stood";
        list.push(parameter(STOOD, "s", 1.2, 3.5, usual.stood_s, reason));
    }
    list
}

impl Choices {
    /// These values for these parameters, and the usual ones for all others.
    pub(crate) fn of(parameters: &[Parameter], values: &[f64]) -> Self {
        let mut choices = Self::default();
        for (parameter, value) in parameters.iter().zip(values) {
            match parameter.pointer.as_str() {
                PARTNER_SPEED => choices.partner_speed = *value,
                ROLLING => choices.rolling_mps = *value,
                STOOD => choices.stood_s = *value,
                _ => {}
            }
        }
        choices
    }
}
