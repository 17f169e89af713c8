//! The files of the page, which are in the program.

/// A file of the page.
#[derive(Debug, Clone, Copy)]
pub struct Page {
    /// Where it is asked for.
    pub path: &'static str,
    /// Its type.
    pub kind: &'static str,
    /// What is in it.
    pub text: &'static str,
}

macro_rules! pages {
    ($($path:literal $kind:literal $file:literal)*) => {
        &[$(Page { path: $path, kind: $kind, text: include_str!(concat!("page/", $file)) }),*]
    };
}

/// All of them.
pub const PAGES: &[Page] = pages! {
    "/" "text/html; charset=utf-8" "index.html"
    "/style.css" "text/css; charset=utf-8" "style.css"
    "/main.js" "text/javascript; charset=utf-8" "main.js"
    "/session.js" "text/javascript; charset=utf-8" "session.js"
    "/curves.js" "text/javascript; charset=utf-8" "curves.js"
    "/measured.js" "text/javascript; charset=utf-8" "measured.js"
    "/motions.js" "text/javascript; charset=utf-8" "motions.js"
    "/found.js" "text/javascript; charset=utf-8" "found.js"
    "/take.js" "text/javascript; charset=utf-8" "take.js"
    "/state.js" "text/javascript; charset=utf-8" "state.js"
    "/net.js" "text/javascript; charset=utf-8" "net.js"
    "/dom.js" "text/javascript; charset=utf-8" "dom.js"
    "/axes.js" "text/javascript; charset=utf-8" "axes.js"
    "/chart.js" "text/javascript; charset=utf-8" "chart.js"
    "/controls.js" "text/javascript; charset=utf-8" "controls.js"
    "/orbit.js" "text/javascript; charset=utf-8" "orbit.js"
    "/play.js" "text/javascript; charset=utf-8" "play.js"
    "/editor.js" "text/javascript; charset=utf-8" "editor.js"
};
