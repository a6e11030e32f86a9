//! One file: bytes in, records and rejected rows out, in file order.

use crate::MAX_FILE_BYTES;
use crate::areas;
use crate::columns::{Columns, NotAHeader, Recognised, edition_name, recognise};
use crate::error::{IngestError, is_binary, other_format};
use crate::notes::Notes;
use crate::row::{self, Draft};
use crate::stream::{Bytes, Stream};
use crate::text::{decode, excerpt};
use csv::ByteRecord;
use recrash_model::record::{Edition, Reject, RejectReason, SourceFile};
use recrash_model::{Diagnostic, Location, Severity};
use std::borrow::Cow;
use std::io::{Cursor, Read, SeekFrom};

/// Characters that part the fields: the published comma, and what spreadsheets write instead.
const DELIMITERS: [u8; 3] = [b',', b';', b'\t'];

/// Most malformed rows that get a diagnostic of their own in one file; the others are counted (each is rejected by its
/// row number all the same).
const MOST_MALFORMED_TOLD: usize = 100;

/// A field longer than this has swallowed rows behind an unclosed quote. The longest published narrative has 3,500
/// bytes. [byte]
const LONGEST_FIELD_BYTES: usize = 100_000;

/// Most headers in one file; further ones count as malformed rows.
const MOST_HEADERS: usize = 100;

/// How many times its own size of a file is read again at most, to save rows behind unclosed quotes. A file can be built
/// in which every line swallows all that follow; without a bound its time would grow with the square of its size.
const MOST_REREADS: u64 = 16;

/// How much of a file is looked at to tell UTF-16 without a mark: no more than a header. [byte]
const PROBED_FOR_UTF16: usize = 512;

/// What one file holds.
#[derive(Debug)]
pub struct FileContent {
    /// The file, once for each edition in it.
    pub sources: Vec<SourceFile>,
    /// Rows that are records.
    pub drafts: Vec<Draft>,
    /// Rows that are none.
    pub rejects: Vec<Reject>,
    /// Remarks.
    pub diagnostics: Vec<Diagnostic>,
}

/// How much of a file is looked at before it is read. [byte]
const HEAD_BYTES: usize = 1 << 16;

/// Reads one file.
pub fn read_file(name: &str, bytes: &mut dyn Bytes, sha256: &str) -> Result<FileContent, IngestError> {
    let file = || name.to_owned();
    let unreadable = |error| IngestError::unreadable(name, &error);
    let length = bytes.seek(SeekFrom::End(0)).map_err(unreadable)?;
    if length > MAX_FILE_BYTES as u64 {
        return Err(IngestError::TooLarge { file: file(), bytes: length, limit: MAX_FILE_BYTES });
    }
    bytes.rewind().map_err(unreadable)?;
    let mut head = Vec::new();
    Read::take(&mut *bytes, HEAD_BYTES as u64).read_to_end(&mut head).map_err(unreadable)?;
    let (encoding, mark) = encoding_of(&head);
    if encoding != encoding_rs::UTF_8 {
        bytes.rewind().map_err(unreadable)?;
        let mut whole = Vec::new();
        bytes.read_to_end(&mut whole).map_err(unreadable)?;
        let text = encoding.decode(&whole).0.into_owned();
        drop(whole);
        return read_file(name, &mut Cursor::new(text.into_bytes()), sha256);
    }
    let head = &head[mark..];
    if head.trim_ascii().is_empty() && is_blank(bytes).map_err(unreadable)? {
        return Err(IngestError::Empty { file: file() });
    }
    if let Some((looks_like, hint)) = other_format(head) {
        return Err(IngestError::NotText { file: file(), looks_like, hint });
    }
    let (delimiter, recognised) = match first_header(bytes, mark).map_err(unreadable)? {
        Ok(found) => found,
        Err((_, NotAHeader::Missing { edition, names })) => {
            return Err(IngestError::MissingColumns { file: file(), edition: edition_name(edition), missing: names });
        }
        Err((_, NotAHeader::Unknown)) if is_binary(head) => {
            let (looks_like, hint) = ("a binary file", "give the CSV file as NHTSA publishes it");
            return Err(IngestError::NotText { file: file(), looks_like, hint });
        }
        Err((start, NotAHeader::Unknown)) => return Err(IngestError::UnknownHeader { file: file(), start }),
    };
    let edition = recognised.columns.edition;
    let stream = Stream::new(bytes, mark).map_err(unreadable)?;
    let content = FileReader::new(name, sha256, recognised).read(stream, delimiter).map_err(unreadable)?;
    if content.sources.iter().all(|part| part.rows == 0) {
        return Err(IngestError::HeaderOnly { file: file(), edition: edition_name(edition) });
    }
    Ok(content)
}
/// The encoding by a file's first bytes, and the length of its mark: UTF-16 (a spreadsheet's "Unicode text") with a mark or
/// without one, else UTF-8.
fn encoding_of(head: &[u8]) -> (&'static encoding_rs::Encoding, usize) {
    let unmarked = || (unmarked_utf16(head).unwrap_or(encoding_rs::UTF_8), 0);
    encoding_rs::Encoding::for_bom(head).unwrap_or_else(unmarked)
}

