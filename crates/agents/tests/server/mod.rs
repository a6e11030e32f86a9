//! A local server that speaks the chat-completions protocol, scripted reply by reply.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// What the server does with one request.
#[derive(Clone)]
pub enum Reply {
    /// A normal answer with this text.
    Text(String),
    /// A status with a header line and a body.
    Status(u16, &'static str),
    /// Nothing, for a while.
    Hang(Duration),
    /// Half of a normal answer.
    CutOff,
}

/// A running server.
pub struct Server {
    /// Address for `base_url`.
    pub base_url: String,
    requests: Arc<Mutex<Vec<String>>>,
}

impl Server {
    /// Starts a server on a free port of this machine. It gives the replies in order, and the last one for ever.
    pub fn start(replies: Vec<Reply>) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let base_url = format!("http://{}/v1", listener.local_addr().unwrap());
        let requests = Arc::new(Mutex::new(Vec::new()));
        let seen = Arc::clone(&requests);
        std::thread::spawn(move || {
            for stream in listener.incoming() {
                let Ok(stream) = stream else { return };
                let number = seen.lock().unwrap().len();
                let reply = replies.get(number).or(replies.last()).cloned().unwrap();
                let request = read_request(&stream);
                seen.lock().unwrap().push(request);
                std::thread::spawn(move || answer(stream, &reply));
            }
        });
        Self { base_url, requests }
    }

    /// Every request so far: head and body.
    pub fn requests(&self) -> Vec<String> {
        self.requests.lock().unwrap().clone()
    }
}

fn read_request(mut stream: &TcpStream) -> String {
    stream.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    let mut text = Vec::new();
    let mut buffer = [0; 4096];
    loop {
        let read = stream.read(&mut buffer).unwrap_or(0);
        text.extend_from_slice(&buffer[..read]);
        let so_far = String::from_utf8_lossy(&text).into_owned();
        if let Some((head, body)) = so_far.split_once("\r\n\r\n") {
            let length = head.lines().find_map(|line| {
                let (name, value) = line.split_once(':')?;
                name.eq_ignore_ascii_case("content-length").then(|| value.trim().parse::<usize>().ok())?
            });
            if body.len() >= length.unwrap_or(0) {
                return so_far;
            }
        }
        if read == 0 {
            return so_far;
        }
    }
}

fn answer(mut stream: TcpStream, reply: &Reply) {
    // The client may have gone: that is its right.
    let _ = match reply {
        Reply::Text(text) => send(&mut stream, "200 OK", "", &completion(text)),
        Reply::Status(status, header) => {
            send(&mut stream, &format!("{status} Scripted"), header, "{\"error\": {\"message\": \"scripted\"}}")
        }
        Reply::Hang(time) => {
            std::thread::sleep(*time);
            Ok(())
        }
        Reply::CutOff => {
            let body = completion("{\"text\": \"this never");
            let head = format!("HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: {}\r\n\r\n", body.len());
            stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(&body.as_bytes()[..body.len() / 2]))
        }
    };
}

fn send(stream: &mut TcpStream, status: &str, header: &str, body: &str) -> std::io::Result<()> {
    let length = body.len();
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: application/json\r\n{header}Content-Length: {length}\r\nConnection: close\r\n\r\n{body}"
    )
}

fn completion(text: &str) -> String {
    serde_json::json!({
        "id": "scripted", "object": "chat.completion", "created": 0, "model": "scripted",
        "choices": [{"index": 0, "finish_reason": "stop", "message": {"role": "assistant", "content": text}}],
        "usage": {"prompt_tokens": 100, "completion_tokens": 20, "total_tokens": 120}
    })
    .to_string()
}
