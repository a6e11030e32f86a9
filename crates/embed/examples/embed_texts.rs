//! Embeds the texts of a JSON array, prints how long it took on one thread, and writes texts and rows for
//! `oracle/oracle.py compare`.
//!
//!     cargo run --release -p recrash-embed --example embed_texts -- MODEL_DIR TEXTS.json ROWS.json

use recrash_embed::{Embedder, MODEL_FILES, ModelFiles};
use std::path::Path;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, texts, rows] = arguments.as_slice() else { return Err("MODEL_DIR TEXTS.json ROWS.json".into()) };
    let started = Instant::now();
    let [config, weights, vocabulary] = MODEL_FILES.map(|name| std::fs::read(Path::new(model).join(name)));
    let (config, weights, vocabulary) = (config?, weights?, vocabulary?);
    let embedder = Embedder::new(ModelFiles { config: &config, weights: &weights, vocabulary: &vocabulary })?;
    println!("loaded in {:?}, published weights: {}", started.elapsed(), embedder.is_pinned());
    let texts: Vec<String> = serde_json::from_slice(&std::fs::read(texts)?)?;
    let views: Vec<&str> = texts.iter().map(String::as_str).collect();
    let started = Instant::now();
    let embedded = embedder.embed(&views);
    println!("{} texts in {:?} on one thread", views.len(), started.elapsed());
    std::fs::write(rows, serde_json::json!({ "texts": views, "rows": embedded }).to_string())?;
    Ok(())
}
