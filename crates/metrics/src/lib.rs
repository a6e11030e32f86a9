//! stub
pub mod encroachment;
mod polygon;
pub mod swept;