/// The bytes without a UTF-8 mark; UTF-16 is converted.
fn as_utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    match encoding_of(bytes) {
        (encoding, mark) if encoding == encoding_rs::UTF_8 => Cow::Borrowed(&bytes[mark..]),
        (encoding, _) => Cow::Owned(encoding.decode(bytes).0.into_owned().into_bytes()),
    }
}

/// Whether there is nothing but blanks.
fn is_blank(bytes: &mut dyn Bytes) -> std::io::Result<bool> {
    bytes.rewind()?;
    let mut buffer = vec![0; HEAD_BYTES];
    let mut is_first = true;
    loop {
        let read = bytes.read(&mut buffer)?;
        let mark = if std::mem::take(&mut is_first) { encoding_of(&buffer[..read]).1 } else { 0 };
        if read == 0 || !buffer[mark..read].trim_ascii().is_empty() {
            return Ok(read == 0);
        }
    }
}

/// Tells UTF-16 without a mark by its header: of the Latin letters there, every second byte is zero.
fn unmarked_utf16(bytes: &[u8]) -> Option<&'static encoding_rs::Encoding> {
    let probe = &bytes[..bytes.len().min(PROBED_FOR_UTF16)];
    let zeros = |first: usize| probe.iter().skip(first).step_by(2).filter(|byte| **byte == 0).count();
    let (even, odd, half) = (zeros(0), zeros(1), probe.len() / 2);
    match (even * 10, odd * 10) {
        (none, all) if none <= half && all >= 9 * half && half > 0 => Some(encoding_rs::UTF_16LE),
        (all, none) if none <= half && all >= 9 * half && half > 0 => Some(encoding_rs::UTF_16BE),
        _ => None,
    }
}

/// The delimiter and the columns; or how the first line starts, and why it is no header.
type HeaderFound = Result<(u8, Recognised), (String, NotAHeader)>;

/// The header on the first line, by the delimiter that makes one of it.
fn first_header(bytes: &mut dyn Bytes, mark: usize) -> std::io::Result<HeaderFound> {
    let mut failure = None;
    for delimiter in DELIMITERS {
        let mut row = ByteRecord::new();
        reader(Stream::new(&mut *bytes, mark)?, delimiter).read_byte_record(&mut row)?;
        match recognise(&names(&row)) {
            Ok(recognised) => return Ok(Ok((delimiter, recognised))),
            Err(NotAHeader::Unknown) if failure.is_some() => {}
            Err(problem) => failure = Some((excerpt(&names(&row).join(",")), problem)),
        }
    }
    Ok(Err(failure.unwrap_or((String::new(), NotAHeader::Unknown))))
}

/// A table of any header, for mapped files.
#[derive(Debug)]
pub struct RawTable {
    /// First row.
    pub header: Vec<Vec<u8>>,
    /// Rows of the header's width, each with its number, counted from 1 without the header.
    pub rows: Vec<(u64, ByteRecord)>,
    /// Rows of another shape, and what is wrong with them.
    pub malformed: Vec<(u64, String)>,
}

