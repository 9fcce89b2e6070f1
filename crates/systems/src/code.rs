reachtube_finding::codes! {
    /// What a finding about a system is about.
    pub enum Code {
        /// The sets are not narrower than those without a model.
        NotNarrower = "not-narrower",
        /// A set is wider than the motion of its output.
        WiderThanMotion = "wider-than-motion",
        /// There are too few recordings to say anything of others.
        FewMotions = "few-motions",
        /// A parameter is at a bound.
        AtBound = "at-bound",
        /// A recording is there twice.
        Copies = "copies",
        /// Outputs do not tell all states.
        Unobserved = "unobserved",
    }
}
