//! XML as a tree: small enough to be built, compared and written whole. Escaping and parsing are quick-xml's.

use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};
use quick_xml::{Reader, Writer, XmlVersion};
use recrash_model::hash::Fnv;

/// An element.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Element {
    pub name: String,
    pub attributes: Vec<(String, String)>,
    pub children: Vec<Element>,
    /// Text between the tags; an element has text or children, never both.
    pub text: String,
    /// Line it begins on, counted from 1; 0 where it was not read from a file.
    pub line: u64,
}

impl Element {
    pub fn new(name: &str) -> Self {
        Self { name: name.to_owned(), ..Self::default() }
    }

    /// The same with an attribute.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl Into<String>) -> Self {
        self.attributes.push((name.to_owned(), value.into()));
        self
    }

    /// The same with a number as an attribute.
    #[must_use]
    pub fn with_number(self, name: &str, value: f64) -> Self {
        self.with(name, number(value))
    }

    /// The same with a child.
    #[must_use]
    pub fn child(mut self, child: Element) -> Self {
        self.children.push(child);
        self
    }

    /// The same with children.
    #[must_use]
    pub fn children(mut self, children: impl IntoIterator<Item = Element>) -> Self {
        self.children.extend(children);
        self
    }

    /// The same with text.
    #[must_use]
    pub fn text(mut self, text: impl Into<String>) -> Self {
        self.text = text.into();
        self
    }

    /// The value of an attribute.
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// The first child of this name.
    pub fn find(&self, name: &str) -> Option<&Element> {
        self.children.iter().find(|child| child.name == name)
    }

    /// All children of this name.
    pub fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Element> {
        self.children.iter().filter(move |child| child.name == name)
    }

    /// The first element of this name at any depth.
    pub fn deep(&self, name: &str) -> Option<&Element> {
        self.children.iter().find_map(|child| if child.name == name { Some(child) } else { child.deep(name) })
    }

    /// A hash of names, attributes, text and children (FNV-1a, 64 bits), whatever the layout of the file they are in.
    pub fn fingerprint(&self) -> String {
        fn add(hash: &mut Fnv, text: &str) {
            hash.write(text.as_bytes());
            hash.write(&[0]);
        }
        fn walk(element: &Element, hash: &mut Fnv) {
            add(hash, &element.name);
            add(hash, &element.text);
            for (name, value) in &element.attributes {
                add(hash, name);
                add(hash, &allowed(value));
            }
            add(hash, "<");
            element.children.iter().for_each(|child| walk(child, hash));
            add(hash, ">");
        }
        let mut hash = Fnv::default();
        walk(self, &mut hash);
        hash.hexadecimal()
    }

    /// The document with this root, a comment above it.
    pub fn document(&self, comment: &str) -> Vec<u8> {
        let mut writer = Writer::new(Vec::new());
        let emitted = (|| {
            writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
            new_line(&mut writer, 0)?;
            let safe = format!(" {} ", in_comment(comment));
            writer.write_event(Event::Comment(BytesText::from_escaped(safe)))?;
            new_line(&mut writer, 0)?;
            self.write(&mut writer, 0)
        })();
        emitted.expect("writing into memory cannot fail");
        let mut bytes = writer.into_inner();
        bytes.push(b'\n');
        bytes
    }

    fn write(&self, writer: &mut Writer<Vec<u8>>, depth: usize) -> std::io::Result<()> {
        let mut start = BytesStart::new(self.name.as_str());
        for (name, value) in &self.attributes {
            start.push_attribute((name.as_str(), allowed(value).as_str()));
        }
        if self.children.is_empty() && self.text.is_empty() {
            return writer.write_event(Event::Empty(start));
        }
        writer.write_event(Event::Start(start))?;
        if self.children.is_empty() {
            writer.write_event(Event::Text(BytesText::new(&allowed(&self.text))))?;
        }
        // Points and the like read best on one line.
        let short = self.children.len() <= 3 && self.children.iter().all(|child| !child.text.is_empty());
        for child in &self.children {
            if !short {
                new_line(writer, depth + 1)?;
            }
            child.write(writer, depth + 1)?;
        }
        if !short {
            new_line(writer, depth)?;
        }
        writer.write_event(Event::End(BytesEnd::new(self.name.as_str())))
    }
}

fn new_line(writer: &mut Writer<Vec<u8>>, depth: usize) -> std::io::Result<()> {
    writer.write_event(Event::Text(BytesText::from_escaped(format!("\n{}", "  ".repeat(depth)))))
}

/// Elements inside one another that are read; our own files have 16.
const MOST_DEPTH: usize = 64;

