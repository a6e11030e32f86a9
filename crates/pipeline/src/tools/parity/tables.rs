//! The comparison as tables, for the terminal and the page, and as CSV.

use super::{Parity, ParitySource};
use recrash_lab::parity::compare::quantile;
use recrash_lab::parity::{Agreement, Pair, PairOutcome};
use recrash_model::spreadsheet::inert;
use recrash_report::TableView;
use serde::Serialize;

/// Columns of the table of pairs.
const COLUMNS: [&str; 23] = [
    "scenario",
    "map",
    "policy",
    "kind",
    "extras",
    "native_end",
    "native_end_s",
    "native_contact_s",
    "native_min_gap_m",
    "native_min_gap_s",
    "native_failed",
    "metadrive_end",
    "metadrive_end_s",
    "metadrive_contact_s",
    "metadrive_min_gap_m",
    "metadrive_min_gap_s",
    "metadrive_failed",
    "same_verdict",
    "same_gap",
    "same_time",
    "same_arrival",
    "ego_apart_5s_m",
    "error",
];

/// A table of texts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParityTable {
    /// What it shows.
    pub caption: &'static str,
    /// Names of the columns.
    pub header: Vec<&'static str>,
    /// Rows.
    pub rows: Vec<Vec<String>>,
}

impl From<ParityTable> for TableView {
    fn from(table: ParityTable) -> Self {
        Self {
            caption: table.caption.to_owned(),
            header: table.header.into_iter().map(str::to_owned).collect(),
            rows: table.rows,
        }
    }
}

/// The name of a unit variant, as in files.
fn word<T: Serialize>(value: &T) -> String {
    serde_json::to_value(value).ok().and_then(|value| value.as_str().map(str::to_owned)).unwrap_or_default()
}

/// A share, in percent.
fn share(count: usize, of: usize) -> String {
    if of == 0 { "-".to_owned() } else { format!("{:.1}", 100.0 * count as f64 / of as f64) }
}

impl Parity {
    /// The command that makes this comparison.
    pub fn command(&self) -> String {
        match &self.source {
            ParitySource::Random { count, seed } => format!("recrash parity --n {count} --seed {seed}"),
            ParitySource::Suite { dir } => format!("recrash parity {}", dir.display()),
        }
    }

    /// Everything as tables.
    pub fn tables(&self) -> Vec<ParityTable> {
        let mut tables = vec![self.asked(), self.groups(), self.positions()];
        if matches!(self.source, ParitySource::Suite { .. }) {
            tables.push(self.verdicts());
        }
        tables.push(self.farthest());
        if !self.refused.is_empty() {
            tables.push(self.not_held());
        }
        tables
    }

    fn not_held(&self) -> ParityTable {
        ParityTable {
            caption: "What MetaDrive cannot hold",
            header: vec!["scenario", "why"],
            rows: self.refused.iter().map(|refused| vec![refused.name.clone(), refused.why.clone()]).collect(),
        }
    }

    fn asked(&self) -> ParityTable {
        let row = |threshold: &super::Threshold| {
            vec![
                threshold.what.to_owned(),
                format!("{} of {}", threshold.count, threshold.of),
                format!("{} %", share(threshold.count, threshold.of)),
                format!("{:.0} %", 100.0 * threshold.wanted),
                if threshold.passed { "reached" } else { "missed" }.to_owned(),
            ]
        };
        ParityTable {
            caption: "What is asked for",
            header: vec!["", "pairs", "share", "asked for", ""],
            rows: self.thresholds.iter().map(row).collect(),
        }
    }

    fn groups(&self) -> ParityTable {
        let mut rows = vec![group("all", &self.pairs.iter().collect::<Vec<_>>())];
        let mut by = |name: &str, of: &dyn Fn(&Pair) -> Vec<String>| {
            let mut values: Vec<String> = self.pairs.iter().flat_map(of).collect();
            values.sort();
            values.dedup();
            for value in values {
                let pairs: Vec<&Pair> = self.pairs.iter().filter(|pair| of(pair).contains(&value)).collect();
                rows.push(group(format!("{name} {value}").trim_start(), &pairs));
            }
        };
        by("map", &|pair| vec![pair.map.to_string()]);
        by("policy", &|pair| vec![pair.policy.to_owned()]);
        by("with", &|pair| pair.kind.iter().map(|kind| kind.label().to_owned()).collect());
        by("with", &|pair| pair.extras.iter().map(|extra| (*extra).to_owned()).collect());
        ParityTable {
            caption: "Agreement, by map and by the first partner's policy and kind",
            header: vec![
                "",
                "pairs",
                "verdict %",
                "least gap %",
                "its time %",
                "arrival %",
                "median gap diff. m",
                "failed",
                "confirmed %",
                "errors",
            ],
            rows,
        }
    }

    fn positions(&self) -> ParityTable {
        let row = |apart: &super::Apart| {
            let cell = |value: f64| format!("{value:.2} m");
            vec![
                format!("{:.0} s", apart.time_s),
                apart.pairs.to_string(),
                cell(apart.ego_m.0),
                cell(apart.ego_m.1),
                cell(apart.partner_m.0),
                cell(apart.partner_m.1),
            ]
        };
        ParityTable {
            caption: "How far apart the same road user is on both, while both run",
            header: vec!["after", "pairs", "ego, median", "90 %", "partner, median", "90 %"],
            rows: self.apart.iter().map(row).collect(),
        }
    }

