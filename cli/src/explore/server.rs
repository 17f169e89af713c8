//! The server: it takes requests, refuses what is not from the page or too large, and hands the rest to threads.

use std::convert::Infallible;
use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::pin::Pin;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

use hertzian::Cancel;
use http_body_util::{BodyExt, Either, Full};
use hyper::body::{Body, Bytes, Frame, Incoming};
use hyper::header::{CACHE_CONTROL, CONTENT_TYPE, HeaderName, HeaderValue};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use serde::Serialize;
use serde_json::{Value, json};
use tokio::net::TcpListener;
use tokio::runtime::Builder;
use tokio::sync::{Semaphore, mpsc};
use tokio::time::timeout;

use super::fault::{Fault, Kind};
use super::guard;
use super::models::{Offered, offered};
use super::options::Options;
use super::pages::{PAGES, Page};
use super::work::{Emit, Request, Ticket, Work};
use crate::program::{Ended, Failed, print};

/// Bytes of a request that is read. A declaration has less than a quarter of it.
const LONGEST: usize = 1 << 20;
/// Bytes beyond that are read and thrown away, so that the sentence that refuses them is read; after so many the connection is closed.
const DRAINED: usize = 1 << 26;
/// A request that takes longer to arrive has been given up.
const ARRIVES: Duration = Duration::from_secs(20);
/// Between two looks at the token that ends the server.
const LOOK: Duration = Duration::from_millis(100);
/// Connections at the same time, and requests that wait for a thread.
const CONNECTIONS: usize = 256;
const WAITING: usize = 256;
/// Declarations and series nest; the stack of a thread has room for both.
const STACK: usize = 1 << 24;
/// What the browser may load: the files of the page, and nothing from elsewhere.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data: blob:; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

type Answer = Response<Either<Full<Bytes>, Lines>>;

/// What every connection knows.
struct Server {
    port: u16,
    models: Vec<Offered>,
    work: Arc<Work>,
    threads: Arc<Semaphore>,
    waiting: Arc<Semaphore>,
    cancel: Cancel,
}

/// Serves the page until the token is cancelled.
///
/// # Errors
/// If the model cannot be read, or nothing can listen on the port.
pub fn run(options: &Options, cancel: &Cancel) -> Result<Ended, Failed> {
    let failed = |message: String| Failed { message, code: 2 };
    let models = offered(options).map_err(|fault| failed(fault.message))?;
    let threads = std::thread::available_parallelism().map_or(2, usize::from);
    let runtime = Builder::new_multi_thread()
        .worker_threads(2)
        .max_blocking_threads(threads + 2)
        .thread_stack_size(STACK)
        .enable_all()
        .build()
        .map_err(|error| failed(error.to_string()))?;
    let address = SocketAddr::from((Ipv4Addr::LOCALHOST, options.port));
    let served = runtime.block_on(async {
        let listener = TcpListener::bind(address).await?;
        let port = listener.local_addr()?.port();
        let url = format!("http://127.0.0.1:{port}/");
        print(&format!("{url}\n"))?;
        let complaint = options.open.then(|| open(&url)).and_then(Result::err);
        let server = Arc::new(Server {
            port,
            models,
            work: Arc::new(Work::default()),
            threads: Arc::new(Semaphore::new(threads)),
            waiting: Arc::new(Semaphore::new(WAITING)),
            cancel: cancel.clone(),
        });
        listen(&listener, &server).await;
        Ok::<_, io::Error>(complaint)
    });
    // What is still computed has the token.
    runtime.shutdown_timeout(Duration::from_secs(2));
    let complaint = served.map_err(|error| {
        failed(format!(
            "cannot listen on 127.0.0.1, port {}: {error}",
            options.port
        ))
    })?;
    let complaint = complaint.map(|error| format!("no browser was opened: {error}"));
    Ok(Ended {
        summary: String::new(),
        complaints: complaint.into_iter().collect(),
        complete: true,
    })
}

/// Opens an address in the browser.
fn open(url: &str) -> io::Result<()> {
    let (program, words): (_, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        "windows" => ("cmd", &["/C", "start", ""]),
        _ => ("xdg-open", &[]),
    };
    let mut command = Command::new(program);
    let command = command.args(words).arg(url);
    let quiet = command.stdout(Stdio::null()).stderr(Stdio::null());
    quiet.spawn().map(drop)
}

async fn listen(listener: &TcpListener, server: &Arc<Server>) {
    let connections = Arc::new(Semaphore::new(CONNECTIONS));
    while !server.cancel.is_cancelled() {
        let Ok(accepted) = timeout(LOOK, listener.accept()).await else {
            continue;
        };
        let Ok((stream, _)) = accepted else {
            // There are no more files, say; a moment later there may be.
            tokio::time::sleep(LOOK).await;
            continue;
        };
        let Ok(permit) = Arc::clone(&connections).try_acquire_owned() else {
            continue;
        };
        let _ = stream.set_nodelay(true);
        let server = Arc::clone(server);
        tokio::spawn(async move {
            let service = service_fn(|request| answer(&server, request));
            let mut connection = http1::Builder::new();
            let connection = connection.timer(TokioTimer::new());
            let connection = connection.header_read_timeout(ARRIVES);
            // A connection that breaks concerns nobody but its browser.
            let _ = connection
                .serve_connection(TokioIo::new(stream), service)
                .await;
            drop(permit);
        });
    }
}

async fn answer(
    server: &Arc<Server>,
    request: hyper::Request<Incoming>,
) -> Result<Answer, Infallible> {
    Ok(match respond(server, request).await {
        Ok(answer) => answer,
        Err((status, fault)) => json_answer(status, &json!({ "fault": fault })),
    })
}