/// Elements that are read in all. A recorded partner takes three per step, and a scenario has 1200 steps at most.
const MOST_ELEMENTS: usize = 1 << 18;

/// Attributes of one element that are read; our own have 9.
const MOST_ATTRIBUTES: usize = 64;

/// Reads a document.
///
/// # Errors
/// The line, and what is wrong there.
pub(crate) fn parse(text: &str) -> Result<Element, (u64, String)> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut reader = Reader::from_str(text);
    let mut lines = Lines { text: text.as_bytes(), counted: 0, line: 1 };
    let mut open: Vec<Element> = Vec::new();
    let mut root = None;
    let mut count = 0_usize;
    loop {
        // What comes next begins here.
        let line = lines.at(reader.buffer_position());
        let event = reader.read_event().map_err(|error| (line, format!("not well-formed XML: {error}")))?;
        let finished = match event {
            Event::Start(start) => {
                open.push(element(&start, line)?);
                count += 1;
                None
            }
            Event::Empty(start) => {
                count += 1;
                Some(element(&start, line)?)
            }
            Event::End(_) => open.pop(),
            Event::Text(text) => {
                let text = text.xml10_content();
                if let Some(inner) = open.last_mut() {
                    inner.text.push_str(text.trim());
                }
                None
            }
            Event::DocType(_) => return Err((line, "a document type is not read".to_owned())),
            Event::Eof => break,
            Event::CData(_) | Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::GeneralRef(_) => None,
        };
        if count > MOST_ELEMENTS || open.len() > MOST_DEPTH {
            let message = format!("more than {MOST_ELEMENTS} elements, or {MOST_DEPTH} inside one another");
            return Err((line, message));
        }
        if let Some(finished) = finished {
            match open.last_mut() {
                Some(outer) => outer.children.push(finished),
                None if root.is_none() => root = Some(finished),
                None => return Err((line, "a second root element".to_owned())),
            }
        }
    }
    match (root, open.last()) {
        (Some(root), None) => Ok(root),
        (_, Some(open)) => Err((open.line, format!("<{}> is never closed; is the file complete?", open.name))),
        (None, None) => Err((lines.at(text.len() as u64), "there is no XML element in it".to_owned())),
    }
}

/// Counts lines once, from the beginning to the end.
struct Lines<'a> {
    text: &'a [u8],
    counted: usize,
    line: u64,
}

impl Lines<'_> {
    /// The line of a byte behind those asked for before.
    fn at(&mut self, position: u64) -> u64 {
        let until = usize::try_from(position).unwrap_or(usize::MAX).min(self.text.len());
        let new = self.text.get(self.counted..until).unwrap_or_default();
        self.line += new.iter().filter(|&&byte| byte == b'\n').count() as u64;
        self.counted = self.counted.max(until);
        self.line
    }
}

fn element(start: &BytesStart<'_>, line: u64) -> Result<Element, (u64, String)> {
    let mut element = Element { line, ..Element::new(start.name().as_ref()) };
    for attribute in start.attributes() {
        let attribute = attribute.map_err(|error| (line, format!("not well-formed XML: {error}")))?;
        let name = attribute.key.as_ref().to_owned();
        let value = attribute
            .normalized_value(XmlVersion::Explicit1_0)
            .map_err(|error| (line, format!("attribute {name}: {error}")))?;
        element.attributes.push((name, value.into_owned()));
        if element.attributes.len() > MOST_ATTRIBUTES {
            return Err((line, format!("<{}> has more than {MOST_ATTRIBUTES} attributes", element.name)));
        }
    }
    Ok(element)
}

/// Text without the characters XML 1.0 has no way to hold.
fn allowed(text: &str) -> String {
    text.chars()
        .filter(|&c| c >= ' ' || c == '\n' || c == '\t')
        .filter(|&c| c != '\u{fffe}' && c != '\u{ffff}')
        .collect()
}

/// Text as a comment can hold it: no two hyphens in a row.
fn in_comment(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in allowed(text).chars() {
        if c == '-' && safe.ends_with('-') {
            safe.push(' ');
        }
        safe.push(c);
    }
    safe
}

/// A number as XML and every format here take it: no exponent, no negative zero, the shortest digits that read back to
/// the same value.
pub(crate) fn number(value: f64) -> String {
    let value = if value == 0.0 { 0.0 } else { value };
    format!("{value}")
}

/// A coordinate, angle or derived time, rounded to 1e-9: far below any tolerance, and readable.
pub(crate) fn rounded(value: f64) -> f64 {
    let scaled = value * 1e9;
    if scaled.abs() < 9e15 { scaled.round() / 1e9 } else { value }
}
