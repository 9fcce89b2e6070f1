//! Tests of recordings: their order, temperatures and files.

mod logged;
mod order_and_temperature;
mod round_trip;