    /// Every scenario's verdict on both.
    fn verdicts(&self) -> ParityTable {
        let verdict = |outcome: &PairOutcome| {
            let kinds: Vec<&str> =
                outcome.findings.iter().filter(|kind| kind.is_failure()).map(|kind| kind.label()).collect();
            if kinds.is_empty() { "passed".to_owned() } else { kinds.join(", ") }
        };
        let row = |pair: &Pair| {
            let told = match (pair.native.failed, &pair.metadrive) {
                (_, None) => "error",
                (true, Some(other)) if other.failed => "confirmed",
                (true, Some(_)) => "native only",
                (false, Some(other)) if other.failed => "MetaDrive only",
                (false, Some(_)) => "passed on both",
            };
            vec![
                pair.name.clone(),
                verdict(&pair.native),
                pair.metadrive.as_ref().map_or_else(|| "-".to_owned(), verdict),
                gap(&pair.native),
                pair.metadrive.as_ref().map_or_else(|| "-".to_owned(), gap),
                told.to_owned(),
            ]
        };
        ParityTable {
            caption: "Every scenario on both",
            header: vec!["scenario", "native", "MetaDrive", "least gap", "on MetaDrive", ""],
            rows: self.pairs.iter().map(row).collect(),
        }
    }

    fn farthest(&self) -> ParityTable {
        let row = |&position: &usize| {
            let pair = &self.pairs[position];
            vec![
                pair.name.clone(),
                pair.map.to_string(),
                pair.policy.to_owned(),
                told(&pair.native),
                pair.metadrive.as_ref().map_or_else(|| "-".to_owned(), told),
                pair.remark(),
            ]
        };
        ParityTable {
            caption: "Farthest apart, the worst first",
            header: vec!["scenario", "map", "policy", "native", "MetaDrive", ""],
            rows: self.worst.iter().map(row).collect(),
        }
    }

    /// One row for each pair (RFC 4180). Times in seconds, lengths in metres.
    pub fn csv(&self) -> String {
        let mut writer = csv::WriterBuilder::new().terminator(csv::Terminator::CRLF).from_writer(Vec::new());
        // Into memory, and every row has the header's width.
        let mut write = |cells: &[String]| writer.write_record(cells).expect("a row of the header's width");
        write(&COLUMNS.map(str::to_owned));
        for pair in &self.pairs {
            let mut cells = vec![
                pair.name.clone(),
                pair.map.to_string(),
                pair.policy.to_owned(),
                pair.kind.as_ref().map(word).unwrap_or_default(),
                pair.extras.join(" + "),
            ];
            cells.extend(outcome_cells(Some(&pair.native)));
            cells.extend(outcome_cells(pair.metadrive.as_ref()));
            cells.extend(
                [pair.same_verdict(), pair.same_gap(), pair.same_time(), pair.same_arrival()]
                    .map(|same| same.to_string()),
            );
            cells.push(pair.ego_apart_m.get(3).map(|metres| format!("{metres:.3}")).unwrap_or_default());
            cells.push(pair.error.clone().unwrap_or_default());
            let cells: Vec<String> = cells.iter().map(|cell| inert(cell).into_owned()).collect();
            write(&cells);
        }
        String::from_utf8(writer.into_inner().unwrap_or_default()).expect("made of texts")
    }
}

fn group(name: &str, pairs: &[&Pair]) -> Vec<String> {
    let all = Agreement::of(pairs.iter().copied());
    let mut differences: Vec<f64> = pairs.iter().filter_map(|pair| pair.gap_difference()).map(|(gap, _)| gap).collect();
    differences.sort_by(f64::total_cmp);
    vec![
        name.to_owned(),
        all.pairs.to_string(),
        share(all.same_verdict, all.pairs),
        share(all.same_gap, all.pairs),
        share(all.same_time, all.pairs),
        share(all.same_arrival, all.pairs),
        format!("{:.3}", quantile(&differences, 0.5)),
        all.failed_natively.to_string(),
        share(all.confirmed, all.failed_natively),
        all.errors.to_string(),
    ]
}

fn gap(outcome: &PairOutcome) -> String {
    outcome.min_gap.map_or_else(|| "-".to_owned(), |gap| format!("{:.2} m at {:.1} s", gap.value, gap.time_s))
}

fn told(outcome: &PairOutcome) -> String {
    format!("{} at {:.1} s, {}", outcome.end.label(), outcome.end_s, gap(outcome))
}

fn outcome_cells(outcome: Option<&PairOutcome>) -> Vec<String> {
    let Some(outcome) = outcome else { return vec![String::new(); 6] };
    let gap = |of: fn(recrash_model::metrics::Timed) -> f64| outcome.min_gap.map(of).map(|value| format!("{value:.3}"));
    vec![
        word(&outcome.end),
        format!("{:.1}", outcome.end_s),
        outcome.contact_s.map(|time| format!("{time:.2}")).unwrap_or_default(),
        gap(|timed| timed.value).unwrap_or_default(),
        gap(|timed| timed.time_s).unwrap_or_default(),
        outcome.failed.to_string(),
    ]
}
