//! Branches that begin at bifurcations, and a crisis, against exact values.

mod asked;
mod backbone;
mod balance;
mod cascade;
mod codimension;
mod coexisting;
mod corners;
mod covered;
mod crisis;
mod crossing;
mod curves;
mod doubling;
mod exchanged;
mod grazing;
mod halved;
mod hidden;
mod interrupted;
mod meeting;
mod mirrored;
mod narrow;
mod symmetry;
mod table;
mod torus;
mod unbounded;
mod units;
mod vertical;
