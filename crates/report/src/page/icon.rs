//! Pictures of buttons and marks, drawn in the colour of the text around them.

use maud::{Markup, html};

fn stroke(path: &str) -> Markup {
    html! { svg.icon viewBox="0 0 16 16" aria-hidden="true" { path d=(path) fill="none" stroke="currentColor" stroke-width="1.8" stroke-linecap="round" stroke-linejoin="round" {} } }
}

fn solid(path: &str) -> Markup {
    html! { svg.icon viewBox="0 0 16 16" aria-hidden="true" { path d=(path) fill="currentColor" {} } }
}

/// The mark of the program: two crossing paths.
pub fn brand() -> Markup {
    html! {
        svg.icon viewBox="0 0 20 20" aria-hidden="true" {
            path d="M2 13H18" stroke="var(--ego)" stroke-width="2.6" stroke-linecap="round" {}
            path d="M8 2V10a6 6 0 0 0 6 6" fill="none" stroke="var(--partner)" stroke-width="2.6" stroke-linecap="round" {}
            circle cx="9" cy="13" r="2.4" fill="var(--ink)" {}
        }
    }
}

/// Back.
pub fn left() -> Markup {
    stroke("M10 3 5 8l5 5")
}

/// On.
pub fn right() -> Markup {
    stroke("M6 3l5 5-5 5")
}

/// To the start.
pub fn to_start() -> Markup {
    solid("M3 3h2v10H3zM14 3v10L6 8z")
}

/// One step back.
pub fn step_back() -> Markup {
    solid("M11 3h2v10h-2zM9 3v10L2 8z")
}

/// One step on.
pub fn step_on() -> Markup {
    solid("M3 3h2v10H3zM7 3v10l7-5z")
}

/// Play, and pause, of which the style shows one.
pub fn play_pause() -> Markup {
    html! {
        svg.icon.when-paused viewBox="0 0 16 16" aria-hidden="true" { path d="M3 2v12l11-6z" fill="currentColor" {} }
        svg.icon.when-playing viewBox="0 0 16 16" aria-hidden="true" { path d="M3 2h4v12H3zM9 2h4v12H9z" fill="currentColor" {} }
    }
}

/// The moment of the least gap.
pub fn closest() -> Markup {
    stroke("M1 8h4M3.5 5.5 6 8l-2.5 2.5M15 8h-4M12.5 5.5 10 8l2.5 2.5")
}

/// Repeat.
pub fn repeat() -> Markup {
    stroke("M13 8a5 5 0 1 1-1.6-3.7M13 2v3h-3")
}

/// Closer.
pub fn plus() -> Markup {
    stroke("M8 3v10M3 8h10")
}

/// Farther.
pub fn minus() -> Markup {
    stroke("M3 8h10")
}

/// Copy.
pub fn copy() -> Markup {
    stroke("M6 6h7v8H6zM3 10V2h7")
}

/// Good.
pub fn tick() -> Markup {
    stroke("M3 8.5 6.5 12 13 4.5")
}

/// Bad.
pub fn cross() -> Markup {
    stroke("M4 4l8 8M12 4l-8 8")
}

/// Neither.
pub fn dash() -> Markup {
    stroke("M4 8h8")
}

/// Look here.
pub fn bang() -> Markup {
    stroke("M8 3v6.2M8 12.6v.2")
}