/// Reads a table of any header. The delimiter is the one that makes the most columns of the first line. An unclosed
/// quote takes the rows below it with it: without knowing the columns there is no telling where one begins.
pub fn raw_table(name: &str, bytes: &[u8]) -> Result<RawTable, IngestError> {
    let file = || name.to_owned();
    let bytes = as_utf8(bytes);
    if bytes.trim_ascii().is_empty() {
        return Err(IngestError::Empty { file: file() });
    }
    if let Some((looks_like, hint)) = other_format(&bytes) {
        return Err(IngestError::NotText { file: file(), looks_like, hint });
    }
    if is_binary(&bytes) {
        return Err(IngestError::NotText { file: file(), looks_like: "a binary file", hint: "give a CSV file" });
    }
    let width = |delimiter: u8| {
        let mut row = ByteRecord::new();
        // An in-memory reader without UTF-8 checks and with flexible widths has no way to fail.
        let _ = reader(Cursor::new(&*bytes), delimiter).read_byte_record(&mut row);
        row.len()
    };
    let delimiter = DELIMITERS.into_iter().rev().max_by_key(|&delimiter| width(delimiter)).unwrap_or(b',');
    let mut reader = reader(Cursor::new(&*bytes), delimiter);
    let mut row = ByteRecord::new();
    let mut table = RawTable { header: Vec::new(), rows: Vec::new(), malformed: Vec::new() };
    let mut number = 0;
    while let Ok(true) = reader.read_byte_record(&mut row) {
        if table.header.is_empty() {
            table.header = row.iter().map(<[u8]>::to_vec).collect();
            continue;
        }
        number += 1;
        if row.len() != table.header.len() {
            table.malformed.push((number, format!("{} fields instead of {}", row.len(), table.header.len())));
        } else if row.iter().any(|field| field.len() > LONGEST_FIELD_BYTES) {
            table.malformed.push((number, format!("a field is longer than {LONGEST_FIELD_BYTES} bytes")));
        } else if in_memory(&row, reader.position(), &bytes).ends_inside_quotes() {
            table.malformed.push((number, "the file ends inside a quoted field".to_owned()));
        } else {
            table.rows.push((number, row.clone()));
        }
    }
    Ok(table)
}

fn reader<R: Read>(bytes: R, delimiter: u8) -> csv::Reader<R> {
    csv::ReaderBuilder::new().has_headers(false).flexible(true).delimiter(delimiter).from_reader(bytes)
}

/// A row of a table in memory.
fn in_memory<'a>(row: &ByteRecord, end: &csv::Position, bytes: &'a [u8]) -> Span<'a> {
    let start = row.position().map_or(0, |position| position.byte() as usize);
    let end = (end.byte() as usize).min(bytes.len());
    Span::of(row, bytes.get(start..end).unwrap_or_default(), end == bytes.len())
}

fn names(row: &ByteRecord) -> Vec<String> {
    row.iter().map(|name| decode(name).0.into_owned()).collect()
}

struct FileReader<'a> {
    name: &'a str,
    sha256: &'a str,
    columns: Columns,
    notes: Notes,
    rows: u64,
    malformed: usize,
    content: FileContent,
}

impl<'a> FileReader<'a> {
    fn new(name: &'a str, sha256: &'a str, recognised: Recognised) -> Self {
        let content =
            FileContent { sources: Vec::new(), drafts: Vec::new(), rejects: Vec::new(), diagnostics: Vec::new() };
        let columns = recognised.columns.clone();
        let mut this = Self { name, sha256, columns, notes: Notes::default(), rows: 0, malformed: 0, content };
        this.begin_part(recognised, 1);
        this
    }

    fn read(mut self, bytes: Stream<'_>, delimiter: u8) -> std::io::Result<FileContent> {
        let length = bytes.length();
        let mut reader = reader(bytes, delimiter);
        let mut row = ByteRecord::new();
        let mut header_pending = true;
        let mut reread = 0;
        let mut headers = 1;
        loop {
            let begin = reader.position().byte();
            reader.get_mut().forget_before(begin);
            if !reader.read_byte_record(&mut row)? {
                break;
            }
            if std::mem::take(&mut header_pending) {
                continue;
            }
            let end = reader.position().byte();
            let start = row.position().map_or(begin, csv::Position::byte);
            let span = Span::of(&row, reader.get_ref().between(start, end), end >= length);
            if is_header(&row)
                && headers < MOST_HEADERS
                && let Ok(recognised) = recognise(&names(&row))
            {
                headers += 1;
                self.begin_part(recognised, span.line);
                continue;
            }
            if let Err((problem, hint)) = self.read_row(&row, &span) {
                self.reject(&row, &span, problem, hint);
                if let Some(position) = span.next_row_inside(delimiter) {
                    reread += span.end() - position.byte();
                    if reread > MOST_REREADS * length {
                        self.give_up(&span);
                        break;
                    }
                    reader.seek(position)?;
                }
            }
        }
        Ok(self.finish())
    }

