//! stub
pub mod contact;
pub mod ego;
pub mod encroachment;
pub mod following;
pub mod measure;
mod polygon;
pub mod scene;
pub mod swept;
