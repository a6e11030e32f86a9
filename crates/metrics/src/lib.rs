//! stub
pub mod contact;
pub mod encroachment;
mod polygon;
pub mod swept;
