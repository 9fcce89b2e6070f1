//! Limits of choices: the ranges of their numbers, and what compensated torques exclude.

use reachtube_recordings::Torque;

use crate::choices::Choices;
use crate::error::{Error, Result};

/// The largest radius of a set.
pub(crate) const LARGEST_RADIUS: f64 = 1e9;

impl Choices {
    /// Checks choices for a robot with a number of joints and a kind of torques.
    ///
    /// # Errors
    ///
    /// [`Error::Choice`] for the first value that a choice cannot have.
    pub(crate) fn check(&self, joints: usize, torque: Torque) -> Result<()> {
        self.check_numbers()?;
        self.check_lists(joints)?;
        self.check_torque(torque)
    }

    /// Checks the numbers, whose ranges the options of a front end already check.
    fn check_numbers(&self) -> Result<()> {
        let above = "a finite number above 0";
        let single = [
            ("horizon", self.horizon, above),
            ("cut-off", self.cut_off, above),
            ("largest-ratio", self.largest_ratio, "a number above 0"),
            ("largest-growth", self.largest_growth, "a number of 1 or more"),
            ("largest-outside", self.largest_outside, "a part of the rows, from 0 to 1"),
            ("pull", self.pull, "a weight from 0 to 1"),
        ];
        let is_wrong = |key: &str, value: f64| match key {
            "largest-ratio" => value.is_nan() || value <= 0.0,
            "largest-growth" => value.is_nan() || value < 1.0,
            "largest-outside" | "pull" => !(0.0..=1.0).contains(&value),
            _ => !(value.is_finite() && value > 0.0),
        };
        let wrong = single.into_iter().find_map(|(key, value, needed)| {
            value.filter(|value| is_wrong(key, *value)).map(|value| (key, value, needed))
        });
        match wrong {
            None => Ok(()),
            Some((key, value, needed)) => {
                Err(Error::Choice { key, value: value.to_string(), needed })
            }
        }
    }

    /// Checks the lists: their lengths and the ranges of their numbers.
    fn check_lists(&self, joints: usize) -> Result<()> {
        let is_radius = |value: &f64| (0.0..=LARGEST_RADIUS).contains(value);
        let radii =
            |values: &[f64], count: usize| values.len() == count && values.iter().all(is_radius);
        let point = |values: &[f64], _: usize| {
            let counts = [joints, 2 * joints, 3 * joints];
            counts.contains(&values.len()) && values.iter().all(|value| value.is_finite())
        };
        let rates = |values: &[f64], count: usize| {
            let is_rate = |rate: &f64| (1e-9..=LARGEST_RADIUS).contains(rate);
            values.is_empty() || values.len() == count && values.iter().all(is_rate)
        };
        // Without an allowance, the file of choices has an empty list.
        let allowance = |values: &[f64], count: usize| values.is_empty() || radii(values, count);
        type Check<'a> = &'a dyn Fn(&[f64], usize) -> bool;
        let lists: [(_, _, Check, _, _); 4] = [
            ("expansion", &self.expansion, &point, joints, "one position per joint, in rad or m"),
            (
                "sensor-noise",
                &self.sensor_noise,
                &radii,
                2 * joints,
                "2 radii per joint, from 0 to 1e9: first for all q, then for all qd",
            ),
            (
                "input-doubling",
                &self.input_doubling,
                &rates,
                joints,
                "one acceleration per joint, from 1e-9 to 1e9 rad/s² or m/s², or []",
            ),
            (
                "allowance",
                &self.allowance,
                &allowance,
                3 * joints,
                "3 radii per joint, from 0 to 1e9: X0 for all q, X0 for all qd, then U",
            ),
        ];
        for (key, values, is_right, count, needed) in lists {
            if let Some(values) = values.as_ref().filter(|values| !is_right(values, count)) {
                return Err(Error::Choice { key, value: format!("{values:?}"), needed });
            }
        }
        Ok(())
    }

    /// Refuses an identification from compensated torques, and a filter of them.
    fn check_torque(&self, torque: Torque) -> Result<()> {
        if torque != Torque::Compensated {
            return Ok(());
        }
        if self.identify == Some(true) {
            let needed = "false, or recordings of motor torques: compensated ones are the input \
                          of the robot as described";
            return Err(Error::Choice { key: "identify", value: "true".into(), needed });
        }
        self.cut_off.map_or(Ok(()), |cut_off| {
            let needed = "none with compensated torques, which no low-pass changes";
            Err(Error::Choice { key: "cut-off", value: cut_off.to_string(), needed })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Asserts that the text is refused with these words.
    fn refused(text: &str, torque: Torque, expected: &str) {
        let error = Choices::from_toml(text).unwrap().check(2, torque).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{text}: {error}");
    }

    fn accepted(text: &str, torque: Torque) {
        Choices::from_toml(text).unwrap().check(2, torque).unwrap();
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        for (text, expected) in [
            ("horizon = -1.0", "horizon = -1; give a finite number above 0"),
            ("cut-off = nan", "cut-off = NaN"),
            ("largest-outside = 5.0", "largest-outside = 5; give a part"),
            ("allowance = [0.1]", "allowance = [0.1]; give 3 radii per joint"),
            ("sensor-noise = [1, 1, 1, -1]", "sensor-noise = [1.0, 1.0, 1.0, -1.0]; give 2 radii"),
            ("expansion = [0.0]", "expansion = [0.0]; give one position per joint"),
        ] {
            refused(text, Torque::Motor, expected);
        }
        accepted("horizon = 0.3\nlargest-growth = inf\npull = 0.0", Torque::Motor);
        accepted("expansion = [0.1, -1]\nallowance = [0, 0, 0, 0, 1, 1]", Torque::Motor);
    }

    #[test]
    fn compensated_torques_are_neither_identified_from_nor_filtered() {
        for (text, expected) in [
            ("identify = true", "identify = true; give false, or recordings of motor torques"),
            ("cut-off = 5.0", "cut-off = 5; give none with compensated torques"),
        ] {
            refused(text, Torque::Compensated, expected);
            accepted(text, Torque::Motor);
        }
        accepted("identify = false", Torque::Compensated);
    }
}
