//! Verdicts of our reference drivers against those of the Joint Research Centre's own program (`verdicts.csv`: numbers of crashes
//! and digests of all verdicts in order, made by `tests/oracles/jrc_fsm.py`; none of its code is here).

use recrash_drivers::{Concrete, Grid, ReferenceDriver, drive};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// Grid, driver, speed of the vehicle under test and of the other where the table splits by them.
type Row = [String; 4];

fn row(grid: Grid, driver: ReferenceDriver, scenario: &Concrete) -> Row {
    let (ego, other) = match scenario {
        Concrete::CutIn { ego_kmh, other_kmh, .. } => (ego_kmh.to_string(), other_kmh.to_string()),
        Concrete::CutOut { speed_kmh, .. } => (speed_kmh.to_string(), "-".to_owned()),
        Concrete::Following { .. } => ("-".to_owned(), "-".to_owned()),
    };
    [grid.name().to_owned(), driver.name().to_owned(), ego, other]
}

/// A `1` for each crash and a `0` for each scenario without, in order.
fn verdicts() -> BTreeMap<Row, String> {
    let mut found: BTreeMap<Row, String> = BTreeMap::new();
    for grid in Grid::ALL {
        for scenario in grid.scenarios() {
            for driver in grid.drivers() {
                let crashed = drive(&scenario, driver).is_some();
                found.entry(row(grid, driver, &scenario)).or_default().push(if crashed { '1' } else { '0' });
            }
        }
    }
    found
}

/// A whole grid, how many scenarios it has, and the crashes of each driver.
type Whole = (&'static str, usize, &'static [(&'static str, usize)]);

const PUBLISHED: [Whole; 4] = [
    ("cut-in-fast", 14_040, &[("careful", 3_552), ("fsm", 1_649), ("rss", 1_491), ("reg157", 2_869)]),
    ("cut-in-slow", 15_930, &[("careful", 3_728), ("fsm", 901), ("rss", 880), ("reg157", 2_252)]),
    ("cut-out", 5_850, &[("careful", 848), ("fsm", 980), ("rss", 936)]),
    ("following", 1_121, &[("careful", 0), ("fsm", 0), ("rss", 21)]),
];

#[test]
fn every_verdict_is_the_published_programs() {
    let found = verdicts();
    let mut expected = BTreeMap::new();
    for line in include_str!("verdicts.csv").lines().skip(1) {
        let [grid, driver, ego, other, scenarios, crashes, digest] = line.split(',').collect::<Vec<_>>()[..] else {
            panic!("{line}");
        };
        expected.insert([grid, driver, ego, other].map(str::to_owned), (scenarios, crashes, digest));
    }
    assert!(found.keys().eq(expected.keys()));
    let mut wrong = Vec::new();
    for (row, bits) in &found {
        let crashes = bits.matches('1').count();
        let digest: String = Sha256::digest(bits).iter().take(16).map(|byte| format!("{byte:02x}")).collect();
        if (bits.len().to_string().as_str(), crashes.to_string().as_str(), digest.as_str()) != expected[row] {
            wrong.push(format!("{row:?}: {crashes} crashes of {}, published {:?}", bits.len(), expected[row]));
        }
    }
    assert!(wrong.is_empty(), "{} of {} rows differ:\n{}", wrong.len(), found.len(), wrong.join("\n"));
    for (grid, scenarios, drivers) in PUBLISHED {
        for &(driver, crashes) in drivers {
            let bits: String = found
                .iter()
                .filter(|(row, _)| row[0] == grid && row[1] == driver)
                .map(|(_, bits)| bits.as_str())
                .collect();
            assert_eq!((bits.len(), bits.matches('1').count()), (scenarios, crashes), "{driver} in {grid}");
        }
    }
}
