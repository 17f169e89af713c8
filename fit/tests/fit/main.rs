//! Fits of data that another integration made, of data with noise, and what is refused.

mod common;
mod judged;
mod linear;
mod noise;
mod recovered;
mod tables;
