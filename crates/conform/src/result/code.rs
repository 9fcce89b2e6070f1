reachtube_finding::codes! {
    /// What a finding of `conform`, `check` or `monitor` is about.
    pub enum Code {
        /// Every recording was proved to be enclosed.
        Conformant = "conformant",
        /// Some recordings were not proved to be enclosed.
        NotConformant = "not-conformant",
        /// The sets were proved to enclose every recording but do not limit every state.
        Vacuous = "vacuous",
        /// How many recorded points were proved to lie in the reachable set.
        Points = "points",
        /// A reachable set could not be computed to the end.
        SetLost = "set-lost",
        /// A simulated motion of the model diverged.
        Unstable = "unstable",
        /// How many rows hold.
        Rows = "rows",
        /// Recordings are compared at samples.
        AtSamples = "at-samples",
        /// What the notion of conformance does not ask.
        Notion = "notion",
        /// The reachable set was computed as an outer enclosure.
        OuterSet = "outer-set",
        /// The point that lies furthest outside.
        FurthestOutside = "furthest-outside",
        /// What the sets cost.
        Cost = "cost",
        /// The sets are not the smallest.
        NotSmallest = "not-smallest",
        /// The reachable set is more than twice as wide as the recorded motion.
        ReachableSetSize = "reachable-set-size",
        /// X0 is wider than the recorded motion.
        InitialSetSize = "initial-set-size",
        /// The positions of X0 reach much further than the recorded starts.
        InitialSetStarts = "initial-set-starts",
        /// X0 does not contain 0.
        InitialSetOffset = "initial-set-offset",
        /// U reaches beyond the recorded input.
        InputSetSize = "input-set-size",
        /// U does not contain 0.
        InputSetOffset = "input-set-offset",
        /// U is 0 although the input has an error, and many times the error elsewhere.
        InputSetZero = "input-set-zero",
        /// V is nearly as wide as the recorded motion.
        NoiseSetSize = "noise-set-size",
        /// The nominal motion explains little of the recorded one.
        Unexplained = "unexplained",
        /// The recordings are faster than the recordings that friction was fitted to.
        FrictionRange = "friction-range",
        /// Viscous friction falls with speed.
        FallingFriction = "falling-friction",
        /// The most likely cause of other warnings, or of rows outside the sets.
        Cause = "cause",
        /// The fitted model needs larger sets for motions that it was not fitted to.
        Overfitted = "overfitted",
        /// What the fit of the nominal model changed.
        Fitted = "fitted",
        /// A fit of the nominal model was not taken.
        FitNotTaken = "fit-not-taken",
        /// Fitted values compensate for model error.
        ParametersMoved = "parameters-moved",
        /// The sets that hold for every run.
        AnyRun = "any-run",
        /// Whether U covers motions that stick or slip at other times than the recorded ones.
        Stiction = "stiction",
        /// How many recorded values touch the reachable set.
        Touching = "touching",
        /// How held-out motions scaled the sets.
        Calibrated = "calibrated",
        /// A bound of the probability that the next motion leaves the sets.
        NextMotion = "next-motion",
        /// There is no guarantee for new motions.
        NoGuarantee = "no-guarantee",
        /// The sets without each motion.
        LeftOut = "left-out",
        /// The motion follows the order of the runs.
        RobotChanged = "robot-changed",
        /// What would have to grow to enclose the recordings.
        GrowthNeeded = "growth-needed",
        /// How often held-out recordings leave the sets.
        HeldOutRates = "held-out-rates",
        /// Nothing certain follows for what was not recorded.
        RecordedOnly = "recorded-only",
        /// There are too few independent motions for a useful bound.
        FewMotions = "few-motions",
        /// Whether recordings were used in the fit cannot be known.
        UseUnknown = "use-unknown",
        /// Sets are used for more than they were proved for.
        BeyondProof = "beyond-proof",
        /// No recording of a suite starts near the model's nominal start.
        OtherStart = "other-start",
        /// Recordings that the model lists are missing or have other content.
        OtherRecordings = "other-recordings",
        /// A note on the recordings.
        Recordings = "recordings",
        /// No window of a running robot left its set.
        NeverLeft = "never-left",
        /// A window of a running robot left its set.
        LeftSet = "left-set",
        /// A number of a running robot's motion is outside its range in healthy motion.
        UnlikeHealthy = "unlike-healthy",
    }
}
