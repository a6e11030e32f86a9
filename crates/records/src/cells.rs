//! Cells that hold numbers, dates, times and ticks. Each reader tells an empty cell from one it cannot read.

use recrash_model::record::{MPS_PER_MPH, OfVehicles, YearMonth};

/// Above this a speed is a slip of the pen: no road vehicle of these reports goes faster. [mi/h, assumed]
const GREATEST_SPEED_MPH: f64 = 150.0;

/// What a cell holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cell<T> {
    /// Nothing.
    Empty,
    /// This value.
    Value(T),
    /// Something else.
    Unreadable,
}

impl<T> Cell<T> {
    fn from_option(value: Option<T>) -> Self {
        value.map_or(Self::Unreadable, Self::Value)
    }
}

/// Whether NHTSA put its redaction mark in place of a value.
fn is_withheld(text: &str) -> bool {
    text.starts_with('[') && text.contains("MAY CONTAIN")
}

/// A speed in miles per hour (`25`, `25.5`, `25 mph`), as metres per second.
pub fn speed_mps(cell: &str) -> Cell<f64> {
    let text = cell.trim();
    if text.is_empty() || is_withheld(text) || text.eq_ignore_ascii_case("n/a") || text.eq_ignore_ascii_case("unknown")
    {
        return Cell::Empty;
    }
    let number = match text.get(text.len().saturating_sub(3)..) {
        Some(unit) if unit.eq_ignore_ascii_case("mph") => text[..text.len() - 3].trim_end(),
        _ => text,
    };
    // `parse` would also take "inf", "nan" and "1e3".
    if !number.bytes().all(|b| b.is_ascii_digit() || b == b'.') {
        return Cell::Unreadable;
    }
    let speed = number.parse::<f64>().ok().filter(|mph| (0.0..=GREATEST_SPEED_MPH).contains(mph));
    Cell::from_option(speed.map(|mph| mph * MPS_PER_MPH))
}

/// A local time, as minutes after midnight: `7:05`, `07:05`, `24:00` (midnight), `12:30 PM`, `0705`. [min]
pub fn time_of_day_min(cell: &str) -> Cell<u16> {
    let text = cell.trim();
    if text.is_empty() || is_withheld(text) || text.eq_ignore_ascii_case("unknown") {
        return Cell::Empty;
    }
    Cell::from_option(parse_time(text))
}

fn parse_time(text: &str) -> Option<u16> {
    let lower = text.to_ascii_lowercase().replace('.', "");
    let (digits, half) = if let Some(digits) = lower.strip_suffix("am") {
        (digits, Some(0))
    } else if let Some(digits) = lower.strip_suffix("pm") {
        (digits, Some(12))
    } else {
        (lower.as_str(), None)
    };
    let digits = digits.trim();
    let (hour, minute) = match digits.split_once(':') {
        Some((hour, rest)) => (hour, rest.split(':').next()?),
        None if digits.len() == 3 || digits.len() == 4 => digits.split_at_checked(digits.len() - 2)?,
        None => return None,
    };
    let hour = whole_number(hour)?;
    let minute = whole_number(minute).filter(|minute| *minute < 60)?;
    let hour = match half {
        Some(half) if (1..=12).contains(&hour) => hour % 12 + half,
        Some(_) => return None,
        // "24:00" is the midnight that ends the day.
        None if hour == 24 && minute == 0 => 0,
        None if hour < 24 => hour,
        None => return None,
    };
    Some(hour * 60 + minute)
}

/// A month: `JUN-2025`, `Jun-25`, `2025-06`, `06/2025`, `6/15/2025`.
pub fn year_month(cell: &str) -> Cell<YearMonth> {
    let text = cell.trim();
    if text.is_empty() || is_withheld(text) || text.eq_ignore_ascii_case("unknown") {
        return Cell::Empty;
    }
    Cell::from_option(parse_month(text))
}

fn parse_month(text: &str) -> Option<YearMonth> {
    const NAMES: [&str; 12] = ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"];
    let parts: Vec<&str> = text.split(['-', '/', ' ']).filter(|part| !part.is_empty()).collect();
    let (month, year) = match parts[..] {
        [first, second] if first.len() == 4 && first.bytes().all(|b| b.is_ascii_digit()) => (second, first),
        [month, year] => (month, year),
        [month, _day, year] if text.contains('/') => (month, year),
        _ => return None,
    };
    let named = |text: &str| NAMES.iter().position(|name| text.to_ascii_lowercase().starts_with(name)).map(|i| i + 1);
    let month = named(month).and_then(|month| u16::try_from(month).ok()).or_else(|| whole_number(month))?;
    // Two digits leave the century out; "0000" leaves nothing out, and is no year.
    let in_century = year.trim().len() == 2;
    let year = whole_number(year).map(|year| if in_century { 2000 + year } else { year })?;
    let month = u8::try_from(month).ok().filter(|month| (1..=12).contains(month))?;
    (2000..2100).contains(&year).then_some(YearMonth { year, month })
}

