//! Branches that begin at bifurcations, against exact values.

mod backbone;
mod cascade;
mod coexisting;
mod curves;
mod doubling;
mod grazing;
mod symmetry;
mod table;
mod torus;
