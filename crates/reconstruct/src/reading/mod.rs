//! How what is told is read off an account: words and facts become the types of `told`. Nothing else of this crate looks at an account's
//! words.

mod acts;
mod courses;
mod crash;
mod edge;
mod layout;
mod near;
mod order;
mod origin;
mod others;
mod phases;
mod role;
mod side;
mod sizes;
mod story;
mod things;
mod trailer;
mod turns;
mod words;
