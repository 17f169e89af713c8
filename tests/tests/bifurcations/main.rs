//! Branches that begin at bifurcations, against exact values.

mod cascade;
mod symmetry;
