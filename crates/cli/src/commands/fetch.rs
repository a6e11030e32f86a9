//! `recrash fetch`: downloads NHTSA's crash file.

use crate::output::{self, Output};
use crate::screen::{eprintln, println};
use clap::Args;
use recrash_pipeline::{CrashKind, FetchLimits, FetchRequest, Fetched, PipelineError, PublishedEdition};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  recrash fetch --edition archive                        June 2021 to June 2025
  recrash fetch --kind adas --cache files                reports since June 2025 on driver assistance, into files/";

/// Options of `fetch`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct FetchArgs {
    /// Reports since June 2025 (current), or from June 2021 to June 2025 (archive).
    #[arg(long, value_name = "NAME", value_parser = ["current", "archive"], default_value = "current")]
    pub edition: String,
    /// Automated driving (ads), driver assistance of level 2 (adas), or other.
    #[arg(long, value_name = "NAME", value_parser = ["ads", "adas", "other"], default_value = "ads")]
    pub kind: String,
    /// Folder to download from. [default: NHTSA's]
    #[arg(long, value_name = "URL")]
    pub base_url: Option<String>,
    /// Folder to keep the file in. [default: recrash in the platform's folder for caches]
    #[arg(long, value_name = "DIR", env = "RECRASH_CACHE")]
    pub cache: Option<PathBuf>,
}

impl FetchArgs {
    fn published(&self) -> PublishedEdition {
        if self.edition == "archive" { PublishedEdition::Archive } else { PublishedEdition::Current }
    }

    fn crash_kind(&self) -> CrashKind {
        match self.kind.as_str() {
            "adas" => CrashKind::Adas,
            "other" => CrashKind::Other,
            _ => CrashKind::Ads,
        }
    }
}

/// Downloads a crash file, whole or not at all.
///
/// # Errors
/// It cannot be downloaded, is no crash file, or cannot be kept.
pub fn run(args: &FetchArgs, output: Output) -> Result<(), PipelineError> {
    let request = FetchRequest {
        edition: args.published(),
        kind: args.crash_kind(),
        base_url: args.base_url.clone(),
        cache: args.cache.clone(),
    };
    if output.tables() {
        eprintln!("downloading {}", request.url());
    }
    let fetched = recrash_pipeline::fetch(&request, &FetchLimits::default())?;
    if output.json {
        output::json(&fetched);
    } else if !output.quiet {
        show(&fetched);
    }
    Ok(())
}

/// Prints what was downloaded.
fn show(fetched: &Fetched) {
    let state = if fetched.unchanged { "unchanged" } else { "saved" };
    println!("{state} {}", fetched.path.display());
    println!("{} bytes, SHA-256 {}", fetched.bytes, fetched.sha256);
    let edition = fetched.edition.label();
    let modified = fetched.last_modified.as_ref().map(|when| format!(", last modified {when}")).unwrap_or_default();
    println!("{} rows, {edition} edition{modified}", fetched.rows);
    println!("use it with: recrash run --records {}", fetched.name);
}
