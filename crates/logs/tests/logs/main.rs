//! Tests of logs: reading, cutting, refusals, damage and hostile input.

mod commands;
mod cutting;
mod damage;
mod inspect;
mod order;
mod refused;
mod routes;
mod support;