/// What is said of the vehicles of both sides: `Yes Subject Vehicle, No Crash Partner`, in either order; `Unknown` leaves a
/// side open, `Not Applicable` both.
pub fn of_vehicles(cell: &str) -> Cell<OfVehicles> {
    let text = cell.trim().to_ascii_lowercase();
    if text.is_empty() || is_withheld(&text.to_ascii_uppercase()) || text == "not applicable" || text == "unknown" {
        return Cell::Empty;
    }
    let mut told = OfVehicles::default();
    for part in text.split(',') {
        let Some((word, side)) = part.trim().split_once(' ') else { return Cell::Unreadable };
        let known = match word {
            "yes" => Some(true),
            "no" => Some(false),
            "unknown" => None,
            _ => return Cell::Unreadable,
        };
        match side.trim() {
            "subject vehicle" => told.sv = known,
            "crash partner" => told.cp = known,
            _ => return Cell::Unreadable,
        }
    }
    Cell::Value(told)
}

/// A tick: `Y` or `Yes`, in any letter case; blank is none.
pub fn ticked(cell: &[u8]) -> Cell<()> {
    let cell = cell.trim_ascii();
    if cell.is_empty() || cell.eq_ignore_ascii_case(b"n") || cell.eq_ignore_ascii_case(b"no") {
        Cell::Empty
    } else if cell.eq_ignore_ascii_case(b"y") || cell.eq_ignore_ascii_case(b"yes") {
        Cell::Value(())
    } else {
        Cell::Unreadable
    }
}

fn whole_number(text: &str) -> Option<u16> {
    let text = text.trim();
    (!text.is_empty() && text.bytes().all(|b| b.is_ascii_digit())).then(|| text.parse().ok())?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sides_stand_in_one_cell_in_either_order() {
        let told = |sv, cp| Cell::Value(OfVehicles { sv, cp });
        assert_eq!(of_vehicles("Yes Subject Vehicle, No Crash Partner"), told(Some(true), Some(false)));
        assert_eq!(of_vehicles(" No Crash Partner, Unknown Subject Vehicle"), told(None, Some(false)));
        assert_eq!(of_vehicles("Not Applicable"), Cell::Empty);
        assert_eq!(of_vehicles("[REDACTED, MAY CONTAIN CONFIDENTIAL BUSINESS INFORMATION]"), Cell::Empty);
        assert_eq!(of_vehicles("Yes"), Cell::Unreadable);
        assert_eq!(of_vehicles("Perhaps Crash Partner"), Cell::Unreadable);
    }

    #[test]
    fn ten_miles_per_hour_are_4_4704_metres_per_second() {
        assert_eq!(speed_mps(" 10 "), Cell::Value(4.4704));
        assert_eq!(speed_mps("10 MPH"), Cell::Value(4.4704));
        assert_eq!(speed_mps("0"), Cell::Value(0.0));
    }

    #[test]
    fn odd_speeds_are_empty_or_unreadable_never_guessed() {
        for empty in ["", " ", "N/A", "[REDACTED, MAY CONTAIN CONFIDENTIAL BUSINESS INFORMATION]"] {
            assert_eq!(speed_mps(empty), Cell::Empty, "{empty}");
        }
        for odd in ["nan", "inf", "1e3", "-5", "5-10", "999", "mph", ".", "\u{665}", "\u{e9}mp"] {
            assert_eq!(speed_mps(odd), Cell::Unreadable, "{odd}");
        }
    }

    #[test]
    fn noon_and_midnight_are_where_they_belong() {
        let cases = [("12:30", 750), ("12:30 PM", 750), ("12:30 am", 30), ("24:00", 0), ("7:05", 425), ("0705", 425)];
        for (text, minutes) in cases {
            assert_eq!(time_of_day_min(text), Cell::Value(minutes), "{text}");
        }
        for odd in ["24:30", "25:00", "12:60", "13:00 PM", "noon", ":", "\u{e9}1"] {
            assert_eq!(time_of_day_min(odd), Cell::Unreadable, "{odd}");
        }
    }

    #[test]
    fn months_in_every_form() {
        for text in ["JUN-2025", "Jun-25", "June 2025", "2025-06", "06/2025", "6/15/2025", " jun-2025 "] {
            assert_eq!(year_month(text), Cell::Value(YearMonth { year: 2025, month: 6 }), "{text}");
        }
        for odd in ["2025", "13/2025", "JUN-1925", "Smarch-2025", "-", "1-2-3-4", "JAN-0000", "JAN-0", "JAN-025"] {
            assert_eq!(year_month(odd), Cell::Unreadable, "{odd}");
        }
    }

    #[test]
    fn ticks() {
        assert_eq!(ticked(b" y "), Cell::Value(()));
        assert_eq!(ticked(b" "), Cell::Empty);
        assert_eq!(ticked(b"maybe"), Cell::Unreadable);
    }
}
