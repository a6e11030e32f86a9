//! How numbers stand in the page's data.

use crate::words;
use serde_json::Value;

/// Differences of whole numbers.
pub fn column(values: impl Iterator<Item = f64>, scale: f64) -> Value {
    let mut last = 0_i64;
    let difference = |value: f64| {
        if !value.is_finite() {
            return Value::Null;
        }
        let now = (value * scale).round() as i64;
        let step = now.saturating_sub(last);
        last = now;
        Value::from(step)
    };
    Value::Array(values.map(difference).collect())
}

/// A number with so many decimals at most; `null` where it is not finite.
pub fn short(value: f64, decimals: usize) -> Value {
    words::fixed(value, decimals).and_then(|text| text.parse::<f64>().ok()).map_or(Value::Null, |number| {
        if number == number.trunc() && number.abs() < 1e15 { Value::from(number as i64) } else { Value::from(number) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn columns_hold_differences_and_skip_what_is_not_finite() {
        assert_eq!(column([1.0, 1.002, f64::NAN, 0.5].into_iter(), 1000.0), json!([1000, 2, null, -502]));
    }
}
