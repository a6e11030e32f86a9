//! Prints the narratives of the usable records of a crash file, each with its facts: for those who work on the rules.
//!
//! `cargo run -p recrash-agents --example narrate [FILE.csv] [TEMPLATE]`: without a file, the built-in sample's; with a
//! template such as `intersection-straight-left`, those of that template.

use recrash_agents::{Brief, Paraphrase, Rules};
use recrash_model::Seed;
use recrash_model::profile::SystemProfile;
use recrash_records::{SAMPLE_CSV, SAMPLE_NAME, SourceText, ingest};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().filter(|file| file != "sample");
    let wanted = arguments.next();
    let profile: SystemProfile = toml::from_str(include_str!("../../../profiles/paper.toml"))?;
    let bytes = match &file {
        Some(path) => std::fs::read(path)?,
        None => SAMPLE_CSV.as_bytes().to_vec(),
    };
    let source = SourceText { name: file.as_deref().unwrap_or(SAMPLE_NAME), bytes: &bytes };
    let set = ingest(&[source], &profile)?.value;
    for &position in &set.usable {
        let record = &set.records[position];
        let Some(template) = record.template() else { continue };
        if wanted.as_ref().is_some_and(|wanted| *wanted != template.slug()) {
            continue;
        }
        let brief = Brief { scenario_id: "example", template, records: &[record], profile: &profile, seed: Seed(7) };
        let narrative = Rules.paraphrase(&brief)?.value;
        println!("== {} {} sv {:?} cp {:?}", record.id, template.slug(), record.sv_zones, record.cp_zones);
        println!("{}\n-> {:?}\n{}", record.narrative.trim(), narrative.origin, narrative.text);
        for fact in &narrative.facts {
            println!("   {}", serde_json::to_string(fact)?);
        }
    }
    Ok(())
}
