use reachtube_conform::Code;
use reachtube_finding::{Finding, Remedy, Severity};
use reachtube_recordings::Torque;

/// The horizon that is proposed for long recordings, s.
const FIRST_HORIZON: f64 = 0.5;

/// The part of the input beyond which nothing shows how it is to be read.
const UNRELATED: f64 = 0.8;

/// What most likely makes an answer implausible. Parts are of the recorded input.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cause {
    /// The recordings mean something else than was stated.
    Reading {
        /// What they mean, as a clause.
        clause: String,
        /// The kind of the torques, if that was stated wrongly.
        kind: Option<Torque>,
        /// The part that the recorded motion does not explain under this reading.
        unexplained: f64,
        /// The part that it does not explain as stated.
        as_stated: f64,
    },
    /// The positions lie far from the point about which deviations have the robot's inertia.
    ExpansionPoint {
        /// The largest distance, rad.
        distance: f64,
        /// The mean of the positions, n, rad.
        mean: Vec<f64>,
    },
    /// The robot explains the recordings, and the constant inertia of model 1 does not.
    ConstantInertia {
        /// The part that the robot does not explain.
        by_robot: f64,
        /// The part that model 1 does not explain.
        by_model: f64,
        /// How far the positions lie from the expansion point, rad.
        distance: f64,
        /// The mean of the positions, n, rad, and the part that model 1 does not explain about it,
        /// where that is much less.
        about_mean: Option<(Vec<f64>, f64)>,
        /// Whether nominal motions can follow the robot's own equations instead.
        can_follow_robot: bool,
    },
    /// The robot explains the recordings, which are long: a prediction widens with time.
    Horizon {
        /// The part that is not explained.
        unexplained: f64,
        /// The end of the longest recording, s.
        longest: f64,
    },
    /// The recorded motion does not explain the input, however the recordings are read.
    Parameters {
        /// The part that is not explained.
        unexplained: f64,
        /// Whether the robot was identified from recordings already.
        is_identified: bool,
        /// Whether the nominal model was fitted for small sets already.
        is_fitted: bool,
        /// The end of the longest recording, s.
        longest: f64,
    },
}

impl Cause {
    /// Reports the most likely cause of other warnings.
    pub(super) fn warning(&self) -> Finding {
        let remedy;
        let text = match self {
            Self::Reading { clause, kind, unexplained, as_stated } => {
                remedy = kind.map(|kind| Remedy::new("torque", format!("{kind:?}").to_lowercase()));
                format!(
                    "The most likely cause: {clause}. So read, {} of the recorded input is not \
                     explained by the recorded motion, and {} as stated.",
                    percent(*unexplained),
                    percent(*as_stated)
                )
            }
            Self::ExpansionPoint { distance, mean } => {
                remedy = Some(Remedy::new("expansion", point(mean)));
                format!(
                    "The nominal motions follow the robot, and deviations from them the inertia at \
                     the expansion point, from which the positions lie up to {distance:.2} rad. \
                     The mean of the positions is a better point."
                )
            }
            Self::ConstantInertia { about_mean, can_follow_robot, .. } => {
                remedy = Some(match (about_mean, can_follow_robot) {
                    (Some((mean, _)), _) => Remedy::new("expansion", point(mean)),
                    (None, true) => Remedy::new("equations", "robot"),
                    (None, false) => Remedy::new("paper-model", "3"),
                });
                constant_inertia_words(self)
            }
            Self::Horizon { unexplained, longest } => {
                remedy = Some(Remedy::new("horizon", format!("{FIRST_HORIZON}")));
                format!(
                    "The robot explains the recorded input but for {}. A prediction from the \
                     recorded input alone widens with time, and the recordings last up to \
                     {longest:.1} s. Predict over a shorter time.",
                    percent(*unexplained)
                )
            }
            Self::Parameters { .. } => {
                let (words, setting, value) = parameters_words(self);
                remedy = Some(Remedy::new(setting, value));
                words
            }
        };
        Finding::new(Severity::Warning, Code::Cause, text).remedied_by(remedy)
    }
}

