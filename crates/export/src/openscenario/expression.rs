//! Numbers that depend on parameters, as OpenSCENARIO expressions.

use crate::xml::number;

/// A sum of multiples of parameters, and a constant.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sum {
    terms: Vec<(f64, String)>,
    constant: f64,
}

impl Sum {
    pub fn constant(value: f64) -> Self {
        Self { terms: Vec::new(), constant: value }
    }

    /// `$name`, or a number that has no name and is `value`.
    pub fn of(reference: String, value: f64) -> Self {
        if reference.contains('$') {
            Self { terms: vec![(1.0, reference)], constant: 0.0 }
        } else {
            Self::constant(value)
        }
    }

    #[must_use]
    pub fn plus(mut self, other: &Self) -> Self {
        for (factor, name) in &other.terms {
            match self.terms.iter_mut().find(|(_, known)| known == name) {
                Some((known, _)) => *known += factor,
                None => self.terms.push((*factor, name.clone())),
            }
        }
        self.constant += other.constant;
        self
    }

    #[must_use]
    pub fn times(mut self, factor: f64) -> Self {
        for (own, _) in &mut self.terms {
            *own *= factor;
        }
        self.constant *= factor;
        self
    }

    /// As an attribute value: a number, or `${...}`. Five decimals. No sign follows an operator, since `- -0.1` is no
    /// expression everywhere.
    pub fn attribute(&self) -> String {
        let short = |value: f64| (value * 1e5).round() / 1e5;
        let mut text = String::new();
        for (factor, name) in &self.terms {
            let factor = short(*factor);
            let size = if factor.abs() == 1.0 { name.clone() } else { format!("{name} * {}", number(factor.abs())) };
            match (factor, text.is_empty()) {
                (0.0, _) => {}
                (1.0, true) => text = size,
                (_, true) => text = format!("{} * {name}", number(factor)),
                _ => text += &format!(" {} {size}", if factor < 0.0 { "-" } else { "+" }),
            }
        }
        let constant = short(self.constant);
        match (text.is_empty(), constant) {
            (true, _) => number(constant),
            (false, 0.0) if !text.contains(' ') => text,
            (false, 0.0) => format!("${{{text}}}"),
            (false, _) => format!("${{{text} {} {}}}", if constant < 0.0 { "-" } else { "+" }, number(constant.abs())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Sum;

    #[test]
    fn sums_are_written_without_double_signs() {
        let of = |name: &str| Sum::of(name.to_owned(), 1.5);
        assert_eq!(Sum::constant(-2.0).attribute(), "-2");
        assert_eq!(of("7").attribute(), "1.5");
        assert_eq!(of("$a").attribute(), "$a");
        assert_eq!(of("$a").times(-1.0).attribute(), "${-1 * $a}");
        assert_eq!(of("$a").plus(&of("$b").times(-0.25)).attribute(), "${$a - $b * 0.25}");
        assert_eq!(of("$a").plus(&of("$a")).plus(&Sum::constant(-3.0)).attribute(), "${2 * $a - 3}");
        assert_eq!(of("$a").times(0.0).plus(&of("$b")).attribute(), "$b");
    }
}
