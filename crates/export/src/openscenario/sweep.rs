//! The logical scenario: the parameters that may move, with their ranges, for any runner to sweep.

use super::Context;
use crate::xml::{Element, number};
use recrash_model::math::radical_inverse;
use recrash_model::tuning::{Parameter, apply};

/// Runs a stochastic runner is asked for, and points that are listed for a deterministic one.
const POINTS: u32 = 64;

/// Bases of the Halton sequence (halton1960), one per parameter; further parameters use the last and are shifted.
const PRIMES: [u32; 16] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53];

/// The ranges, drawn from evenly.
pub(super) fn ranges(context: &Context<'_>, header: Element, file: &str) -> Element {
    let distributions = tunable(context).into_iter().map(|(name, parameter)| {
        Element::new("StochasticDistribution").with("parameterName", name).child(
            Element::new("UniformDistribution").child(
                Element::new("Range").with_number("lowerLimit", parameter.min).with_number("upperLimit", parameter.max),
            ),
        )
    });
    distribution(
        header,
        file,
        Element::new("Stochastic")
            .with("numberOfTestRuns", POINTS.to_string())
            .with("randomSeed", context.scenario.draft().source.seed.to_string())
            .children(distributions),
    )
}

/// Points spread evenly over the ranges, each of them a scenario that passes the check. Empty where none does.
pub(super) fn points(context: &Context<'_>, header: Element, file: &str) -> Option<Element> {
    let tunable = tunable(context);
    let parameters: Vec<Parameter> = tunable.iter().map(|(_, parameter)| (*parameter).clone()).collect();
    let mut sets = Vec::new();
    for point in 0..POINTS {
        let values: Vec<f64> = tunable
            .iter()
            .enumerate()
            .map(|(dimension, (_, parameter))| value_at(parameter, point, dimension))
            .collect();
        // The first point is the scenario as it is.
        let values = if point == 0 { parameters.iter().map(|p| current(context, p)).collect() } else { values };
        let runnable = apply(context.scenario.draft(), &parameters, &values)
            .is_ok_and(|draft| recrash_roads::check(draft).is_ok_and(|found| same_roads(context, &found.value)));
        if runnable {
            let assignments = tunable.iter().zip(&values).map(|((name, _), value)| {
                Element::new("ParameterAssignment").with("parameterRef", *name).with("value", number(*value))
            });
            sets.push(Element::new("ParameterValueSet").children(assignments));
        }
    }
    (!sets.is_empty()).then(|| {
        let list = Element::new("ValueSetDistribution").children(sets);
        distribution(
            header,
            file,
            Element::new("Deterministic").child(Element::new("DeterministicMultiParameterDistribution").child(list)),
        )
    })
}

fn distribution(header: Element, file: &str, kind: Element) -> Element {
    let scenario = Element::new("ScenarioFile").with("filepath", file);
    Element::new("OpenSCENARIO")
        .child(header)
        .child(Element::new("ParameterValueDistribution").child(scenario).child(kind))
}

/// The parameters that the scenario declares, with their names.
fn tunable<'a>(context: &'a Context<'_>) -> Vec<(&'a str, &'a Parameter)> {
    let named = |parameter: &'a Parameter| Some((context.names.find(&parameter.pointer)?.name.as_str(), parameter));
    context.parameters.iter().filter_map(named).collect()
}

fn current(context: &Context<'_>, parameter: &Parameter) -> f64 {
    context.names.find(&parameter.pointer).map_or(parameter.start, |found| found.value)
}

fn value_at(parameter: &Parameter, point: u32, dimension: usize) -> f64 {
    let base = PRIMES[dimension.min(PRIMES.len() - 1)];
    let shift = dimension.saturating_sub(PRIMES.len() - 1) as f64 * 0.618_033_988_749_895;
    let share = (radical_inverse(base, point) + shift).fract();
    let value = parameter.min + (parameter.max - parameter.min) * share;
    if parameter.integer { value.round() } else { (value * 1e6).round() / 1e6 }
}

/// Whether everybody starts on the road the file names: an expression can move a start along a road, not onto another.
fn same_roads(context: &Context<'_>, moved: &recrash_roads::Scenario) -> bool {
    let segment = |placement: &recrash_roads::Placement| {
        let back = super::places::reference_to_centre(placement.kind);
        let s = placement.s_m - back;
        (s >= 0.0).then(|| placement.path.segment_at(s))
    };
    let all = |scenario: &recrash_roads::Scenario| {
        std::iter::once(scenario.ego()).chain(scenario.partners()).map(segment).collect::<Vec<_>>()
    };
    all(context.scenario) == all(moved)
}
