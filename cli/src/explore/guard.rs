//! Who is answered: the page itself, on this machine.
//!
//! A page of elsewhere that a browser has open can send requests to any address. It cannot choose the header `Host`, which a name that was
//! led to 127.0.0.1 (DNS rebinding) would stand in, nor leave out `Origin` where a request has a body, nor send JSON without asking first.

use hyper::Method;
use hyper::header::{CONTENT_TYPE, HOST, HeaderMap, HeaderName, ORIGIN};

use super::fault::Fault;

/// Names of this machine in an address.
const NAMES: [&str; 3] = ["127.0.0.1", "localhost", "[::1]"];

/// Whether a request is from the page that this port serves.
///
/// # Errors
/// Why it is not.
pub fn check(method: &Method, headers: &HeaderMap, port: u16) -> Result<(), Fault> {
    let text = |name: HeaderName| headers.get(name).and_then(|value| value.to_str().ok());
    let host = text(HOST).unwrap_or_default();
    if headers.get_all(HOST).iter().count() != 1 || !is_here(host, port) {
        return Err(Fault::request(
            "the request is not to this machine by its own name: open the address that was printed",
        ));
    }
    if let Some(origin) = headers.get(ORIGIN) {
        let origin = origin.to_str().unwrap_or_default();
        let host = origin.strip_prefix("http://");
        if !host.is_some_and(|host| is_here(host, port)) {
            return Err(Fault::request("the request is from a page of elsewhere"));
        }
    }
    let site = text(HeaderName::from_static("sec-fetch-site"));
    if method == Method::POST {
        if site.is_some_and(|site| site != "same-origin") {
            return Err(Fault::request("the request is from a page of elsewhere"));
        }
        let json = text(CONTENT_TYPE).and_then(|kind| kind.split(';').next());
        if json.map(str::trim) != Some("application/json") {
            return Err(Fault::request(
                "a request has a body of the type application/json",
            ));
        }
    }
    Ok(())
}

/// Whether a host with its port is this server. A browser leaves out port 80.
fn is_here(host: &str, port: u16) -> bool {
    NAMES.iter().any(|name| match host.strip_prefix(name) {
        Some("") => port == 80,
        Some(rest) => rest.strip_prefix(':') == Some(port.to_string().as_str()),
        None => false,
    })
}
