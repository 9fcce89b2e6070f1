//! Tests of reproduced tables and of the bounds for the next motion.

mod coverage;
mod table1;
