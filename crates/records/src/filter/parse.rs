//! Words in, expression out: a parser by recursive descent, one function a rule of the grammar.

use super::word::{Placed, Token, words};
use super::{Comparison, Expression, FilterError, Test};
use crate::fields::{Field, UNKNOWN};

/// Longest filter. [characters]
const MOST_CHARACTERS: usize = 4000;

/// Deepest nesting of brackets and `not`s.
const DEEPEST: usize = 64;

const COMPARISONS: &str = "=, !=, <, <=, >, >=, contains or in";

/// Reads a whole filter.
pub fn expression(text: &str) -> Result<Expression, FilterError> {
    if text.chars().count() > MOST_CHARACTERS {
        let message = format!("the filter is longer than {MOST_CHARACTERS} characters");
        return Err(FilterError { text: text.chars().take(60).collect(), column: 1, message });
    }
    let mut parser = Parser { text, words: words(text)?, next: 0, depth: 0 };
    let expression = parser.any()?;
    match parser.words.get(parser.next) {
        None => Ok(expression),
        Some(_) => parser.fail("expected \"and\", \"or\" or the end of the filter"),
    }
}

struct Parser<'a> {
    text: &'a str,
    words: Vec<Placed>,
    next: usize,
    depth: usize,
}

impl Parser<'_> {
    fn any(&mut self) -> Result<Expression, FilterError> {
        let mut parts = vec![self.all()?];
        while self.take_keyword("or") {
            parts.push(self.all()?);
        }
        Ok(if parts.len() == 1 { parts.remove(0) } else { Expression::Any(parts) })
    }

    fn all(&mut self) -> Result<Expression, FilterError> {
        let mut parts = vec![self.factor()?];
        while self.take_keyword("and") {
            parts.push(self.factor()?);
        }
        Ok(if parts.len() == 1 { parts.remove(0) } else { Expression::All(parts) })
    }

    fn factor(&mut self) -> Result<Expression, FilterError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return self.fail(format!("nested deeper than {DEEPEST} levels"));
        }
        let expression = if self.take_keyword("not") {
            Expression::Not(Box::new(self.factor()?))
        } else if self.take_sign("(") {
            let inner = self.any()?;
            if !self.take_sign(")") {
                return self.fail("expected \")\"");
            }
            inner
        } else {
            self.comparison()?
        };
        self.depth -= 1;
        Ok(expression)
    }

    fn comparison(&mut self) -> Result<Expression, FilterError> {
        let field = self.field()?;
        if self.take_keyword("contains") {
            let test = self.contains(field)?;
            return Ok(Expression::Test(field, test));
        }
        if self.take_keyword("in") {
            return self.one_of(field);
        }
        for (sign, comparison) in [
            ("=", Comparison::Equal),
            ("<", Comparison::Less),
            ("<=", Comparison::LessOrEqual),
            (">", Comparison::Greater),
            (">=", Comparison::GreaterOrEqual),
        ] {
            if self.take_sign(sign) {
                let test = self.value(field, comparison)?;
                return Ok(Expression::Test(field, test));
            }
        }
        if self.take_sign("!=") {
            let test = self.value(field, Comparison::Equal)?;
            return Ok(Expression::Not(Box::new(Expression::Test(field, test))));
        }
        if field == Field::WorkZone {
            return Ok(Expression::Test(field, Test::Flag(true)));
        }
        self.fail(format!("expected {COMPARISONS} after {}", field.name()))
    }

    fn field(&mut self) -> Result<Field, FilterError> {
        let Some(Placed { token: Token::Word(name), .. }) = self.words.get(self.next).cloned() else {
            return self.fail("expected the name of a field, \"not\" or \"(\"");
        };
        let lower = name.to_lowercase();
        // Short forms of what is typed most.
        let full = match lower.as_str() {
            "sv" => "sv_movement",
            "cp" => "cp_movement",
            other => other,
        };
        match Field::named(full) {
            Some(field) => {
                self.next += 1;
                Ok(field)
            }
            None => {
                let names: Vec<&str> = Field::ALL.into_iter().map(Field::name).collect();
                self.fail(format!("there is no field \"{name}\"{}", suggestion(&lower, &names)))
            }
        }
    }

    fn contains(&mut self, field: Field) -> Result<Test, FilterError> {
        if !is_text(field) {
            self.next -= 1;
            return self.fail(format!("{} is no text; compare it with = or in", field.name()));
        }
        let (text, _) = self.operand()?;
        Ok(Test::TextContains(text.to_lowercase()))
    }

    fn one_of(&mut self, field: Field) -> Result<Expression, FilterError> {
        if !self.take_sign("(") {
            return self.fail("expected \"(\" and a list of values after \"in\"");
        }
        let mut tests = Vec::new();
        loop {
            tests.push(Expression::Test(field, self.value(field, Comparison::Equal)?));
            if self.take_sign(")") {
                return Ok(Expression::Any(tests));
            }
            if !self.take_sign(",") {
                return self.fail("expected \",\" or \")\"");
            }
        }
    }

    /// The value on the right of a comparison, read as the field needs it.
    fn value(&mut self, field: Field, comparison: Comparison) -> Result<Test, FilterError> {
        let equal = comparison == Comparison::Equal;
        let (text, quoted) = self.operand()?;
        let lower = text.to_lowercase();
        if lower == UNKNOWN && !quoted && equal && field != Field::WorkZone {
            return Ok(Test::Unknown);
        }
        let name = field.name();
        if let Some(codes) = field.codes() {
            let key = lower.replace([' ', '-'], "_");
            let Some(place) = codes.iter().position(|code| *code == key) else {
                let names: Vec<&str> = codes.iter().map(String::as_str).collect();
                return self.fail_before(format!("{name} has no value \"{text}\"{}", suggestion(&key, &names)));
            };
            return match (equal, field) {
                (true, _) if key == UNKNOWN => Ok(Test::Unknown),
                (true, _) => Ok(Test::Code(key)),
                (false, _) if key == UNKNOWN => {
                    self.fail_before(format!("{name} is neither smaller nor greater than unknown; use = or !="))
                }
                (false, Field::Severity) => Ok(Test::Rank { order: codes, comparison, place }),
                _ => self.fail_before(format!("{name} has no order; compare it with =, != or in")),
            };
        }
        if is_text(field) {
            return match equal {
                true => Ok(Test::TextIs(lower)),
                false => self.fail_before(format!("{name} is a text; compare it with =, !=, contains or in")),
            };
        }
        if field == Field::WorkZone {
            return match lower.as_str() {
                "true" | "yes" if equal => Ok(Test::Flag(true)),
                "false" | "no" if equal => Ok(Test::Flag(false)),
                _ => self.fail_before(format!("{name} is yes or no: write {name}, not {name}, or {name} = yes")),
            };
        }
        match lower.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Test::Number(comparison, number)),
            _ => self.fail_before(format!("{name} is a number; \"{text}\" is none")),
        }
    }

    /// A word or a quoted text, and whether it was quoted.
    fn operand(&mut self) -> Result<(String, bool), FilterError> {
        let operand = match self.words.get(self.next).map(|word| &word.token) {
            Some(Token::Word(word)) => (word.clone(), false),
            Some(Token::Quoted(text)) => (text.clone(), true),
            _ => return self.fail("expected a value: a name, a number or a text in quotes"),
        };
        self.next += 1;
        Ok(operand)
    }

    fn take_keyword(&mut self, keyword: &str) -> bool {
        let there = matches!(self.words.get(self.next), Some(Placed { token: Token::Word(word), .. }) if word.eq_ignore_ascii_case(keyword));
        self.next += usize::from(there);
        there
    }

    fn take_sign(&mut self, sign: &str) -> bool {
        let there =
            matches!(self.words.get(self.next), Some(Placed { token: Token::Sign(found), .. }) if *found == sign);
        self.next += usize::from(there);
        there
    }

    /// An error at the next word, or behind the last one.
    fn fail<T>(&self, message: impl Into<String>) -> Result<T, FilterError> {
        let end = self.text.chars().count() + 1;
        let column = self.words.get(self.next).map_or(end, |word| word.column);
        Err(FilterError { text: self.text.to_owned(), column, message: message.into() })
    }

    /// An error at the word that was just taken.
    fn fail_before<T>(&mut self, message: String) -> Result<T, FilterError> {
        self.next -= 1;
        self.fail(message)
    }
}