async fn respond(
    server: &Arc<Server>,
    request: hyper::Request<Incoming>,
) -> Result<Answer, (StatusCode, Fault)> {
    let (head, body) = request.into_parts();
    if let Err(fault) = guard::check(&head.method, &head.headers, server.port) {
        // What is sent along is not read.
        return Err((StatusCode::FORBIDDEN, fault));
    }
    let path = head.uri.path();
    match (&head.method, path) {
        (&Method::GET, "/models") => Ok(json_answer(StatusCode::OK, &server.models)),
        (&Method::POST, "/ask") => {
            let body = read(body).await?;
            let request = Request::read(&body);
            let request = request.map_err(|fault| (StatusCode::BAD_REQUEST, fault))?;
            server.work_on(request)
        }
        (&Method::GET, path) => {
            let page = PAGES.iter().find(|page| page.path == path);
            page.map(page_answer).ok_or_else(|| {
                let fault = Fault::request("nothing is here: the page is at /");
                (StatusCode::NOT_FOUND, fault)
            })
        }
        _ => {
            let fault = Fault::request("requests are GET of the page and POST to /ask");
            Err((StatusCode::METHOD_NOT_ALLOWED, fault))
        }
    }
}

/// The whole of a body, unless it is too large or takes too long.
async fn read(mut body: Incoming) -> Result<Vec<u8>, (StatusCode, Fault)> {
    let all = async {
        let (mut bytes, mut length) = (Vec::new(), 0_usize);
        while let Some(frame) = body.frame().await {
            let Ok(frame) = frame else {
                return Err((
                    StatusCode::BAD_REQUEST,
                    Fault::request("the request ended in its midst"),
                ));
            };
            let Some(data) = frame.data_ref() else {
                continue;
            };
            length = length.saturating_add(data.len());
            if length > DRAINED {
                break;
            }
            if length <= LONGEST {
                bytes.extend_from_slice(data);
            } else {
                bytes = Vec::new();
            }
        }
        if length > LONGEST {
            let message =
                format!("the request is larger than {LONGEST} bytes: nothing here needs so many");
            return Err((StatusCode::PAYLOAD_TOO_LARGE, Fault::request(message)));
        }
        Ok(bytes)
    };
    timeout(ARRIVES, all).await.unwrap_or_else(|_| {
        let fault = Fault::request("the request took too long to arrive");
        Err((StatusCode::REQUEST_TIMEOUT, fault))
    })
}

impl Server {
    /// Hands a request to a thread, as soon as one is free, and sends what it says line by line.
    fn work_on(self: &Arc<Self>, request: Request) -> Result<Answer, (StatusCode, Fault)> {
        let Ok(place) = Arc::clone(&self.waiting).try_acquire_owned() else {
            let fault = Fault::new(Kind::Busy, "too many requests are waiting: ask again");
            return Err((StatusCode::SERVICE_UNAVAILABLE, fault));
        };
        let ticket = self.work.begin(&request, &self.cancel);
        let (cancel, work) = (ticket.cancel.clone(), Arc::clone(&self.work));
        let (lines, receiver) = mpsc::unbounded_channel();
        let threads = Arc::clone(&self.threads);
        tokio::spawn(async move {
            let Ok(thread) = threads.acquire_owned().await else {
                return;
            };
            let emit: Emit = Arc::new(move |value| {
                // Nobody may be there any more.
                let _ = lines.send(line(&value));
            });
            let worked =
                tokio::task::spawn_blocking(move || work.answer(&request.ask, &cancel, &emit));
            let _ = worked.await;
            drop((thread, place));
        });
        let lines = Lines {
            receiver,
            _ticket: ticket,
        };
        let mut answer = Response::new(Either::Right(lines));
        dress(&mut answer, "application/x-ndjson");
        Ok(answer)
    }
}

/// A line of JSON.
fn line(value: &Value) -> Bytes {
    let mut text = value.to_string();
    text.push('\n');
    Bytes::from(text)
}

/// An answer that comes line by line. When the browser has gone, it is dropped, and the work with it.
struct Lines {
    receiver: mpsc::UnboundedReceiver<Bytes>,
    _ticket: Ticket,
}

impl Body for Lines {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        let line = self.receiver.poll_recv(context);
        line.map(|line| line.map(|line| Ok(Frame::data(line))))
    }
}

fn json_answer(status: StatusCode, value: &impl Serialize) -> Answer {
    let text = serde_json::to_vec(value).unwrap_or_default();
    let mut answer = Response::new(Either::Left(Full::new(Bytes::from(text))));
    *answer.status_mut() = status;
    dress(&mut answer, "application/json");
    answer
}

fn page_answer(page: &Page) -> Answer {
    let text = Bytes::from_static(page.text.as_bytes());
    let mut answer = Response::new(Either::Left(Full::new(text)));
    dress(&mut answer, page.kind);
    answer
}

/// The headers of every answer.
fn dress(answer: &mut Answer, kind: &'static str) {
    let headers = answer.headers_mut();
    headers.insert(CONTENT_TYPE, HeaderValue::from_static(kind));
    headers.insert(CACHE_CONTROL, HeaderValue::from_static("no-store"));
    for (name, value) in [
        ("content-security-policy", POLICY),
        ("x-content-type-options", "nosniff"),
        ("referrer-policy", "no-referrer"),
        ("cross-origin-resource-policy", "same-origin"),
        ("cross-origin-opener-policy", "same-origin"),
    ] {
        headers.insert(
            HeaderName::from_static(name),
            HeaderValue::from_static(value),
        );
    }
}
