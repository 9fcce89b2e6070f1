reachtube_finding::codes! {
    /// What a finding about logs, and about a model made of them, is about.
    pub enum Code {
        /// The effect of a choice that was not applied.
        WouldHelp = "would-help",
        /// The recordings contradict the robot's description, or the dynamics of rigid bodies.
        Contradiction = "contradiction",
        /// The horizon is shorter than half a period of the low-pass's cut-off.
        ShortHorizon = "short-horizon",
        /// Positions that were whole turns away from other recordings were moved.
        TurnsMoved = "turns-moved",
        /// Samples are missing or were left out, and no window crosses them.
        MissingSamples = "missing-samples",
        /// A model of an arm under its controller is no better than none.
        ModelNotUseful = "model-not-useful",
    }
}
