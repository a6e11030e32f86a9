//! TOML in, rules out, each problem with its line and key.

use super::{Join, MAPPING_FORMAT, MAX_MAPPING_BYTES, Mapping, Piece, Rule, Source, Target, Unit};
use crate::error::MappingError;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;

/// The file as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MappingFile {
    format: Spanned<String>,
    name: String,
    #[serde(default)]
    file: Option<String>,
    #[serde(default)]
    join: BTreeMap<String, Spanned<JoinTable>>,
    fields: BTreeMap<String, Spanned<FieldTable>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct JoinTable {
    file: String,
    on: String,
    #[serde(default)]
    only: BTreeMap<String, String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct FieldTable {
    column: Option<Spanned<String>>,
    text: Option<Spanned<String>>,
    #[serde(default)]
    values: BTreeMap<String, Spanned<String>>,
    otherwise: Option<Spanned<String>>,
    unit: Option<Unit>,
}

/// Where a problem lies, and what it is.
struct Problem {
    at: Option<Range<usize>>,
    key: String,
    message: String,
}

fn problem(at: Range<usize>, key: impl Into<String>, message: impl Into<String>) -> Problem {
    Problem { at: Some(at), key: key.into(), message: message.into() }
}

/// Reads and checks a mapping file.
pub fn compile(text: &str, name: &str) -> Result<Mapping, MappingError> {
    let lines = Lines(text);
    let error = |problem: Problem| MappingError {
        file: name.to_owned(),
        line: problem.at.map(|at| lines.at(at.start)),
        key: problem.key,
        message: problem.message,
    };
    if text.len() > MAX_MAPPING_BYTES {
        let message = format!("the file has {} bytes; a mapping has at most {MAX_MAPPING_BYTES}", text.len());
        return Err(error(Problem { at: None, key: String::new(), message }));
    }
    let file: MappingFile = toml::from_str(text)
        .map_err(|e| error(Problem { at: e.span(), key: String::new(), message: e.message().to_owned() }))?;
    if file.format.get_ref() != MAPPING_FORMAT {
        let message = format!("this is \"{}\"; this version reads \"{MAPPING_FORMAT}\"", file.format.get_ref());
        return Err(error(problem(file.format.span(), "format", message)));
    }
    if file.file.is_none() && !file.join.is_empty() {
        let message = "tables are joined, so the main one needs its name: add file = \"...\" above [fields]";
        return Err(error(Problem { at: None, key: "file".into(), message: message.into() }));
    }
    let joins: Vec<Join> = file
        .join
        .iter()
        .map(|(prefix, table)| Join {
            prefix: prefix.clone(),
            file: table.get_ref().file.clone(),
            on: table.get_ref().on.clone(),
            only: table.get_ref().only.clone().into_iter().collect(),
            line: lines.at(table.span().start),
        })
        .collect();

    let mut rules = BTreeMap::new();
    for (field, table) in &file.fields {
        let key = format!("fields.{field}");
        let target = Target::named(field)
            .map_err(|e| error(problem(table.span(), &key, e.to_string().replace("variant", "field"))))?;
        let mut rule = rule(target, table, &key, &joins, &file.fields).map_err(error)?;
        rule.line = lines.at(table.span().start);
        rules.insert(target, rule);
    }
    for needed in [Target::Report, Target::Road, Target::SvMovement, Target::CpMovement, Target::Narrative] {
        if !rules.contains_key(&needed) {
            let message = "a record needs this field and no rule fills it; \
                           where the database has no such column, write text = \"...\" or otherwise = \"unknown\"";
            return Err(error(Problem { at: None, key: format!("fields.{}", needed.name()), message: message.into() }));
        }
    }
    Ok(Mapping { file: name.to_owned(), name: file.name, main: file.file, joins, rules })
}

fn rule(
    target: Target,
    table: &Spanned<FieldTable>,
    key: &str,
    joins: &[Join],
    fields: &BTreeMap<String, Spanned<FieldTable>>,
) -> Result<Rule, Problem> {
    let FieldTable { column, text, values, otherwise, unit } = table.get_ref();
    let source = match (column, text) {
        (Some(column), None) => column_source(column, key, joins)?,
        (None, Some(text)) => Source::Text(pieces(text, key, fields)?),
        _ => return Err(problem(table.span(), key, "give either column or text")),
    };
    if target.is_speed() && unit.is_none() {
        return Err(problem(table.span(), key, "a speed needs its unit: unit = \"mph\", \"km/h\" or \"m/s\""));
    }
    if !target.is_speed() && unit.is_some() {
        return Err(problem(table.span(), format!("{key}.unit"), "only speeds have a unit"));
    }
    if let Some(codes) = target.codes() {
        let named = values.iter().map(|(cell, value)| (format!("{key}.values.{cell}"), value));
        for (key, value) in named.chain(otherwise.iter().map(|value| (format!("{key}.otherwise"), value))) {
            if !codes.contains(value.get_ref()) {
                let message = format!("there is no value \"{}\"; allowed: {}", value.get_ref(), codes.join(", "));
                return Err(problem(value.span(), key, message));
            }
        }
    }
    Ok(Rule {
        source,
        values: values.iter().map(|(cell, value)| (cell.trim().to_owned(), value.get_ref().clone())).collect(),
        otherwise: otherwise.as_ref().map(|value| value.get_ref().clone()),
        unit: *unit,
        line: 0,
    })
}

/// `COLUMN` of the main table, or `PREFIX.COLUMN` of a joined one.
fn column_source(column: &Spanned<String>, key: &str, joins: &[Join]) -> Result<Source, Problem> {
    let text = column.get_ref();
    let Some((prefix, name)) = text.split_once('.').filter(|_| !joins.is_empty()) else {
        return Ok(Source::Column { join: None, column: text.clone() });
    };
    match joins.iter().position(|join| join.prefix == prefix) {
        Some(join) => Ok(Source::Column { join: Some(join), column: name.to_owned() }),
        None => {
            let known: Vec<&str> = joins.iter().map(|join| join.prefix.as_str()).collect();
            let message = format!("there is no table [join.{prefix}]; there is: {}", known.join(", "));
            Err(problem(column.span(), format!("{key}.column"), message))
        }
    }
}

/// Words, and fields in braces.
fn pieces(
    text: &Spanned<String>,
    key: &str,
    fields: &BTreeMap<String, Spanned<FieldTable>>,
) -> Result<Vec<Piece>, Problem> {
    let key = format!("{key}.text");
    let mut all = Vec::new();
    let mut rest = text.get_ref().as_str();
    while let Some((words, behind)) = rest.split_once('{') {
        all.push(Piece::Words(words.to_owned()));
        let Some((name, behind)) = behind.split_once('}') else {
            return Err(problem(text.span(), key, "a brace { is never closed"));
        };
        let target = Target::named(name);
        let column = fields.get(name).is_some_and(|table| table.get_ref().column.is_some());
        match target {
            Ok(target) if column => all.push(Piece::Field(target)),
            _ => {
                let message =
                    format!("{{{name}}} is no field that a column fills; add [fields.{name}], or mend the name");
                return Err(problem(text.span(), key, message));
            }
        }
        rest = behind;
    }
    all.push(Piece::Words(rest.to_owned()));
    Ok(all)
}

/// Line numbers of a text.
struct Lines<'a>(&'a str);

impl Lines<'_> {
    fn at(&self, byte: usize) -> usize {
        let before = self.0.as_bytes().get(..byte).unwrap_or(self.0.as_bytes());
        1 + before.iter().filter(|byte| **byte == b'\n').count()
    }
}
