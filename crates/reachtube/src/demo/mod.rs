//! The virtual robot of the demo.
