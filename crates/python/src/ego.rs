//! A Python object in the ego's seat. It is told what a program is told (`docs/ego-protocol.md`), as dicts.

use crate::errors::{Kind, error, from_json};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use recrash_model::rollout::Termination;
use recrash_model::vehicle::VehicleSpec;
use recrash_pipeline::{told_at_reset, told_at_step};
use recrash_roads::Scenario;
use recrash_sim::{CastMember, Controls, EgoDriver, Observation};

/// Names of the two forms of an answer.
const MOTION: [&str; 2] = ["acceleration_mps2", "wheel_angle_rad"];
const PEDALS: [&str; 2] = ["throttle", "steer"];

/// A class, which is made anew for the run, an object with `control`, or a function.
pub struct PythonEgo<'py> {
    name: String,
    object: Bound<'py, PyAny>,
    world: Option<Bound<'py, PyAny>>,
    scenario: String,
    spec: Option<VehicleSpec>,
    ids: Vec<String>,
}

impl<'py> PythonEgo<'py> {
    pub fn new(object: &Bound<'py, PyAny>) -> PyResult<Self> {
        let py = object.py();
        let is_class = object.is_instance_of::<PyType>();
        let named =
            if is_class || object.hasattr("__qualname__")? { object.clone() } else { object.get_type().into_any() };
        let name: String = named.getattr("__qualname__")?.extract()?;
        let object = if is_class { object.call0()? } else { object.clone() };
        if !object.hasattr("control")? && !object.is_callable() {
            let what = format!(
                "{name} cannot drive: an ego is a name, a function of an observation, or a class or object with a method control(observation)"
            );
            return Err(error(py, Kind::Input, what));
        }
        Ok(Self {
            name: format!("py:{name}"),
            object,
            world: None,
            scenario: String::new(),
            spec: None,
            ids: Vec::new(),
        })
    }

    /// What the object did wrong, with what it raised as the cause.
    fn failed(&self, at: &str, cause: Option<PyErr>, what: &str) -> PyErr {
        let py = self.object.py();
        let said = cause.as_ref().map_or_else(|| what.to_owned(), |cause| format!("raised {cause}"));
        let made = error(py, Kind::Ego, format!("{}: the ego {} {said} at {at}", self.scenario, self.name));
        if let Some(cause) = cause {
            // Ctrl-C and the end of the interpreter are nobody's fault.
            if !cause.is_instance_of::<pyo3::exceptions::PyException>(py) {
                return cause;
            }
            made.set_cause(py, Some(cause));
        }
        made
    }

    /// The two numbers of an answer: a dict in one of the two forms, or a pair of acceleration and wheel angle.
    fn numbers(&self, answer: &Bound<'py, PyAny>, at: &str) -> PyResult<([f64; 2], [&'static str; 2])> {
        let py = self.object.py();
        let wanted = "is no control: give a dict with throttle and steer, or with acceleration_mps2 and wheel_angle_rad, or these two as a pair";
        let shown = || {
            answer.repr().map_or_else(|_| String::new(), |text| text.to_string().chars().take(80).collect::<String>())
        };
        let no_control = || self.failed(at, None, &format!("answered {}, which {wanted},", shown()));
        let (numbers, names) = if let Ok(dict) = answer.cast::<PyDict>() {
            let names = if dict.contains(MOTION[0])? { MOTION } else { PEDALS };
            let number = |name: &str| -> PyResult<f64> {
                let value = dict.get_item(name)?.ok_or_else(no_control)?;
                value.extract().map_err(|_| no_control())
            };
            ([number(names[0])?, number(names[1])?], names)
        } else {
            let pair: Vec<f64> = answer.extract().map_err(|_| no_control())?;
            ([*pair.first().ok_or_else(no_control)?, *pair.get(1).ok_or_else(no_control)?], MOTION)
        };
        match numbers.iter().position(|number| !number.is_finite()) {
            None => Ok((numbers, names)),
            Some(which) => {
                let what = format!("answered {} = {}, and controls are finite numbers,", names[which], numbers[which]);
                py.check_signals()?;
                Err(self.failed(at, None, &what))
            }
        }
    }
}

impl EgoDriver for PythonEgo<'_> {
    type Error = PyErr;

    fn name(&self) -> &str {
        &self.name
    }

    fn begin(&mut self, scenario: &Scenario, cast: &[CastMember]) -> PyResult<()> {
        let draft = scenario.draft();
        self.scenario.clone_from(&draft.id);
        self.ids = cast.iter().enumerate().skip(1).map(|(position, member)| member.id(draft, position)).collect();
        self.spec = Some(VehicleSpec::of(scenario.ego().kind));
        let world = from_json(self.object.py(), &told_at_reset(scenario, cast))?;
        if self.object.hasattr("reset")? {
            self.object.call_method1("reset", (&world,)).map_err(|cause| self.failed("reset", Some(cause), ""))?;
        }
        self.world = Some(world);
        Ok(())
    }

    fn decide(&mut self, observation: &Observation<'_>) -> PyResult<Controls> {
        let py = self.object.py();
        py.check_signals()?;
        let at = format!("step {} ({:.1} s)", observation.step, observation.time_s);
        let told = from_json(py, &told_at_step(observation, &self.ids))?;
        let answer = if self.object.hasattr("control")? {
            self.object.call_method1("control", (told,))
        } else {
            // A function has no memory: it is told the world every time.
            told.set_item("world", self.world.as_ref())?;
            self.object.call1((told,))
        };
        let answer = answer.map_err(|cause| self.failed(&at, Some(cause), ""))?;
        let ([first, second], names) = self.numbers(&answer, &at)?;
        Ok(match &self.spec {
            Some(spec) if names == MOTION => Controls::of_acceleration(first, second, spec),
            _ => Controls { steer: second, throttle: first }.clipped(),
        })
    }

    fn end(&mut self, termination: Termination) -> PyResult<()> {
        if self.object.hasattr("end")? {
            let told = crate::errors::to_python(self.object.py(), &termination)?;
            self.object.call_method1("end", (told,)).map_err(|cause| self.failed("the end", Some(cause), ""))?;
        }
        Ok(())
    }
}
