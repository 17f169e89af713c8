//! Shooting against exact values, and against the harmonic balance.

mod affine;
mod coupled;
mod integrated;
mod powers;
mod stated;
