use serde::{Deserialize, Serialize};

/// Defines the codes, their names and the list of all.
macro_rules! codes {
    ($($(#[doc = $doc:literal])* $code:ident = $name:literal,)*) => {
        /// What a [`Finding`](crate::Finding) is about. Codes are stable; the words of a finding
        /// are not. They are listed in docs/reference.md.
        #[derive(
            Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize,
        )]
        #[non_exhaustive]
        pub enum Code {
            $($(#[doc = $doc])* #[serde(rename = $name)] $code,)*
        }

        impl Code {
            /// All codes.
            #[cfg(test)]
            const ALL: &[Self] = &[$(Self::$code),*];

            /// Returns the name of the code, as in JSON.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$code => $name,)*
                }
            }

            /// Returns what findings of the code state, as a sentence.
            #[must_use]
            pub(crate) fn meaning(self) -> &'static str {
                match self {
                    $(Self::$code => concat!($($doc),*).trim_ascii(),)*
                }
            }
        }
    };
}

codes! {
    /// Every recording was proved to be enclosed.
    Conformant = "conformant",
    /// Some recordings were not proved to be enclosed.
    NotConformant = "not-conformant",
    /// The sets were proved to enclose every recording but do not limit some joint.
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
    /// U is 0 in a joint whose input has an error, and many times the error in another one.
    InputSetZero = "input-set-zero",
    /// V is nearly as wide as the recorded motion.
    NoiseSetSize = "noise-set-size",
    /// The nominal motion explains little of the recorded one.
    Unexplained = "unexplained",
    /// The recordings are faster than the recordings that friction was fitted to.
    FrictionRange = "friction-range",
    /// Viscous friction falls with speed.
    FallingFriction = "falling-friction",
    /// The most likely cause of other warnings.
    Cause = "cause",
    /// What a choice that was not applied would give.
    WouldHelp = "would-help",
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
    /// Whether U covers joints that stick or slip at other times than the recorded ones.
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
    /// The runs that decide the sets.
    DecidingRuns = "deciding-runs",
    /// Joints follow the order of the runs.
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
    /// The recordings contradict the robot's description, or the dynamics of rigid bodies.
    Contradiction = "contradiction",
    /// Positions that were whole turns away from other recordings were moved.
    TurnsMoved = "turns-moved",
    /// The torques were measured behind the gears, and the inertia of motors is unknown.
    MotorsUnknown = "motors-unknown",
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
    /// Smaller sets decide.
    SetsTooLarge = "sets-too-large",
    /// The nominal motion itself comes too close for a proof.
    NominalTooClose = "nominal-too-close",
    /// Whether smaller sets decide was not tried.
    SetsNotTried = "sets-not-tried",
    /// No window of a running robot left its set.
    NeverLeft = "never-left",
    /// A window of a running robot left its set.
    LeftSet = "left-set",
    /// A number of a running robot's motion is outside its range in healthy motion.
    UnlikeHealthy = "unlike-healthy",
}

#[cfg(test)]
mod tests {
    use super::Code;

    #[test]
    fn every_code_is_in_the_docs() {
        let docs = include_str!("../../../../docs/reference.md");
        for code in Code::ALL {
            assert!(docs.contains(&format!("| `{}` |", code.name())), "{}", code.name());
            assert_eq!(serde_json::to_value(code).unwrap(), code.name());
        }
    }
}
