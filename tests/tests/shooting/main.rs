//! Shooting against exact values, and against the harmonic balance.

mod affine;
mod integrated;
