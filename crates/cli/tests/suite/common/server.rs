//! A local server that speaks the chat-completions protocol and follows a script.

use serde_json::{Value, json};
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// One request, as the script sees it.
#[derive(Clone)]
pub struct Request {
    /// Number of the request, from 0.
    pub number: usize,
    /// How often this very question came before.
    pub asked_before: usize,
    /// Head: request line and headers.
    pub head: String,
    /// Body.
    pub body: Value,
    /// When it came.
    pub at: Instant,
}

impl Request {
    /// The conversation.
    pub fn messages(&self) -> &[Value] {
        self.body["messages"].as_array().unwrap()
    }

    /// Whether nothing went back yet.
    pub fn opens(&self) -> bool {
        self.messages().len() == 2
    }

    /// Whether it is of the role whose questions begin with this word.
    pub fn is(&self, word: &str) -> bool {
        self.messages()[1]["content"].as_str().unwrap().starts_with(word)
    }
}

/// What the server does with a request.
pub enum Reply {
    /// An answer.
    Text(String),
    /// A status, with header lines and a body.
    Status(u16, String, String),
    /// Nothing, for a while.
    Hang(Duration),
    /// Half of an answer.
    CutOff,
    /// A status 200 with these header lines, and this piece of a body so many times.
    Pieces(String, Arc<Vec<u8>>, usize),
}

impl Reply {
    /// A status that asks to come back in so many seconds.
    pub fn busy(status: u16, seconds: u32) -> Self {
        Self::Status(
            status,
            format!("Retry-After: {seconds}\r\n"),
            json!({"error": {"message": "scripted"}}).to_string(),
        )
    }
}

type Script = dyn Fn(&Request) -> Reply + Send + Sync;

/// A running server.
pub struct Server {
    /// Address for `--base-url`.
    pub base_url: String,
    seen: Arc<Mutex<Seen>>,
}

#[derive(Default)]
struct Seen {
    requests: Vec<Request>,
    under_way: usize,
    most_under_way: usize,
}

impl Server {
    /// Starts a server on a free port of this machine.
    pub fn start(script: impl Fn(&Request) -> Reply + Send + Sync + 'static) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let base_url = format!("http://{}/v1", listener.local_addr().unwrap());
        let seen = Arc::new(Mutex::new(Seen::default()));
        let (kept, script): (_, Arc<Script>) = (Arc::clone(&seen), Arc::new(script));
        std::thread::spawn(move || {
            for stream in listener.incoming() {
                let Ok(stream) = stream else { return };
                let (seen, script) = (Arc::clone(&kept), Arc::clone(&script));
                std::thread::spawn(move || serve(stream, &seen, &*script));
            }
        });
        Self { base_url, seen }
    }

    /// Every request so far.
    pub fn requests(&self) -> Vec<Request> {
        self.seen.lock().unwrap().requests.clone()
    }

    /// Most requests that were under way at once.
    pub fn most_under_way(&self) -> usize {
        self.seen.lock().unwrap().most_under_way
    }
}

fn serve(mut stream: TcpStream, seen: &Mutex<Seen>, script: &Script) {
    let Some((head, body)) = read_request(&mut stream) else { return };
    let request = {
        let mut seen = seen.lock().unwrap();
        let asked_before = seen.requests.iter().filter(|r| r.body["messages"] == body["messages"]).count();
        let request = Request { number: seen.requests.len(), asked_before, head, body, at: Instant::now() };
        seen.requests.push(request.clone());
        seen.under_way += 1;
        seen.most_under_way = seen.most_under_way.max(seen.under_way);
        request
    };
    let reply = script(&request);
    seen.lock().unwrap().under_way -= 1;
    // The client may have gone: that is its right.
    let _ = match reply {
        Reply::Text(text) => send(&mut stream, 200, "", &completion(&text)),
        Reply::Status(status, headers, body) => send(&mut stream, status, &headers, &body),
        Reply::Hang(time) => {
            std::thread::sleep(time);
            Ok(())
        }
        Reply::Pieces(headers, piece, times) => {
            let head = format!("HTTP/1.1 200 OK\r\nContent-Type: application/json\r\n{headers}\r\n");
            stream.write_all(head.as_bytes()).and_then(|()| (0..times).try_for_each(|_| stream.write_all(&piece)))
        }
        Reply::CutOff => {
            let body = completion("{\"text\": \"this never ends\"}");
            let head =
                format!("HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: {}\r\n\r\n", body.len());
            stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(&body.as_bytes()[..body.len() / 2]))
        }
    };
}

fn read_request(stream: &mut TcpStream) -> Option<(String, Value)> {
    stream.set_read_timeout(Some(Duration::from_secs(10))).ok()?;
    let (mut bytes, mut buffer) = (Vec::new(), [0; 1 << 14]);
    loop {
        let read = stream.read(&mut buffer).ok().filter(|read| *read > 0)?;
        bytes.extend_from_slice(&buffer[..read]);
        let Some(end) = bytes.windows(4).position(|window| window == b"\r\n\r\n") else { continue };
        let head = String::from_utf8_lossy(&bytes[..end]).into_owned();
        let length = head.lines().find_map(|line| {
            let (name, value) = line.split_once(':')?;
            name.eq_ignore_ascii_case("content-length").then(|| value.trim().parse::<usize>().ok())?
        });
        if bytes.len() >= end + 4 + length.unwrap_or(0) {
            return Some((head, serde_json::from_slice(&bytes[end + 4..]).ok()?));
        }
    }
}

fn send(stream: &mut TcpStream, status: u16, headers: &str, body: &str) -> std::io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 {status} Scripted\r\nContent-Type: application/json\r\n{headers}Content-Length: {}\r\nConnection: close\r\n\r\n{body}",
        body.len()
    )
}

/// The body of a good answer with this text.
pub fn completion(text: &str) -> String {
    json!({
        "id": "scripted", "object": "chat.completion", "created": 0, "model": "scripted",
        "choices": [{"index": 0, "finish_reason": "stop", "message": {"role": "assistant", "content": text}}],
        "usage": {"prompt_tokens": 100, "completion_tokens": 20, "total_tokens": 120}
    })
    .to_string()
}