/// Returns the sentences about parameters that do not explain the recordings, and the setting that
/// helps. What was done already is not proposed again.
fn parameters_words(cause: &Cause) -> (String, &'static str, String) {
    let Cause::Parameters { unexplained, is_identified, is_fitted, longest } = cause else {
        return Default::default();
    };
    let (what_to_do, setting, value) = match (is_fitted, is_identified) {
        (true, _) => (
            "The nominal model was fitted for small sets already, so record more motions, or \
             predict over a shorter time.",
            "horizon",
            half(*longest),
        ),
        (false, true) => (
            "The robot was identified already, so fit the nominal model for small sets.",
            "fit",
            String::new(),
        ),
        (false, false) => (
            "Check the robot's parameters, for example with `reachtube identify`, or fit the \
             nominal model for small sets.",
            "fit",
            String::new(),
        ),
    };
    let left = percent(*unexplained);
    let words = if *unexplained > UNRELATED {
        format!(
            "The recorded motion does not explain {left} of the recorded input, however it is \
             read. Check that the torques were measured, and with these motions. {what_to_do}"
        )
    } else {
        // A robot that was identified has the unit, the sign and the kind of its torques.
        let of_all = match is_identified {
            true => "",
            false => "N mm, kN m, the opposite sign or another kind of the torques, ",
        };
        format!(
            "The recorded motion does not explain {left} of the recorded input. Tried without \
             gain: {of_all}degrees, a wrong sign or order of single torques, and torques up to \
             0.2 s late. {what_to_do}"
        )
    };
    (words, setting, value)
}

/// Returns the sentences about a model whose inertia is constant.
fn constant_inertia_words(cause: &Cause) -> String {
    let Cause::ConstantInertia { by_robot, by_model, distance, about_mean, can_follow_robot } =
        cause
    else {
        return String::new();
    };
    let better = about_mean.as_ref().map(|(mean, unexplained)| {
        let also = match can_follow_robot {
            true => "Nominal motions by the robot's own equations follow the robot.",
            false => "Model 3 of order 2 follows how the inertia changes.",
        };
        format!(
            " About {}, the mean of the positions, {} is not explained. {also}",
            point(mean),
            percent(*unexplained)
        )
    });
    format!(
        "The robot explains the recordings, and model 1 does not: {} of the recorded input is not \
         explained by the robot, and {} by the inertia at the expansion point, from which the \
         positions lie up to {distance:.2} rad.{} Shorter windows lessen the error.",
        percent(*by_robot),
        percent(*by_model),
        better.unwrap_or_default(),
    )
}

/// Returns about half of a time, s.
fn half(time: f64) -> String {
    let half = 0.5 * time;
    let unit = 10f64.powi(half.max(1e-3).log10().floor() as i32);
    let text = format!("{:.3}", unit * (half / unit).floor().max(1.0));
    text.trim_end_matches('0').trim_end_matches('.').into()
}

/// Returns a position as settings have it.
fn point(q: &[f64]) -> String {
    q.iter().map(|q| format!("{q:.2}")).collect::<Vec<_>>().join(",")
}

fn percent(part: f64) -> String {
    match part {
        ..0.01 => "less than 1 %".into(),
        _ => format!("{:.0} %", 100.0 * part.min(1.0)),
    }
}

#[cfg(test)]
mod tests {
    use reachtube_finding::FrontEnd;

    use super::*;

    #[test]
    fn a_small_part_is_not_printed_as_none() {
        assert_eq!([0.004, 0.02, 7.0].map(percent), ["less than 1 %", "2 %", "100 %"]);
    }

    #[test]
    fn a_cause_names_its_remedy_as_data() {
        let kind = Some(reachtube_recordings::Torque::Motor);
        let clause = "the torques are of the kind `motor`".into();
        let cause = Cause::Reading { clause, kind, unexplained: 0.07, as_stated: 3.0 };
        let finding = cause.warning();
        let written = finding.written_for(FrontEnd::Python);
        assert!(written.contains("of the kind `motor`. So read, 7 % of"), "{written}");
        assert!(written.contains("and 100 % as stated. `torque=\"motor\"` reads"), "{written}");
    }

    #[test]
    fn what_was_applied_is_not_proposed_again() {
        let written = |cause: &Cause| cause.warning().to_string();
        let long = written(&Cause::Horizon { unexplained: 0.1, longest: 31.2 });
        assert!(
            long.contains("last up to 31.2 s") && long.contains("`--horizon 0.5` cuts"),
            "{long}"
        );
        let parameters = |is_identified, is_fitted| {
            let (unexplained, longest) = (0.1, 0.5);
            written(&Cause::Parameters { unexplained, is_identified, is_fitted, longest })
        };
        let first = parameters(false, false);
        assert!(first.contains("`reachtube identify`") && first.contains("`--fit`"), "{first}");
        let identified = parameters(true, false);
        assert!(!identified.contains("`reachtube identify`"), "{identified}");
        assert!(identified.ends_with("`--fit` names the parameters to fit."), "{identified}");
        let fitted = parameters(true, true);
        assert!(!fitted.contains("--fit") && fitted.contains("`--horizon 0.2`"), "{fitted}");
    }
}
