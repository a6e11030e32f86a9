//! Reads the reports of one incident into an [`Account`](recrash_model::account::Account): typed facts, each with the words or the column it comes from.
//!
//! A small grammar of the English of crash reports. Tokens make sentences; chunks of a sentence are who is named, verbs,
//! parts of vehicles, places; verbs make event frames (who, what, to whom, where, negated, how far it came). A world is
//! carried along, so that "it", "the other vehicle" and a street's direction find their owner. The account is folded from
//! the frames, and then held against the columns: words win over columns, and what only a column tells is marked so.
//! The words live in `data/lexicon.toml`; ARCHITECTURE.md has a table of where a new rule of English goes.
//!
//! What this crate does **not** do: it opens no file, and it never guesses.

pub mod chunk;
pub mod frame;
pub mod lexicon;
pub mod token;
pub mod world;

mod fold;
mod incident;

pub use fold::{account, refold};
pub use incident::{incident_ids, incidents, only_refers};
