/// Why a sample was refused. The monitor is as it was before the sample.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SampleError {
    /// A list has another number of entries than the robot has joints.
    #[error("{given} {what}; the model has {needed} joints, so give {needed}")]
    Count {
        /// The list: positions, velocities or torques.
        what: &'static str,
        /// How many entries it has.
        given: usize,
        /// How many it must have.
        needed: usize,
    },
    /// A number is not finite.
    #[error("{name} is {value}; give finite numbers, or leave the sample out")]
    NotFinite {
        /// The column: t, q1, qd1, tau1, ...
        name: String,
        /// The number.
        value: f64,
    },
    /// A sample is not later than the one before.
    #[error(
        "t is {time} s after a sample at {previous} s; times must increase, so sort the samples \
         and drop repeated ones"
    )]
    Order {
        /// Its time, s.
        time: f64,
        /// The time of the sample before, s.
        previous: f64,
    },
    /// Too much time passed since the sample before.
    #[error(
        "t is {time} s after a sample at {previous} s: a gap longer than {longest} s, over which \
         the input is not known; begin anew after it, or allow longer gaps"
    )]
    Gap {
        /// Its time, s.
        time: f64,
        /// The time of the sample before, s.
        previous: f64,
        /// The longest time that is allowed, s.
        longest: f64,
    },
    /// A motion starts where earlier samples tell, and they are unknown.
    #[error(
        "the model's motions start where earlier samples tell, and the monitor was not told; call \
         `tell` before each sample"
    )]
    NotTold,
}
