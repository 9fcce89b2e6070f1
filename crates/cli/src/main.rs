//! The command `reachtube`.
fn main() {}