    /// Reads a row of data; else says what is wrong with it, and what to do.
    fn read_row(&mut self, row: &ByteRecord, span: &Span<'_>) -> Result<(), (String, &'static str)> {
        self.rows += 1;
        if let Some(part) = self.content.sources.last_mut() {
            part.rows += 1;
        }
        self.check_shape(row, span)?;
        let draft = row::read(row, &self.columns, self.name, self.rows, &mut self.notes)
            .map_err(|problem| (problem, "give the row as published; nothing of it was used"))?;
        self.content.drafts.push(draft);
        Ok(())
    }

    /// What the file holds, with all that is to be said of it.
    fn finish(mut self) -> FileContent {
        if self.malformed > MOST_MALFORMED_TOLD {
            let message = format!(
                "{} more rows are malformed; each is rejected by its row number",
                self.malformed - MOST_MALFORMED_TOLD
            );
            self.tell(Severity::Warning, "records.malformed-row", self.in_file(), message);
        }
        self.content.diagnostics.extend(self.notes.diagnostics(self.name));
        self.content.diagnostics.extend(areas::put_right(&mut self.content.drafts, self.name));
        self.content
    }

    /// Takes over a header: the first one, or one further down where files were put one after the other.
    fn begin_part(&mut self, recognised: Recognised, line: u64) {
        let edition = recognised.columns.edition;
        let at = || Location { file: Some(self.name.to_owned()), line: Some(line), ..Location::default() };
        let mut told = Vec::new();
        if !self.content.sources.is_empty() {
            let message = format!(
                "a second header after {} data rows: several files stand in this one; read on as the {}",
                self.rows,
                edition_name(edition)
            );
            told.push(Diagnostic::new(Severity::Note, "records.second-header", at(), message));
        }
        let list = |names: &[String]| {
            names.iter().take(20).map(|name| format!("\"{}\"", excerpt(name))).collect::<Vec<_>>().join(", ")
        };
        if !recognised.unknown.is_empty() {
            let message =
                format!("{} columns are in no edition: {}", recognised.unknown.len(), list(&recognised.unknown));
            told.push(
                Diagnostic::new(Severity::Note, "records.unknown-column", at(), message)
                    .with_hint("they were not read"),
            );
        }
        if !recognised.repeated.is_empty() {
            let message = format!("columns stand more than once: {}", list(&recognised.repeated));
            told.push(
                Diagnostic::new(Severity::Warning, "records.repeated-column", at(), message)
                    .with_hint("the first of each was read"),
            );
        }
        if !recognised.absent.is_empty() {
            let names: Vec<String> = recognised.absent.iter().map(|name| (*name).to_owned()).collect();
            let message = format!("the {} has columns that are not here: {}", edition_name(edition), list(&names));
            told.push(
                Diagnostic::new(Severity::Warning, "records.missing-column", at(), message)
                    .with_hint("what they hold is taken as not reported"),
            );
        }
        self.content.diagnostics.extend(told);
        let same_edition = self.content.sources.last().is_some_and(|part: &SourceFile| part.edition == edition);
        if !same_edition {
            self.content.sources.push(self.part(edition));
        }
        self.columns = recognised.columns;
    }

    fn part(&self, edition: Edition) -> SourceFile {
        SourceFile { name: self.name.to_owned(), edition, rows: 0, sha256: self.sha256.to_owned() }
    }

    /// Whether the row has the shape the header promises.
    fn check_shape(&self, row: &ByteRecord, span: &Span<'_>) -> Result<(), (String, &'static str)> {
        if span.ends_inside_quotes() {
            return Err(("the file ends inside a quoted field".to_owned(), "the file was cut; get it again"));
        }
        if row.len() != self.columns.width {
            let kind = if row.len() < self.columns.width { "too few" } else { "too many" };
            let message = format!("{kind} fields: {} instead of {}", row.len(), self.columns.width);
            return Err((message, "look for a missing or an unescaped quote, or a line cut short"));
        }
        if let Some(field) = row.iter().position(|field| field.len() > LONGEST_FIELD_BYTES) {
            let message = format!("field {} is longer than {LONGEST_FIELD_BYTES} bytes", field + 1);
            return Err((message, "look for a quote that is never closed"));
        }
        Ok(())
    }

