reachtube_finding::codes! {
    /// What a finding about stops and scenarios is about.
    pub enum Code {
        /// From each sample every joint is proved to come to a standstill.
        Stands = "stands",
        /// From some states no standstill is proved.
        StandstillOpen = "standstill-open",
        /// A recorded stop is not within the proved one.
        StopNotCovered = "stop-not-covered",
        /// Samples from which the path ends before the deceleration does.
        StopsLeftOut = "stops-left-out",
        /// The table of ISO 10218-1 lacks rows, since something is not given.
        TableIncomplete = "table-incomplete",
        /// A load turns a joint with more torque than its brake is sure to hold.
        BrakeWeak = "brake-weak",
        /// Links have no capsule.
        LinksLeftOut = "links-left-out",
        /// Every link stays clear of every obstacle on every motion of the model.
        Safe = "safe",
        /// On a simulated motion of the model a link comes too close to an obstacle.
        Unsafe = "unsafe",
        /// No distance is proved, and no motion was found that comes too close.
        Undecided = "undecided",
        /// Steps divided into more parts decide.
        StepsTooLong = "steps-too-long",
        /// The plan is proved at a lower speed.
        PlanTooFast = "plan-too-fast",
        /// Smaller sets decide.
        SetsTooLarge = "sets-too-large",
        /// The nominal motion itself comes too close for a proof.
        NominalTooClose = "nominal-too-close",
        /// Whether smaller sets decide was not tried.
        SetsNotTried = "sets-not-tried",
    }
}
