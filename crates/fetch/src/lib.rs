//! Downloads one public file: bounded in size and time, whole or not at all. An address in, bytes out.
//!
//! This crate and `agents` are the only ones that speak to a network; this one sends nothing but the request for the
//! file. Certificates are checked against Mozilla's roots, which are compiled in. A proxy is taken from the
//! environment's `https_proxy`, `http_proxy`, `all_proxy` and `no_proxy`.
//!
//! What this crate does **not** do: it writes no file (the pipeline does) and does not look at what it got beyond telling
//! a web page from data.

use std::io::Read;
use std::time::Duration;

/// Bounds on a download.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Largest content. [byte]
    pub bytes: u64,
    /// Longest time until the connection stands. [s]
    pub connect_s: f64,
    /// Longest time for everything. [s]
    pub total_s: f64,
}

impl Default for Limits {
    /// 256 MiB, thirty times the largest file published; 15 s; 10 minutes, so 4 MB come even at 7 kB/s (assumed).
    fn default() -> Self {
        Self { bytes: 256 << 20, connect_s: 15.0, total_s: 600.0 }
    }
}

/// A file that was downloaded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Download {
    /// The whole content.
    pub bytes: Vec<u8>,
    /// Header `Last-Modified`, as it stood.
    pub last_modified: Option<String>,
    /// Whether the server said how long the content is, and it was.
    pub length_checked: bool,
}

/// Why nothing was downloaded. Every message names the address.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FetchError {
    /// No address of the kind that can be read.
    #[error("{url} is no address that can be downloaded from: {why}; it starts with https:// or http://")]
    Address {
        /// Address.
        url: String,
        /// What is wrong with it.
        why: String,
    },
    /// The server cannot be reached.
    #[error(
        "{url} cannot be reached: {why}; are you offline? A browser elsewhere can get the file as well: read that file then"
    )]
    Offline {
        /// Address.
        url: String,
        /// What failed.
        why: String,
    },
    /// The server did not answer in time, or too slowly.
    #[error("{url} took longer than {seconds} s ({while_doing}); nothing was kept; try again later")]
    TooSlow {
        /// Address.
        url: String,
        /// What was waited for.
        while_doing: String,
        /// Bound that was reached. [s]
        seconds: u64,
    },
    /// The server answered that it does not give the file.
    #[error("{url} answered {status}: {}", meaning(*status))]
    Status {
        /// Address.
        url: String,
        /// HTTP status.
        status: u16,
    },
    /// Something else than data came.
    #[error(
        "{url} gave {what} instead of a CSV file; nothing was kept; the file may have moved: look for its address on NHTSA's Standing General Order page and give its folder as the base URL"
    )]
    NotData {
        /// Address.
        url: String,
        /// What came.
        what: String,
    },
    /// More came than is allowed.
    #[error("{url} is larger than {limit} bytes; nothing was kept")]
    TooLarge {
        /// Address.
        url: String,
        /// Bound. [byte]
        limit: u64,
    },
    /// Less came than was promised.
    #[error("{url} broke off: {why}; nothing was kept; run the same command again")]
    Cut {
        /// Address.
        url: String,
        /// What broke.
        why: String,
    },
}

fn meaning(status: u16) -> &'static str {
    match status {
        401 | 403 => "access is refused; a proxy or a firewall may stand between",
        404 | 410 => "there is no such file; it may have moved: give the new folder as the base URL",
        429 => "too many requests; wait a while",
        500..=599 => "the server has a problem; try again later",
        _ => "the file was not given",
    }
}

