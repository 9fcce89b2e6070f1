use std::ops::Range;

use crate::recording::TrackedRun;

/// A command rests where no joint is faster than this part of the highest speed of the recording.
const REST_SPEED: f64 = 0.1;

/// A rest of this length divides motions, s.
const REST: f64 = 0.3;

/// Samples of one motion: from the middle of one rest to the middle of the next.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MotionRows {
    /// Index of the recording.
    pub recording: usize,
    pub rows: Range<usize>,
    /// The recording's name, with a number if it has several motions.
    pub name: String,
}

/// Cuts recordings at rests of the command. Each sample belongs to one motion.
pub(crate) fn motions(recordings: &[TrackedRun]) -> Vec<MotionRows> {
    let mut all = Vec::new();
    for (index, recording) in recordings.iter().enumerate() {
        let mut ends = vec![0];
        ends.extend(middles_of_rests(recording));
        ends.push(recording.times.len());
        let name = recording.name();
        all.extend(ends.windows(2).enumerate().map(|(number, pair)| MotionRows {
            recording: index,
            rows: pair[0]..pair[1],
            name: if ends.len() > 2 { format!("{name}:{}", number + 1) } else { name.clone() },
        }));
    }
    all
}

/// Returns the samples in the middle of each rest between motions.
fn middles_of_rests(recording: &TrackedRun) -> Vec<usize> {
    let (times, samples) = (&recording.times, recording.times.len());
    let speeds: Vec<f64> = (0..samples).map(|k| recording.speed(k)).collect();
    let fastest = speeds.iter().copied().fold(0.0, f64::max);
    let is_still = |k: &usize| speeds[*k] <= REST_SPEED * fastest;
    let (mut middles, mut k) = (Vec::new(), 0);
    while k < samples {
        let end = (k..samples).find(|k| !is_still(k)).unwrap_or(samples);
        if k > 0 && end < samples && times[end] - times[k - 1] >= REST && end > k {
            middles.push(k.midpoint(end));
        }
        k = end + 1;
    }
    middles
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two motions with a rest of `rest` seconds between them, and rests before and after.
    fn recording(rest: f64) -> TrackedRun {
        let times: Vec<f64> = (0..600).map(|k| 0.01 * f64::from(k)).collect();
        let moved = |t: f64| (t.clamp(0.0, 1.0) * std::f64::consts::PI).cos();
        let command = times.iter().map(|t| moved(t - 0.5) - moved(t - 1.5 - rest)).collect();
        let actual = vec![0.0; 600];
        let (file, joints, sha256) = ("a/two.csv".into(), vec!["a".into()], String::new());
        TrackedRun { file, joints, units: vec!["rad"], times, command, actual, sha256 }
    }

    #[test]
    fn a_rest_between_motions_divides_them() {
        let found = motions(&[recording(1.0)]);
        let names: Vec<&str> = found.iter().map(|motion| motion.name.as_str()).collect();
        assert_eq!(names, ["two:1", "two:2"]);
        assert!((190..=210).contains(&found[0].rows.end), "{found:?}");
        assert_eq!((found[1].rows.start, found[1].rows.end), (found[0].rows.end, 600));
        assert_eq!(motions(&[recording(0.1)]).len(), 1);
    }
}
