//! Pictures of buttons and marks, drawn in the colour of the text around them. Each stands once on the page, and is used by
//! its name: a table of thousands of rows has thousands of marks.

use maud::{Markup, html};

/// Name, whether it is filled (drawn with a stroke otherwise), and path.
const PICTURES: [(&str, bool, &str); 15] = [
    ("left", false, "M10 3 5 8l5 5"),
    ("right", false, "M6 3l5 5-5 5"),
    ("to-start", true, "M3 3h2v10H3zM14 3v10L6 8z"),
    ("step-back", true, "M11 3h2v10h-2zM9 3v10L2 8z"),
    ("step-on", true, "M3 3h2v10H3zM7 3v10l7-5z"),
    ("closest", false, "M1 8h4M3.5 5.5 6 8l-2.5 2.5M15 8h-4M12.5 5.5 10 8l2.5 2.5"),
    ("repeat", false, "M13 8a5 5 0 1 1-1.6-3.7M13 2v3h-3"),
    ("plus", false, "M8 3v10M3 8h10"),
    ("minus", false, "M3 8h10"),
    ("copy", false, "M6 6h7v8H6zM3 10V2h7"),
    ("cross", false, "M4 4l8 8M12 4l-8 8"),
    ("bang", false, "M8 3v6.2M8 12.6v.2"),
    ("search", false, "M7 2.5a4.5 4.5 0 1 0 .01 0M10.5 10.5 14 14"),
    ("event-back", false, "M12 3v10M8 8h-6M5 5 2 8l3 3"),
    ("event-on", false, "M4 3v10M8 8h6M11 5l3 3-3 3"),
];

/// The pictures, for the page to hold once.
pub fn sprite() -> Markup {
    html! {
        svg.sprite width="0" height="0" aria-hidden="true" {
            @for (name, filled, path) in PICTURES {
                symbol id={ "i-" (name) } viewBox="0 0 16 16" {
                    @if filled { path d=(path) fill="currentColor" {} }
                    @else { path d=(path) fill="none" stroke="currentColor" stroke-width="1.8" stroke-linecap="round" stroke-linejoin="round" {} }
                }
            }
        }
    }
}

fn of(name: &str) -> Markup {
    html! { svg.icon aria-hidden="true" { use href={ "#i-" (name) } {} } }
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
    of("left")
}

/// On.
pub fn right() -> Markup {
    of("right")
}

/// To the start.
pub fn to_start() -> Markup {
    of("to-start")
}

/// One step back.
pub fn step_back() -> Markup {
    of("step-back")
}

/// One step on.
pub fn step_on() -> Markup {
    of("step-on")
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
    of("closest")
}

/// Repeat.
pub fn repeat() -> Markup {
    of("repeat")
}

/// Closer.
pub fn plus() -> Markup {
    of("plus")
}

/// Farther.
pub fn minus() -> Markup {
    of("minus")
}

/// Copy.
pub fn copy() -> Markup {
    of("copy")
}

/// Bad.
pub fn cross() -> Markup {
    of("cross")
}

/// Look here.
pub fn bang() -> Markup {
    of("bang")
}

/// To the event before.
pub fn event_back() -> Markup {
    of("event-back")
}

/// To the next event.
pub fn event_on() -> Markup {
    of("event-on")
}

/// Look for.
pub fn search() -> Markup {
    of("search")
}
