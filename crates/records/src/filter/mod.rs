//! Filters: `road = intersection and severity >= minor and entity contains "Waymo"`.
//!
//! Grammar (letter case does not matter, except in quoted texts' spelling):
//!
//! ```text
//! expression := and-part { "or" and-part }
//! and-part   := factor { "and" factor }
//! factor     := "not" factor | "(" expression ")" | comparison | flag
//! comparison := field ( "=" | "!=" | "<" | "<=" | ">" | ">=" | "contains" ) value
//!             | field "in" "(" value { "," value } ")"
//! value      := word | number | "text"
//! ```
//!
//! A filter is either true or false of a record. What is not known equals `unknown` and nothing else, and is neither
//! smaller nor greater than anything; `a != b` is `not a = b`. A field that can hold several codes (weather, contact
//! zones) equals each of them.

mod parse;
mod word;

use crate::fields::{Field, FieldValue, UNKNOWN};
use recrash_model::record::CrashRecord;
use std::cmp::Ordering;

/// The grammar and the fields, for the command's help.
pub const FILTER_HELP: &str = "\
Keep the records of which this is true, such as

  road = intersection and severity >= minor and entity contains \"Waymo\" and year >= 2024

Comparisons: = != < <= > >= contains, in (a, b); put together with and, or, not, brackets.
Letter case does not matter; texts with blanks stand in quotes. A value that is not known
equals unknown and nothing else.

Texts:    report incident entity vehicle place narrative file
Numbers:  year month time_of_day_min posted_speed_mps sv_speed_mps
Codes:    road sv_movement (sv) cp_movement (cp) partner severity engagement surface lighting
          weather sv_zones cp_zones redaction edition (a wrong value lists the right ones;
          severity has an order)
Yes/no:   work_zone";

/// A filter over records.
#[derive(Debug, Clone, PartialEq)]
pub struct Filter {
    text: String,
    expression: Expression,
}

/// Why a filter cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {message}\n  {text}\n  {:>column$}", "^")]
pub struct FilterError {
    /// The filter as typed.
    pub text: String,
    /// Where, in characters, counted from 1.
    pub column: usize,
    /// What is wrong, and what is allowed.
    pub message: String,
}

#[derive(Debug, Clone, PartialEq)]
enum Expression {
    All(Vec<Expression>),
    Any(Vec<Expression>),
    Not(Box<Expression>),
    Test(Field, Test),
}

/// What is asked of a field.
#[derive(Debug, Clone, PartialEq)]
enum Test {
    /// A text equals this one, letter case aside.
    TextIs(String),
    /// A text contains this one, letter case aside; lower case here.
    TextContains(String),
    /// A number compares like this.
    Number(Comparison, f64),
    /// The value is not known: an empty text, no number, no known code.
    Unknown,
    /// One of the codes is this one.
    Code(String),
    /// The code's place in this order compares like this with the place given.
    Rank { order: Vec<String>, comparison: Comparison, place: usize },
    /// A flag is set like this.
    Flag(bool),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Comparison {
    Equal,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

impl Comparison {
    fn holds(self, ordering: Ordering) -> bool {
        match self {
            Self::Equal => ordering.is_eq(),
            Self::Less => ordering.is_lt(),
            Self::LessOrEqual => ordering.is_le(),
            Self::Greater => ordering.is_gt(),
            Self::GreaterOrEqual => ordering.is_ge(),
        }
    }
}

impl Filter {
    /// Reads a filter.
    ///
    /// # Errors
    /// What is wrong at which column.
    pub fn parse(text: &str) -> Result<Self, FilterError> {
        Ok(Self { text: text.to_owned(), expression: parse::expression(text)? })
    }

    /// The filter as typed.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the filter is true of a record.
    pub fn keeps(&self, record: &CrashRecord) -> bool {
        self.expression.holds(record)
    }
}

impl Expression {
    fn holds(&self, record: &CrashRecord) -> bool {
        match self {
            Self::All(parts) => parts.iter().all(|part| part.holds(record)),
            Self::Any(parts) => parts.iter().any(|part| part.holds(record)),
            Self::Not(part) => !part.holds(record),
            Self::Test(field, test) => test.holds(&field.of(record)),
        }
    }
}

impl Test {
    fn holds(&self, value: &FieldValue<'_>) -> bool {
        match (self, value) {
            (Self::TextIs(wanted), FieldValue::Text(text)) => text.to_lowercase() == *wanted,
            (Self::TextContains(wanted), FieldValue::Text(text)) => text.to_lowercase().contains(wanted),
            (Self::Number(comparison, wanted), FieldValue::Whole(Some(number))) => {
                // Years, months and minutes are exact in floating point.
                (*number as f64).partial_cmp(wanted).is_some_and(|ordering| comparison.holds(ordering))
            }
            (Self::Number(comparison, wanted), FieldValue::Number(Some(number))) => {
                number.partial_cmp(wanted).is_some_and(|ordering| comparison.holds(ordering))
            }
            (Self::Unknown, value) => is_unknown(value),
            (Self::Code(wanted), FieldValue::Codes(codes)) => codes.contains(wanted),
            (Self::Rank { order, comparison, place }, FieldValue::Codes(codes)) => codes.iter().any(|code| {
                order.iter().position(|name| name == code).is_some_and(|rank| comparison.holds(rank.cmp(place)))
            }),
            (Self::Flag(wanted), FieldValue::Flag(flag)) => flag == wanted,
            _ => false,
        }
    }
}

fn is_unknown(value: &FieldValue<'_>) -> bool {
    match value {
        FieldValue::Text(text) => text.is_empty(),
        FieldValue::Whole(number) => number.is_none(),
        FieldValue::Number(number) => number.is_none(),
        FieldValue::Codes(codes) => codes.is_empty() || codes.iter().all(|code| code == UNKNOWN),
        FieldValue::Flag(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_help_names_every_field() {
        for field in Field::ALL {
            assert!(FILTER_HELP.split_whitespace().any(|word| word == field.name()), "{}", field.name());
        }
    }
}
