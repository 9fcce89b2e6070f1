//! Tests of intervals, exact sums, lanes, Taylor polynomials and Taylor models.

mod common;
mod elementary_functions;
mod exact_rationals;
mod exact_sums;
mod inclusion;
mod lanes;
mod maryada;
mod taylor_models;
mod taylor_polynomials;
