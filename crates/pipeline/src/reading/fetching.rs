//! Published crash files, downloaded into a cache.

use crate::error::PipelineError;
use crate::files::caches::{cache_folder, no_cache_folder, variable};
use crate::files::output::Outputs;
use crate::files::paths;
use crate::files::store::{io, sha256};
use crate::profiles::load_profile;
use recrash_fetch::{FetchError, Limits, download};
use recrash_model::Outcome;
use recrash_model::profile::Dedupe;
use recrash_model::record::{Edition, RejectReason};
use recrash_records::{SourceText, ingest};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Folder of NHTSA's files under Standing General Order 2021-01.
const BASE_URL: &str = "https://static.nhtsa.gov/odi/ffdd/sgo-2021-01";

/// Which of the published files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PublishedEdition {
    /// Reports since June 2025.
    #[default]
    Current,
    /// Reports from June 2021 to June 2025.
    Archive,
}

/// Which system the reports are about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CrashKind {
    /// Automated driving (SAE level 3 to 5).
    #[default]
    Ads,
    /// Driver assistance (SAE level 2).
    Adas,
    /// Neither is certain.
    Other,
}

/// What to download, and where to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FetchRequest {
    /// Which file.
    pub edition: PublishedEdition,
    /// Which system.
    pub kind: CrashKind,
    /// Folder to download from; NHTSA's where not given.
    pub base_url: Option<String>,
    /// Folder to keep files in; where not given, `RECRASH_CACHE`, or `recrash` in the platform's folder for caches.
    pub cache: Option<PathBuf>,
}

/// A file that was downloaded and looked at.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fetched {
    /// Where it came from.
    pub url: String,
    /// What `--records` takes: the bare name where it lies in the cache that is looked in, the path elsewhere.
    pub name: String,
    /// Where it lies.
    #[serde(serialize_with = "paths::as_text")]
    pub path: PathBuf,
    /// Size. [byte]
    pub bytes: usize,
    /// SHA-256 of the content, in hexadecimal.
    pub sha256: String,
    /// Data rows.
    pub rows: usize,
    /// Edition recognised.
    pub edition: Edition,
    /// When the server says it was changed, as it says it.
    pub last_modified: Option<String>,
    /// Whether the same content lay there before.
    pub unchanged: bool,
}

impl FetchRequest {
    /// Where the file is downloaded from.
    pub fn url(&self) -> String {
        let base = self.base_url.as_deref().unwrap_or(BASE_URL).trim_end_matches('/');
        let folder = match self.edition {
            PublishedEdition::Current => "",
            PublishedEdition::Archive => "/Archive-2021-2025",
        };
        let kind = match self.kind {
            CrashKind::Ads => "ADS",
            CrashKind::Adas => "ADAS",
            CrashKind::Other => "OTHER",
        };
        format!("{base}{folder}/SGO-2021-01_Incident_Reports_{kind}.csv")
    }

    /// What the file is called in the cache.
    pub fn file_name(&self) -> String {
        let kind = match self.kind {
            CrashKind::Ads => "ads",
            CrashKind::Adas => "adas",
            CrashKind::Other => "other",
        };
        let edition = match self.edition {
            PublishedEdition::Current => "current",
            PublishedEdition::Archive => "archive",
        };
        format!("sgo-{kind}-{edition}.csv")
    }
}

/// Downloads a file into the cache, whole or not at all: what is no crash file is not kept.
///
/// # Errors
/// It cannot be reached or is not what was expected, or cannot be written; what lay there before still does.
pub fn fetch(request: &FetchRequest, limits: &Limits) -> Result<Fetched, PipelineError> {
    let folder = request.cache.clone().or_else(|| cache_folder(&variable)).ok_or_else(no_cache_folder)?;
    let url = request.url();
    let name = request.file_name();
    let got = download(&url, limits).map_err(PipelineError::Fetch)?;
    let (edition, rows) = look_at(&name, &got.bytes, &url, got.length_checked)?;
    let path = folder.join(&name);
    let sha256 = sha256(&got.bytes);
    let unchanged = std::fs::read(&path).is_ok_and(|before| before == got.bytes);
    std::fs::create_dir_all(&folder).map_err(|source| io("create", &folder, source))?;
    Outputs::default().claim(&path)?.write(&got.bytes)?;
    let found = cached(Path::new(&name)).is_some_and(|found| found == path);
    let name = if found { name } else { path.to_string_lossy().into_owned() };
    let bytes = got.bytes.len();
    Ok(Fetched { url, name, path, bytes, sha256, rows, edition, last_modified: got.last_modified, unchanged })
}

/// Edition and rows of what came. A last row that is malformed tells a cut where the server did not say the length.
fn look_at(name: &str, bytes: &[u8], url: &str, length_checked: bool) -> Result<(Edition, usize), PipelineError> {
    let mut profile = load_profile("paper")?;
    profile.records.dedupe = Dedupe::None;
    let not_data = |what: String| PipelineError::Fetch(FetchError::NotData { url: url.to_owned(), what });
    let Outcome { value: set, .. } =
        ingest(&[SourceText { name, bytes }], &profile).map_err(|e| not_data(format!("something else ({e})")))?;
    let rows: usize = set.files.iter().map(|part| part.rows).sum();
    let last_is_bad = set.rejects.last().is_some_and(|r| r.row == rows as u64 && r.reason == RejectReason::Malformed);
    if last_is_bad && !length_checked {
        let why = format!("its last row, {rows}, is not whole");
        return Err(PipelineError::Fetch(FetchError::Cut { url: url.to_owned(), why }));
    }
    let edition = set.files.first().map(|part| part.edition);
    Ok((edition.ok_or_else(|| not_data("no rows".into()))?, rows))
}

/// A downloaded file by its bare name, with or without `.csv`.
pub fn cached(name: &Path) -> Option<PathBuf> {
    if name.components().count() != 1 {
        return None;
    }
    let folder = cache_folder(&variable)?;
    [folder.join(name), folder.join(name).with_extension("csv")].into_iter().find(|path| path.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_those_that_nhtsa_publishes() {
        let current = FetchRequest::default();
        assert_eq!(current.url(), format!("{BASE_URL}/SGO-2021-01_Incident_Reports_ADS.csv"));
        let archive = FetchRequest {
            edition: PublishedEdition::Archive,
            kind: CrashKind::Adas,
            base_url: Some("http://127.0.0.1:1/x/".into()),
            cache: None,
        };
        assert_eq!(archive.url(), "http://127.0.0.1:1/x/Archive-2021-2025/SGO-2021-01_Incident_Reports_ADAS.csv");
        assert_eq!(archive.file_name(), "sgo-adas-archive.csv");
    }

    #[test]
    fn a_download_without_a_length_that_ends_inside_a_row_is_cut() {
        let sample = recrash_records::SAMPLE_CSV.as_bytes();
        let cut = &sample[..sample.len() - 200];
        assert!(look_at("x.csv", sample, "u", false).is_ok());
        let error = look_at("x.csv", cut, "u", false).unwrap_err();
        assert!(matches!(error, PipelineError::Fetch(FetchError::Cut { .. })), "{error}");
        assert!(look_at("x.csv", cut, "u", true).is_ok(), "NHTSA's own untidiness is kept");
        assert!(look_at("x.csv", b"a,b\n1,2\n", "u", true).is_err());
    }
}
