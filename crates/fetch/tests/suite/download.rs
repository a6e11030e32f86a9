//! Downloads from a scripted server on this machine: what comes whole, and what is refused and why.

use recrash_fetch::{FetchError, Limits, download};
use std::io::{Read, Write};
use std::net::TcpListener;
use std::thread::JoinHandle;
use std::time::Duration;

/// Answers one request with these bytes, then closes. Gives the address, and the request once it is served.
fn serve(answer: Vec<u8>, pause: Duration) -> (String, JoinHandle<String>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("http://{}/folder/file.csv", listener.local_addr().unwrap());
    let served = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let mut request = Vec::new();
        let mut buffer = [0; 1024];
        while !request.windows(4).any(|end| end == b"\r\n\r\n") {
            match stream.read(&mut buffer) {
                Ok(0) | Err(_) => break,
                Ok(n) => request.extend_from_slice(&buffer[..n]),
            }
        }
        // The client may have hung up after the header: no error of the server's.
        let half = answer.len() / 2;
        let _ = stream.write_all(&answer[..half]).and_then(|()| stream.flush());
        std::thread::sleep(pause);
        let _ = stream.write_all(&answer[half..]);
        String::from_utf8_lossy(&request).into_owned()
    });
    (url, served)
}

fn answer(status: &str, headers: &str, body: &str) -> Vec<u8> {
    format!("HTTP/1.1 {status}\r\n{headers}Connection: close\r\n\r\n{body}").into_bytes()
}

fn limits() -> Limits {
    Limits { bytes: 1000, connect_s: 2.0, total_s: 5.0 }
}

fn get(answer: Vec<u8>) -> Result<recrash_fetch::Download, FetchError> {
    let (url, served) = serve(answer, Duration::ZERO);
    let result = download(&url, &limits());
    let request = served.join().unwrap();
    assert!(request.starts_with("GET /folder/file.csv HTTP/1.1\r\n"), "{request}");
    assert!(!request.to_lowercase().contains("gzip"), "the length of packed content says nothing: {request}");
    result
}

#[test]
fn a_whole_file_comes_whole() {
    let headers = "Content-Type: text/csv\r\nContent-Length: 6\r\nLast-Modified: Mon, 05 Jan 2026 00:00:00 GMT\r\n";
    let got = get(answer("200 OK", headers, "a,b\n1,")).unwrap();
    assert_eq!((got.bytes.as_slice(), got.length_checked), (&b"a,b\n1,"[..], true));
    assert_eq!(got.last_modified.as_deref(), Some("Mon, 05 Jan 2026 00:00:00 GMT"));
    let chunked = get(answer("200 OK", "Transfer-Encoding: chunked\r\n", "3\r\na,b\r\n0\r\n\r\n")).unwrap();
    assert_eq!((chunked.bytes.as_slice(), chunked.length_checked), (&b"a,b"[..], false));
}

#[test]
fn a_file_that_is_cut_off_is_no_file() {
    for (headers, body) in [("Content-Length: 600\r\n", "a,b\n"), ("Transfer-Encoding: chunked\r\n", "ff\r\na,b\n")] {
        let error = get(answer("200 OK", headers, body)).unwrap_err();
        assert!(matches!(error, FetchError::Cut { .. }), "{headers}: {error:?}");
        assert!(error.to_string().contains("nothing was kept"), "{error}");
    }
}

#[test]
fn refusals_of_the_server_say_what_to_do() {
    for (status, words) in [("404 Not Found", "base URL"), ("403 Forbidden", "proxy"), ("503 Busy", "try again later")]
    {
        let error = get(answer(status, "Content-Length: 0\r\n", "")).unwrap_err();
        assert!(matches!(error, FetchError::Status { .. }), "{error:?}");
        assert!(error.to_string().contains(words), "{error}");
        assert!(error.to_string().contains("/folder/file.csv"), "{error}");
    }
}

#[test]
fn a_web_page_is_no_file_whatever_it_calls_itself() {
    let page = "<!DOCTYPE html><html><body>Moved</body></html>";
    for kind in ["text/html; charset=utf-8", "text/csv", "application/octet-stream"] {
        let headers = format!("Content-Type: {kind}\r\nContent-Length: {}\r\n", page.len());
        let error = get(answer("200 OK", &headers, page)).unwrap_err();
        assert!(matches!(error, FetchError::NotData { .. }), "{kind}: {error:?}");
    }
    let nothing = get(answer("200 OK", "Content-Length: 0\r\n", "")).unwrap_err();
    assert!(matches!(nothing, FetchError::NotData { .. }), "{nothing:?}");
}

#[test]
fn a_file_without_end_is_stopped_at_the_limit() {
    let long = "x".repeat(5000);
    let promised = get(answer("200 OK", "Content-Length: 5000\r\n", &long)).unwrap_err();
    let unsaid = get(answer("200 OK", "", &long)).unwrap_err();
    for error in [promised, unsaid] {
        assert!(matches!(error, FetchError::TooLarge { limit: 1000, .. }), "{error:?}");
    }
}

#[test]
fn a_server_that_stalls_is_given_up() {
    let (url, served) = serve(answer("200 OK", "Content-Length: 400\r\n", &"x".repeat(400)), Duration::from_secs(2));
    let error = download(&url, &Limits { total_s: 0.5, ..limits() }).unwrap_err();
    assert!(matches!(error, FetchError::TooSlow { .. }), "{error:?}");
    served.join().unwrap();
}

#[test]
fn no_server_at_all_is_told_as_offline() {
    let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let error = download(&format!("http://127.0.0.1:{port}/file.csv"), &limits()).unwrap_err();
    assert!(matches!(error, FetchError::Offline { .. }), "{error:?}");
    assert!(error.to_string().contains("are you offline?") && error.to_string().contains("read that file"), "{error}");
}

#[test]
fn an_address_of_another_kind_is_refused() {
    for url in ["file:///etc/hostname", "ftp://example.org/x", "nonsense", "http://"] {
        let error = download(url, &limits()).unwrap_err();
        assert!(matches!(error, FetchError::Address { .. }), "{url}: {error:?}");
    }
}

#[test]
fn redirects_are_followed() {
    let (target, served) = serve(answer("200 OK", "Content-Length: 3\r\n", "a,b"), Duration::ZERO);
    let got = get(answer("302 Found", &format!("Location: {target}\r\nContent-Length: 0\r\n"), "")).unwrap();
    assert_eq!(got.bytes, b"a,b");
    served.join().unwrap();
}
