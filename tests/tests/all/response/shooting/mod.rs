//! Shooting against exact values, and against the harmonic balance.

mod affine;
mod bends;
mod coupled;
mod integrated;
mod powers;
mod stated;
