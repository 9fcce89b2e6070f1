reachtube_finding::codes! {
    /// What a finding about commanded and actual positions is about.
    pub enum Code {
        /// The sets are not narrower than what the logs alone give.
        NotNarrower = "not-narrower",
        /// There are too few motions to say anything of others.
        FewMotions = "few-motions",
        /// Samples of an arm that does not follow its command were set aside.
        NotFollowing = "not-following",
        /// The clocks of command and actual position slip.
        ClockSlips = "clock-slips",
    }
}
