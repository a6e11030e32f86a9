//! Bodies over a line of the road.

use super::LeftRight;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Somebody is partly in one lane and partly in another, or beside the lanes: over which line its body reaches, and when.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Astride {
    /// Over which line.
    pub line: LaneLine,
    /// On which side of its own lane the line is, where told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side: Option<LeftRight>,
    /// When.
    pub when: AstrideWhen,
}

/// A line along a road.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LaneLine {
    /// Between the lanes and what lies beside them: room to park, a bicycle lane, a shoulder.
    Edge,
    /// Between two lanes of one direction.
    Lanes,
    /// Between the two directions.
    Centre,
}

/// From when somebody's body is over a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AstrideWhen {
    /// It drives so when the story begins.
    Start,
    /// Where it stands, or came to a stop.
    Stop,
    /// At the contact.
    Contact,
}

impl Astride {
    /// For sentences.
    pub fn words(self) -> String {
        let line = match self.line {
            LaneLine::Edge => "the edge of the lanes",
            LaneLine::Lanes => "the line between two lanes",
            LaneLine::Centre => "the line between the directions",
        };
        let side = match self.side {
            None => "",
            Some(LeftRight::Left) => " on the left of its lane",
            Some(LeftRight::Right) => " on the right of its lane",
        };
        let when = match self.when {
            AstrideWhen::Start => "at the start",
            AstrideWhen::Stop => "where it stands",
            AstrideWhen::Contact => "at the contact",
        };
        format!("over {line}{side}, {when}")
    }
}
