//! Selection: which few records stand for all of them, and what that covers.

use crate::record::RecordRef;
use crate::template::{Movement, RoadType, Template};
use serde::{Deserialize, Serialize};

/// How the picks are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Strategy {
    /// Every observed template first, then spread inside the large ones by k-means on the embedding (the default).
    Stratified,
    /// k-means on one-hot templates and the embedding, one pick per cluster (the paper's).
    Kmeans,
}

/// Which embedding of the narratives was used.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EmbeddingInfo {
    /// Name, such as `tf-idf + truncated SVD`.
    pub name: String,
    /// Dimensions kept.
    pub dimensions: usize,
    /// Share of the variance the kept dimensions hold, in [0, 1].
    pub explained_variance: f64,
}

/// A template and how many usable records it has.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TemplateCount {
    /// The template.
    pub template: Template,
    /// Usable records.
    pub records: usize,
    /// Picks.
    pub picks: usize,
}

/// One cluster and its pick.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cluster {
    /// Number, from 1; clusters are in the order of template size, then of first member.
    pub number: usize,
    /// Scenario id that follows from it, such as `03-intersection-straight-left`.
    pub scenario_id: String,
    /// The template of the pick.
    pub template: Template,
    /// The pick: the record nearest to the cluster's centre.
    pub pick: RecordRef,
    /// Position of the pick in [`crate::record::RecordSet::records`].
    pub pick_index: usize,
    /// Positions of all members, nearest to the centre first; the pick is the first.
    pub members: Vec<usize>,
    /// Distance from the pick to its farthest member, in the clustering space.
    pub radius: f64,
}

/// A record's place on the cluster map: the first two principal components of the clustering space.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MapPoint {
    /// Position in [`crate::record::RecordSet::records`].
    pub record: usize,
    /// Index into [`Selection::clusters`].
    pub cluster: usize,
    /// First component.
    pub x: f64,
    /// Second component.
    pub y: f64,
}

/// Two cross tables of the usable records, as in the paper.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct StageTables {
    /// Records by road type, in the profile's order.
    pub road_types: Vec<(RoadType, usize)>,
    /// Columns of `movements`: SV movements, in the profile's order.
    pub sv_movements: Vec<Movement>,
    /// Rows: CP movement, and the counts by SV movement.
    pub movements: Vec<(Movement, Vec<usize>)>,
    /// Records in work zones.
    pub work_zone: usize,
    /// Records of the largest template.
    pub largest_template: usize,
}

/// What the picks cover.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Coverage {
    /// Templates the profile can express.
    pub templates_possible: usize,
    /// Templates with at least one usable record.
    pub templates_observed: usize,
    /// Observed templates with at least one pick.
    pub templates_covered: usize,
    /// Usable records whose template has a pick.
    pub records_covered: usize,
    /// Usable records.
    pub records: usize,
    /// Distance from the worst-served record to its nearest pick, in the clustering space.
    pub radius: f64,
    /// Mean distance of a record to its nearest pick, in the clustering space.
    pub mean_distance: f64,
    /// Templates with records and no pick.
    pub holes_observed: Vec<Template>,
    /// Templates the profile can express that no record has.
    pub holes_possible: Vec<Template>,
}

/// The result of selection.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Selection {
    /// How the picks were chosen.
    pub strategy: Strategy,
    /// Asked-for number of picks.
    pub budget: usize,
    /// Seed.
    pub seed: u64,
    /// Embedding of the narratives.
    pub embedding: EmbeddingInfo,
    /// Weight of the one-hot template against the embedding in the clustering space.
    pub template_weight: f64,
    /// Cross tables of the usable records.
    pub tables: StageTables,
    /// Observed templates, most frequent first.
    pub templates: Vec<TemplateCount>,
    /// Clusters with their picks.
    pub clusters: Vec<Cluster>,
    /// Places on the cluster map, one per usable record.
    pub map: Vec<MapPoint>,
    /// What the picks cover.
    pub coverage: Coverage,
}