    fn reject(&mut self, row: &ByteRecord, span: &Span<'_>, problem: String, hint: &str) {
        self.malformed += 1;
        let record = row::record_ref(row, &self.columns);
        self.content.rejects.push(Reject {
            file: self.name.to_owned(),
            row: self.rows,
            record,
            reason: RejectReason::Malformed,
        });
        if self.malformed <= MOST_MALFORMED_TOLD {
            let location = Location { row: Some(self.rows), line: Some(span.line), ..self.in_file() };
            let diagnostic = Diagnostic::new(Severity::Warning, "records.malformed-row", location, problem);
            self.content.diagnostics.push(diagnostic.with_hint(hint));
        }
    }

    fn give_up(&mut self, span: &Span<'_>) {
        let location = Location { row: Some(self.rows), line: Some(span.line), ..self.in_file() };
        let message = "too many quotes are never closed; nothing below this row was read".to_owned();
        self.tell(Severity::Error, "records.quotes-broken", location, message);
    }

    fn in_file(&self) -> Location {
        Location { file: Some(self.name.to_owned()), ..Location::default() }
    }

    fn tell(&mut self, severity: Severity, code: &str, location: Location, message: String) {
        self.content.diagnostics.push(Diagnostic::new(severity, code, location, message));
    }
}

/// Whether a row is a header: cheap to say no.
fn is_header(row: &ByteRecord) -> bool {
    row.get(0).is_some_and(|first| first.trim_ascii().eq_ignore_ascii_case(b"report id"))
}

/// The bytes of one row.
struct Span<'a> {
    raw: &'a [u8],
    start: u64,
    line: u64,
    is_last: bool,
}

impl<'a> Span<'a> {
    fn of(row: &ByteRecord, whole: &'a [u8], is_last: bool) -> Self {
        let (start, line) = row.position().map_or((0, 0), |position| (position.byte(), position.line()));
        // The reader counts the line end and the blank lines before a row as part of it.
        let blank = whole.iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
        let lines = whole[..blank].iter().filter(|byte| **byte == b'\n').count() as u64;
        Self { raw: &whole[blank..], start: start + blank as u64, line: line + lines, is_last }
    }

    /// Position of the first byte behind the row.
    fn end(&self) -> u64 {
        self.start + self.raw.len() as u64
    }

    /// Whether this is the file's last row, cut inside a quoted field.
    fn ends_inside_quotes(&self) -> bool {
        self.is_last && self.raw.iter().filter(|byte| **byte == b'"').count() % 2 == 1
    }

    /// Where reading can go on inside a malformed row: an unclosed quote swallows the rows below it, and these are told
    /// by their report id and version at the start of a line.
    fn next_row_inside(&self, delimiter: u8) -> Option<csv::Position> {
        let mut line = self.line;
        for (offset, _) in self.raw.iter().enumerate().filter(|(_, byte)| **byte == b'\n') {
            line += 1;
            let rest = &self.raw[offset + 1..];
            if looks_like_row_start(rest, delimiter) {
                let mut position = csv::Position::new();
                position.set_byte(self.start + offset as u64 + 1).set_line(line);
                return Some(position);
            }
        }
        None
    }
}

/// `30270-7733,2,` or `"30270-7733","2",`, or a header.
fn looks_like_row_start(text: &[u8], delimiter: u8) -> bool {
    let mut fields = text.splitn(3, |byte| *byte == delimiter).map(|field| {
        let field = field.trim_ascii();
        field.strip_prefix(b"\"").and_then(|field| field.strip_suffix(b"\"")).unwrap_or(field)
    });
    let (Some(id), Some(version), Some(_)) = (fields.next(), fields.next(), fields.next()) else { return false };
    let digits = |text: &[u8]| !text.is_empty() && text.len() <= 8 && text.iter().all(u8::is_ascii_digit);
    let is_id =
        id.iter().position(|byte| *byte == b'-').is_some_and(|dash| digits(&id[..dash]) && digits(&id[dash + 1..]));
    (is_id && digits(version)) || id.eq_ignore_ascii_case(b"report id")
}
