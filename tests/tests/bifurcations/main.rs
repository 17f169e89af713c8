//! Branches that begin at bifurcations, and a crisis, against exact values.

mod asked;
mod backbone;
mod balance;
mod cascade;
mod codimension;
mod coexisting;
mod crisis;
mod crossing;
mod curves;
mod doubling;
mod grazing;
mod halved;
mod hidden;
mod interrupted;
mod mirrored;
mod symmetry;
mod table;
mod torus;
mod units;
