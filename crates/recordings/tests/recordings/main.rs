//! Tests of recordings: their order, temperatures and files.

mod order_and_temperature;
mod round_trip;
