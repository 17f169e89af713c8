//! Tests of the compiler and the runtime together. One binary, so that its parts are linked once and run beside each other.

mod agreement;
mod bifurcations;
mod declarations;
mod differential;
mod response;
mod sensitivity;
mod stability;