/// Downloads one file.
///
/// # Errors
/// Nothing was downloaded, and why.
pub fn download(url: &str, limits: &Limits) -> Result<Download, FetchError> {
    let url_text = || url.to_owned();
    let encrypted = url.starts_with("https://");
    if !encrypted && !url.starts_with("http://") {
        return Err(FetchError::Address { url: url_text(), why: "the scheme is missing or another one".into() });
    }
    let agent = ureq::Agent::new_with_config(
        ureq::Agent::config_builder()
            // A redirect must not lead out of the encryption.
            .https_only(encrypted)
            .max_redirects(5)
            .http_status_as_error(true)
            .timeout_connect(Some(Duration::from_secs_f64(limits.connect_s)))
            .timeout_global(Some(Duration::from_secs_f64(limits.total_s)))
            .user_agent(concat!("recrash/", env!("CARGO_PKG_VERSION")))
            .build(),
    );
    let mut response = agent.get(url).call().map_err(|error| told(url, error, limits))?;
    let promised: Option<u64> = response.headers().get("content-length").and_then(|v| v.to_str().ok()?.parse().ok());
    if promised.is_some_and(|length| length > limits.bytes) {
        return Err(FetchError::TooLarge { url: url_text(), limit: limits.bytes });
    }
    let kind = response.body().mime_type().unwrap_or_default().to_ascii_lowercase();
    if ["text/html", "application/xhtml+xml", "application/json", "application/xml"].contains(&kind.as_str()) {
        return Err(FetchError::NotData { url: url_text(), what: format!("a page ({kind})") });
    }
    let last_modified = response.headers().get("last-modified").and_then(|v| v.to_str().ok()).map(str::to_owned);
    let mut bytes = Vec::new();
    let mut reader = response.body_mut().as_reader().take(limits.bytes + 1);
    reader.read_to_end(&mut bytes).map_err(|error| broken(url, error, limits))?;
    if bytes.len() as u64 > limits.bytes {
        return Err(FetchError::TooLarge { url: url_text(), limit: limits.bytes });
    }
    if let Some(promised) = promised.filter(|promised| *promised != bytes.len() as u64) {
        return Err(FetchError::Cut { url: url_text(), why: format!("{} of {promised} bytes came", bytes.len()) });
    }
    if bytes.is_empty() {
        return Err(FetchError::NotData { url: url_text(), what: "nothing at all".into() });
    }
    let opening = bytes.trim_ascii_start();
    let opening = opening[..opening.len().min(9)].to_ascii_lowercase();
    if opening.starts_with(b"<!doctype") || opening.starts_with(b"<html") || opening.starts_with(b"<?xml") {
        return Err(FetchError::NotData { url: url_text(), what: "a web page".into() });
    }
    Ok(Download { bytes, last_modified, length_checked: promised.is_some() })
}

fn told(url: &str, error: ureq::Error, limits: &Limits) -> FetchError {
    let url = url.to_owned();
    match error {
        ureq::Error::StatusCode(status) => FetchError::Status { url, status },
        ureq::Error::BadUri(why) => FetchError::Address { url, why },
        ureq::Error::Http(why) => FetchError::Address { url, why: why.to_string() },
        ureq::Error::HostNotFound => FetchError::Offline { url, why: "the host's name is not known here".into() },
        ureq::Error::Timeout(ureq::Timeout::Connect | ureq::Timeout::Resolve) => {
            FetchError::Offline { url, why: format!("no connection within {} s", limits.connect_s) }
        }
        ureq::Error::Timeout(what) => {
            FetchError::TooSlow { url, while_doing: what.to_string(), seconds: limits.total_s as u64 }
        }
        ureq::Error::Io(error) => match error.kind() {
            std::io::ErrorKind::UnexpectedEof | std::io::ErrorKind::ConnectionReset => {
                FetchError::Cut { url, why: error.to_string() }
            }
            _ => FetchError::Offline { url, why: error.to_string() },
        },
        ureq::Error::Protocol(why) => FetchError::Cut { url, why: why.to_string() },
        other => FetchError::Offline { url, why: other.to_string() },
    }
}

fn broken(url: &str, error: std::io::Error, limits: &Limits) -> FetchError {
    let timeout = error.get_ref().and_then(|inner| inner.downcast_ref::<ureq::Error>());
    match timeout {
        Some(ureq::Error::Timeout(what)) => {
            let (url, while_doing) = (url.to_owned(), what.to_string());
            FetchError::TooSlow { url, while_doing, seconds: limits.total_s as u64 }
        }
        _ => FetchError::Cut { url: url.to_owned(), why: error.to_string() },
    }
}
