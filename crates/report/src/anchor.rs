//! Names of places on the page. Scenario ids are untrusted text, so they are cut down to letters that need no escaping.

use crate::view::SuiteView;

/// One anchor per case, all different.
pub struct Anchors(Vec<String>);

impl Anchors {
    /// Of a suite.
    pub fn of(suite: &SuiteView) -> Self {
        let mut anchors: Vec<String> = Vec::with_capacity(suite.cases.len());
        for case in &suite.cases {
            let plain = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-') { c } else { '_' };
            let mut anchor: String = "case-".chars().chain(case.scenario_id.chars().take(80).map(plain)).collect();
            while anchors.contains(&anchor) {
                anchor.push('_');
            }
            anchors.push(anchor);
        }
        Self(anchors)
    }

    /// Of the case at this position of the suite.
    pub fn case(&self, position: usize) -> &str {
        &self.0[position]
    }

    /// All of them, in the suite's order.
    pub fn cases(&self) -> &[String] {
        &self.0
    }
}
