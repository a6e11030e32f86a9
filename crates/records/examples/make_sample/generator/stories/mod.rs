//! Every kind of crash of the sample, by crash type.

mod alone;
mod backwards;
mod beside;
mod crossing;
mod oncoming;
mod others;
mod rear;

use super::story::Story;

/// All kinds, in the order in which their incidents are made.
pub fn all() -> impl Iterator<Item = &'static Story> {
    [
        rear::STORIES,
        beside::STORIES,
        backwards::STORIES,
        alone::STORIES,
        crossing::STORIES,
        oncoming::STORIES,
        others::STORIES,
    ]
    .into_iter()
    .flatten()
}