fn is_text(field: Field) -> bool {
    use Field::{Entity, File, Incident, Narrative, Place, Report, Vehicle};
    matches!(field, Entity | File | Incident | Narrative | Place | Report | Vehicle)
}

/// "; did you mean ...?", or everything that is allowed.
fn suggestion(typed: &str, allowed: &[&str]) -> String {
    let near = allowed.iter().map(|name| (edits(typed, name), *name)).min();
    match near {
        Some((distance, name)) if distance <= 2 => format!("; did you mean \"{name}\"?"),
        _ => format!("; allowed: {}", allowed.join(", ")),
    }
}

/// Letters to insert, remove, change or swap with their neighbour to make one word of another.
fn edits(from: &str, to: &str) -> usize {
    let (from, to): (Vec<char>, Vec<char>) = (from.chars().take(40).collect(), to.chars().take(40).collect());
    let mut table = vec![vec![0; to.len() + 1]; from.len() + 1];
    for i in 0..=from.len() {
        for j in 0..=to.len() {
            table[i][j] = if i == 0 || j == 0 {
                i + j
            } else {
                let change = usize::from(from[i - 1] != to[j - 1]);
                let swapped = i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1];
                let swap = if swapped { table[i - 2][j - 2] + 1 } else { usize::MAX };
                (table[i - 1][j] + 1).min(table[i][j - 1] + 1).min(table[i - 1][j - 1] + change).min(swap)
            };
        }
    }
    table[from.len()][to.len()]
}
