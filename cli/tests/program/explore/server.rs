//! The server: who is answered, what is refused, and how it ends.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::of;

struct Served {
    program: Child,
    port: u16,
}

impl Served {
    fn new(arguments: &str) -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_hertzian"));
        let program = program.arg("explore").args(arguments.split_whitespace());
        let mut program = program.stdout(Stdio::piped()).spawn().expect("the program");
        let mut line = String::new();
        let out = program.stdout.take().expect("its output");
        BufReader::new(out).read_line(&mut line).expect("a line");
        let port = line.trim().trim_end_matches('/').rsplit(':').next();
        let port = port.and_then(|port| port.parse().ok()).expect(&line);
        Self { program, port }
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).expect("a connection");
        let patience = Some(Duration::from_secs(30));
        stream.set_read_timeout(patience).expect("a timeout");
        stream
    }

    /// The answer to a request, which closes its connection: status, and what is behind the headers.
    fn sent(&self, head: &str, body: &[u8]) -> (u16, String) {
        let mut stream = self.connect();
        let head = format!(
            "{head}\r\nConnection: close\r\nContent-Length: {}\r\n\r\n",
            body.len()
        );
        stream.write_all(head.as_bytes()).expect("sent");
        let _ = stream.write_all(body);
        let mut text = Vec::new();
        let _ = stream.read_to_end(&mut text);
        let text = String::from_utf8_lossy(&text).into_owned();
        let status = text.split(' ').nth(1).and_then(|word| word.parse().ok());
        let (_, body) = text.split_once("\r\n\r\n").unwrap_or_default();
        (status.unwrap_or(0), body.to_owned())
    }

    fn host(&self) -> String {
        format!("Host: 127.0.0.1:{}", self.port)
    }

    fn get(&self, path: &str) -> (u16, String) {
        self.sent(&format!("GET {path} HTTP/1.1\r\n{}", self.host()), b"")
    }

    fn posted(&self, headers: &str, body: &[u8]) -> (u16, String) {
        let host = self.host();
        let head =
            format!("POST /ask HTTP/1.1\r\n{host}\r\nContent-Type: application/json{headers}");
        self.sent(&head, body)
    }

    /// Whether a request is answered as it should be.
    fn is_well(&self) -> bool {
        let (status, body) = self.posted("", &declaration("well"));
        status == 200 && body.contains("OneSided")
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

fn declaration(client: &str) -> Vec<u8> {
    let text = of("one-sided", 0.6, 1.6).text;
    json!({ "client": client, "ask": { "declaration": { "text": text } } })
        .to_string()
        .into_bytes()
}

#[test]
fn the_page_is_answered_and_nobody_else() {
    let served = Served::new("");
    let (status, page) = served.get("/");
    assert_eq!(status, 200);
    assert!(page.contains("<title>hertzian explore</title>"));
    let (status, models) = served.get("/models");
    let models: Value = serde_json::from_str(&models).expect("JSON");
    assert_eq!(
        (status, models[0]["name"].as_str()),
        (200, Some("one-sided"))
    );
    let port = served.port;
    let get = |host: &str, more: &str| {
        served
            .sent(&format!("GET /models HTTP/1.1\r\nHost: {host}{more}"), b"")
            .0
    };
    assert_eq!(get(&format!("localhost:{port}"), ""), 200);
    // A name that somebody has led here, another port, no port.
    for host in [
        "evil.example",
        "127.0.0.1",
        "127.0.0.1.evil.example",
        "127.0.0.1:1",
        "",
    ] {
        assert_eq!(get(host, ""), 403, "{host}");
    }
    let here = format!("127.0.0.1:{port}");
    assert_eq!(get(&here, &format!("\r\nOrigin: http://{here}")), 200);
    for origin in [
        "http://evil.example",
        "null",
        &format!("https://{here}"),
        &format!("http://{here}.evil.example"),
    ] {
        assert_eq!(
            get(&here, &format!("\r\nOrigin: {origin}")),
            403,
            "{origin}"
        );
        assert_eq!(
            served
                .posted(&format!("\r\nOrigin: {origin}"), &declaration("a"))
                .0,
            403
        );
    }
    assert_eq!(
        served
            .posted("\r\nSec-Fetch-Site: cross-site", &declaration("a"))
            .0,
        403
    );
    // What a form of another page could send.
    let head = format!(
        "POST /ask HTTP/1.1\r\n{}\r\nContent-Type: text/plain",
        served.host()
    );
    assert_eq!(served.sent(&head, &declaration("a")).0, 403);
    for path in [
        "/../../../etc/passwd",
        "/%2e%2e/Cargo.toml",
        "//etc/passwd",
        "/main.rs",
        "/ask",
    ] {
        assert_eq!(served.get(path).0, 404, "{path}");
    }
    assert_eq!(
        served
            .sent(&format!("DELETE / HTTP/1.1\r\n{}", served.host()), b"")
            .0,
        405
    );
    assert!(served.is_well());
}

#[test]
fn what_is_too_large_is_refused_in_a_sentence() {
    let served = Served::new("");
    let (status, body) = served.posted("", &vec![b'x'; 10_000_000]);
    assert_eq!(status, 413);
    let fault: Value = serde_json::from_str(&body).expect("JSON");
    let said = fault["fault"]["message"].as_str().expect("a sentence");
    assert!(said.contains("larger than 1048576 bytes"), "{said}");
    assert_eq!(said.lines().count(), 1);
    for body in [&b""[..], b"{", b"null", b"[[[[[[[[", b"{\"client\":1}"] {
        let (status, said) = served.posted("", body);
        assert_eq!(status, 400, "{said}");
    }
    assert!(served.is_well());
}

#[test]
fn what_is_no_http_ends_its_connection_alone() {
    let served = Served::new("");
    for bytes in [
        &b"\0\0\0\0"[..],
        b"GET",
        b"GET / HTTP/9.9\r\n\r\n",
        b"POST /ask HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n",
    ] {
        let mut stream = served.connect();
        let _ = stream.write_all(bytes);
        let _ = stream.shutdown(std::net::Shutdown::Write);
        let _ = stream.read_to_end(&mut Vec::new());
    }
    assert!(served.is_well());
}

/// Pages that have gone away do not keep threads busy.
#[test]
fn work_that_nobody_waits_for_makes_room() {
    let served = Served::new("");
    for client in 0..6 {
        let asked = of("ball-bearing", 0.3, 0.65);
        let curve = json!({ "of": asked, "plot": "", "effort": "full" });
        let body = json!({ "client": format!("{client}"), "ask": { "curve": curve } }).to_string();
        let mut stream = served.connect();
        let head = format!(
            "POST /ask HTTP/1.1\r\n{}\r\nContent-Type: application/json\r\nContent-Length: {}\r\n\r\n",
            served.host(),
            body.len()
        );
        stream.write_all(head.as_bytes()).expect("sent");
        stream.write_all(body.as_bytes()).expect("sent");
        std::thread::sleep(Duration::from_millis(50));
    }
    // Six times several seconds of work on a few threads, all of which were given up.
    let begun = Instant::now();
    assert!(served.is_well());
    assert!(
        begun.elapsed() < Duration::from_secs(5),
        "{:?}",
        begun.elapsed()
    );
}

#[test]
fn a_model_that_cannot_be_read_is_refused_before_anything_is_served() {
    let program = Command::new(env!("CARGO_BIN_EXE_hertzian"))
        .args(["explore", "nothing-of-this-name"])
        .output()
        .expect("the program");
    assert_eq!(program.status.code(), Some(2));
    let said = String::from_utf8_lossy(&program.stderr).into_owned();
    assert!(said.contains("names of models: one-sided"), "{said}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it() {
    let mut served = Served::new("two-masses --set drive=0.2");
    let (_, models) = served.get("/models");
    let models: Value = serde_json::from_str(&models).expect("JSON");
    assert_eq!(models[0]["values"], json!([["drive", 0.2]]));
    let id = served.program.id().to_string();
    let sent = Command::new("kill").args(["-INT", &id]).status();
    assert!(sent.expect("kill").success());
    let begun = Instant::now();
    let code = loop {
        if let Some(status) = served.program.try_wait().expect("a status") {
            break status.code();
        }
        assert!(begun.elapsed() < Duration::from_secs(10), "it goes on");
        std::thread::sleep(Duration::from_millis(20));
    };
    assert_eq!(code, Some(0));
}
