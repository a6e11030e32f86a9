//! Selection: which few records stand for all of them, and what that covers.

use crate::origin::RecordRef;
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
    /// Farthest point first: makes the worst-served record's distance small (at most twice the best possible).
    KCenter,
    /// Facility location: makes the mean distance to the nearest pick small, greedily.
    FacilityLocation,
}

impl Strategy {
    /// Every strategy, the default first.
    pub const ALL: [Self; 4] = [Self::Stratified, Self::Kmeans, Self::KCenter, Self::FacilityLocation];

    /// Name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stratified => "stratified",
            Self::Kmeans => "kmeans",
            Self::KCenter => "k-center",
            Self::FacilityLocation => "facility-location",
        }
    }
}

/// How much one record counts in sharing out the picks and in what the clusters are fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Weighting {
    /// Every record counts one: frequent kinds of crash get more picks (the default, and the paper's).
    #[default]
    Frequency,
    /// A record counts by the highest injury severity alleged: harmful kinds of crash get more picks.
    Severity,
    /// Every template counts the same, however many records it has: rare kinds of crash get as many picks.
    Template,
}

impl Weighting {
    /// Every weighting, the default first.
    pub const ALL: [Self; 3] = [Self::Frequency, Self::Severity, Self::Template];

    /// Name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Frequency => "frequency",
            Self::Severity => "severity",
            Self::Template => "template",
        }
    }
}

/// Which embedding of the narratives was used.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EmbeddingInfo {
    /// Name, such as `tf-idf + truncated SVD`.
    pub name: String,
    /// Dimensions of the embedding as it was given, such as 384.
    pub source_dimensions: usize,
    /// Dimensions kept after principal component analysis.
    pub dimensions: usize,
    /// Share of the embedding's variance the kept dimensions hold, in [0, 1].
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
    /// Number, from 1; clusters are in the order of template size, then of the profile's tables, then of first member.
    pub number: usize,
    /// Scenario id that follows from it, such as `03-intersection-straight-left`.
    pub scenario_id: String,
    /// The template of the pick.
    pub template: Template,
    /// The pick: the record nearest to the cluster's centre whose crash is told.
    pub pick: RecordRef,
    /// Position of the pick in [`crate::record::RecordSet::records`].
    pub pick_index: usize,
    /// Positions of all members, nearest to the cluster's centre first; the pick is the first.
    pub members: Vec<usize>,
    /// Distance from the pick to its farthest member, in the clustering space.
    pub radius: f64,
    /// No record is of this template: its crash is invented, and it has no members. The pick, the record of the most alike template,
    /// lends the surroundings alone.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub invented: bool,
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

/// Values of two meta variables together; the other two are `None`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ValuePair {
    /// Road type.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub road: Option<RoadType>,
    /// Movement of the subject vehicle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sv: Option<Movement>,
    /// Movement of the crash partner.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cp: Option<Movement>,
    /// Work zone or not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub work_zone: Option<bool>,
}

impl std::fmt::Display for ValuePair {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let parts = [
            self.road.map(|road| road.label().to_owned()),
            self.sv.map(|sv| format!("SV {}", sv.label().to_lowercase())),
            self.cp.map(|cp| format!("CP {}", cp.label().to_lowercase())),
            self.work_zone.map(|zone| if zone { "work zone" } else { "no work zone" }.to_owned()),
        ];
        f.write_str(&parts.into_iter().flatten().collect::<Vec<_>>().join(", "))
    }
}

/// Pairs of meta-variable values: the measure of combinatorial testing (2-way coverage).
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PairCoverage {
    /// Pairs the profile can express.
    pub possible: usize,
    /// Pairs that occur in at least one usable record.
    pub observed: usize,
    /// Pairs that occur in at least one pick.
    pub covered: usize,
    /// Pairs that occur in a record and in no pick.
    pub holes_observed: Vec<ValuePair>,
    /// Pairs the profile can express that no record has.
    pub holes_possible: Vec<ValuePair>,
}

/// What the picks cover.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Coverage {
    /// Templates the profile can express.
    pub templates_possible: usize,
    /// Templates with at least one usable record.
    pub templates_observed: usize,
    /// Observed templates with at least one pick whose crash is told.
    pub templates_covered: usize,
    /// Usable records whose template is covered.
    pub records_covered: usize,
    /// Usable records.
    pub records: usize,
    /// Distance from the worst-served record to its nearest pick, in the clustering space.
    pub radius: f64,
    /// Mean distance of a record to its nearest pick, in the clustering space.
    pub mean_distance: f64,
    /// The same as `radius`, from each record to the pick of its own cluster, in the narrative's coordinates alone.
    #[serde(default)]
    pub embedding_radius: f64,
    /// The same as `mean_distance`, to the pick of the own cluster, in the narrative's coordinates alone.
    #[serde(default)]
    pub embedding_mean_distance: f64,
    /// Pairs of meta-variable values.
    #[serde(default)]
    pub pairs: PairCoverage,
    /// Templates with records and no pick whose crash is told.
    pub holes_observed: Vec<Template>,
    /// Templates the profile can express that no record has.
    pub holes_possible: Vec<Template>,
}

/// How much the selection depends on the seed: the same records, options and embedding under several seeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// Seeds tried, children of the selection's own.
    pub seeds: usize,
    /// How many seeds covered how many templates: `(templates covered, seeds)`, fewest first.
    pub templates_covered: Vec<(usize, usize)>,
    /// Mean of [`Coverage::radius`] over the seeds.
    pub mean_radius: f64,
    /// Mean of [`Coverage::mean_distance`] over the seeds.
    pub mean_distance: f64,
    /// Mean of [`Coverage::embedding_radius`] over the seeds.
    pub mean_embedding_radius: f64,
    /// Mean of [`Coverage::embedding_mean_distance`] over the seeds.
    pub mean_embedding_distance: f64,
    /// Mean share of picks two seeds have in common (Jaccard index over all pairs of seeds), in [0, 1].
    pub picks_in_common: f64,
    /// Mean agreement of the clusters of two seeds (adjusted Rand index over all pairs of seeds); 1 is the same clusters.
    pub cluster_agreement: f64,
}

/// One line of the table that helps to choose a budget.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BudgetRow {
    /// Budget tried.
    pub budget: usize,
    /// Sum of squared distances to the cluster centres; look for the elbow.
    pub inertia: f64,
    /// Mean silhouette, in [-1, 1]; `None` where it is not defined (one cluster, or one record each).
    pub silhouette: Option<f64>,
    /// Observed templates with at least one pick.
    pub templates_covered: usize,
    /// As [`Coverage::radius`].
    pub radius: f64,
    /// As [`Coverage::mean_distance`].
    pub mean_distance: f64,
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
    /// How much one record counts.
    #[serde(default)]
    pub weighting: Weighting,
    /// Sum of squared distances of the records to their cluster's centre, in the clustering space.
    #[serde(default)]
    pub inertia: f64,
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
