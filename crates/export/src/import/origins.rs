//! Where in the file each part of the scenario was read from, so that what the check says of a part names its element.

use crate::xml::Element;
use recrash_model::{Diagnostic, Location};

/// Parts of a scenario with the elements that hold them.
#[derive(Debug, Default)]
pub(super) struct Origins {
    list: Vec<Origin>,
}

#[derive(Debug)]
struct Origin {
    /// JSON path of the part, such as `partners[0].speed_mps`.
    part: String,
    element: String,
    line: u64,
}

impl Origins {
    /// A part that was read from an element.
    pub fn add(&mut self, part: &str, place: &str, element: &Element) {
        self.list.push(Origin { part: part.to_owned(), element: place.to_owned(), line: element.line });
    }

    /// A number that was read from its declaration.
    pub fn add_number(&mut self, pointer: &str, place: &str, element: &Element) {
        self.add(&json_path(pointer), place, element);
    }

    /// The same diagnostics with element and line in place of the line of a document that no user has seen.
    pub fn place(&self, list: Vec<Diagnostic>) -> Vec<Diagnostic> {
        list.into_iter()
            .map(|diagnostic| {
                let path = diagnostic.location.path.clone().unwrap_or_default();
                let holding = self.list.iter().filter(|origin| holds(&origin.part, &path));
                let location = match holding.max_by_key(|origin| origin.part.len()) {
                    Some(origin) => {
                        Location { line: Some(origin.line), ..Location::at_path(format!("{}: {path}", origin.element)) }
                    }
                    None => Location { line: None, ..diagnostic.location },
                };
                Diagnostic { location, ..diagnostic }
            })
            .collect()
    }
}

/// Whether a path is a part or lies in it.
fn holds(part: &str, path: &str) -> bool {
    path.strip_prefix(part).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// `/partners/0/speed_mps` as the check writes it: `partners[0].speed_mps`.
fn json_path(pointer: &str) -> String {
    let mut path = String::new();
    for part in pointer.split('/').filter(|part| !part.is_empty()) {
        if part.bytes().all(|byte| byte.is_ascii_digit()) {
            path.push_str(&format!("[{part}]"));
        } else {
            if !path.is_empty() {
                path.push('.');
            }
            path.push_str(part);
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_narrowest_part_that_holds_a_path_is_named() {
        let mut origins = Origins::default();
        let at = |line| Element { line, ..Element::default() };
        origins.add("partners[0]", "the partner", &at(10));
        origins.add_number("/partners/0/speed_mps", "its speed", &at(3));
        let told = |path: &str| {
            let told = origins.place(vec![Diagnostic::error_at("scenario.range", path, "")]).remove(0).location;
            (told.line, told.path.unwrap_or_default())
        };
        assert_eq!(told("partners[0].speed_mps"), (Some(3), "its speed: partners[0].speed_mps".to_owned()));
        assert_eq!(told("partners[0].start"), (Some(10), "the partner: partners[0].start".to_owned()));
        assert_eq!(told("partners[01]"), (None, "partners[01]".to_owned()));
    }
}
