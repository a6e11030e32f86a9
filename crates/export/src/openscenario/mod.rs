//! OpenSCENARIO XML 1.3, with its OpenDRIVE map and, where numbers may move, the files of the logical scenario.

mod driven;
mod entities;
mod environment;
mod expression;
mod lateral;
mod line;
pub(crate) mod names;
mod places;
pub(crate) mod scene;
mod speed;
mod storyboard;
mod sweep;

use crate::opendrive::DriveMap;
use crate::xml::Element;
use crate::{ExportError, ExportFile, ExportOptions, PartnersAs};
pub(crate) use entities::{PROPERTY, height_m};
use names::Declarations;
use recrash_model::rollout::{ActorTrack, Role, Rollout};
use recrash_model::tuning::Parameter;
use recrash_roads::Scenario;

/// What the parts of a document are made from.
pub(crate) struct Context<'a> {
    pub scenario: &'a Scenario,
    pub map: DriveMap,
    pub names: Declarations,
    pub parameters: &'a [Parameter],
    /// The partners' recorded tracks; empty where they act by their policies.
    pub tracks: Vec<&'a ActorTrack>,
    pub rollout: Option<&'a Rollout>,
    pub options: &'a ExportOptions,
}

/// The files of a scenario: map, scenario, ranges, points.
pub(crate) fn files(
    scenario: &Scenario,
    rollout: Option<&Rollout>,
    parameters: &[Parameter],
    options: &ExportOptions,
) -> Result<Vec<ExportFile>, ExportError> {
    let draft = scenario.draft();
    let id = &draft.id;
    if scene::is_scene(draft) {
        return scene_files(scenario, rollout, options);
    }
    let tracks = match options.partners_as {
        PartnersAs::Actions => Vec::new(),
        PartnersAs::Trajectory => {
            let rollout = rollout.ok_or_else(|| ExportError::NeedsRollout { scenario: id.clone() })?;
            rollout.actors.iter().filter(|actor| actor.role == Role::Partner).collect()
        }
    };
    let map = DriveMap::new(scenario.network(), &scenario.draft().control);
    let names = Declarations::new(draft, parameters);
    let context = Context { scenario, map, names, parameters, tracks, rollout, options };
    let comment = crate::comment(draft);
    let title = crate::title(draft);
    let file = |name: String, root: Element| ExportFile { name, content: root.document(&comment) };

    let scenario_file = format!("{id}.xosc");
    let map_file = format!("{id}.xodr");
    let mut files = vec![
        file(map_file.clone(), context.map.document(scenario.network(), id)),
        file(scenario_file.clone(), document(&context, &title, &map_file)),
    ];
    // A recording cannot be varied.
    let varies = context.tracks.is_empty();
    if varies && parameters.iter().any(|parameter| context.names.find(&parameter.pointer).is_some()) {
        let header = |what: &str| header(&context, &format!("{title}: {what}"));
        let ranges = sweep::ranges(&context, header("ranges of its parameters"), &scenario_file);
        files.push(file(format!("{id}.ranges.xosc"), ranges));
        if let Some(points) = sweep::points(&context, header("points in the ranges of its parameters"), &scenario_file)
        {
            files.push(file(format!("{id}.points.xosc"), points));
        }
    }
    Ok(files)
}

/// The files of a scenario whose road users have plans: map and scenario. A recording cannot be varied.
fn scene_files(
    scenario: &Scenario,
    rollout: Option<&Rollout>,
    options: &ExportOptions,
) -> Result<Vec<ExportFile>, ExportError> {
    let draft = scenario.draft();
    let id = &draft.id;
    let recorded = rollout.ok_or_else(|| ExportError::NeedsRollout { scenario: id.clone() })?;
    let map = DriveMap::new(scenario.network(), &draft.control);
    let names = Declarations::default();
    let context = Context { scenario, map, names, parameters: &[], tracks: Vec::new(), rollout, options };
    let comment = crate::comment(draft);
    let map_file = format!("{id}.xodr");
    let document = scene::document(&context, recorded, &crate::title(draft), &map_file);
    let file = |name: String, root: Element| ExportFile { name, content: root.document(&comment) };
    Ok(vec![file(map_file, context.map.document(scenario.network(), id)), file(format!("{id}.xosc"), document)])
}

fn document(context: &Context<'_>, title: &str, map_file: &str) -> Element {
    let draft = context.scenario.draft();
    let json = |value: serde_json::Result<String>| value.unwrap_or_default();
    let carried = [
        ("recrash.id", draft.id.clone()),
        ("recrash.source", json(serde_json::to_string(&draft.source))),
        ("recrash.map", json(serde_json::to_string(&draft.map))),
        ("recrash.traffic", json(serde_json::to_string(&draft.traffic))),
        ("recrash.environment", json(serde_json::to_string(&draft.environment))),
    ];
    let storyboard = storyboard::storyboard(context);
    let carried = carried.into_iter().chain([(STORYBOARD, storyboard.fingerprint())]);
    let properties = Element::new("Properties").children(carried.map(|(name, value)| entities::property(name, &value)));
    Element::new("OpenSCENARIO").children([
        header(context, title).child(properties),
        storyboard::parameters(&context.names),
        storyboard::variables(),
        Element::new("CatalogLocations"),
        Element::new("RoadNetwork").child(Element::new("LogicFile").with("filepath", map_file)),
        entities::entities(context),
        storyboard,
    ])
}

fn header(context: &Context<'_>, description: &str) -> Element {
    Element::new("FileHeader")
        .with("revMajor", "1")
        .with("revMinor", "3")
        .with("date", &context.options.created)
        .with("description", description)
        .with("author", "recrash")
}

/// The root of the scenario's document, with partners that act.
pub(crate) fn scenario_element(scenario: &Scenario, parameters: &[Parameter], options: &ExportOptions) -> Element {
    let draft = scenario.draft();
    let map = DriveMap::new(scenario.network(), &scenario.draft().control);
    let names = Declarations::new(draft, parameters);
    let context = Context { scenario, map, names, parameters, tracks: Vec::new(), rollout: None, options };
    document(&context, &crate::title(draft), &format!("{}.xodr", draft.id))
}

/// The property of the header that holds the storyboard's fingerprint.
pub(crate) const STORYBOARD: &str = "recrash.storyboard";

/// The same for the entities of a scenario that the header holds as a whole.
pub(crate) const ENTITIES: &str = "recrash.entities";

/// How the maneuvers end that say where across its lane a partner is.
pub(crate) const LANES: &str = ": lanes";

/// How the name of the story begins that sets what a runner reads.
pub(crate) const WATCH: &str = "watch";

/// Whether an entity is an obstacle.
pub(crate) fn is_obstacle_name(name: &str) -> bool {
    name.starts_with("obstacle.")
}

/// The entity of an obstacle. Partners' ids hold no dot, so that the names never meet.
pub(crate) fn obstacle_name(position: usize) -> String {
    format!("obstacle.{}", position + 1)
}
