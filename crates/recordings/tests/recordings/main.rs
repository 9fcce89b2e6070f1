//! Tests of recordings: their order, temperatures and files.

mod logged;
mod order_and_temperature;
#[cfg(feature = "parquet")]
mod parquet_files;
mod round_trip;
