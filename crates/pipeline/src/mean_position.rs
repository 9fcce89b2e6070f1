use reachtube_identify::prepare::RawLog;

/// Returns the mean position of recordings, n, rounded to 0.01.
pub(crate) fn mean_position(logs: &[&RawLog]) -> Vec<f64> {
    let n = logs.first().map_or(0, |log| log.run.joints);
    let samples: usize = logs.iter().map(|log| log.run.len()).sum();
    let sum = |joint: usize| -> f64 {
        logs.iter().map(|log| (0..log.run.len()).map(|k| log.run.q(k)[joint]).sum::<f64>()).sum()
    };
    let mean = |joint: usize| sum(joint) / samples.max(1) as f64;
    // Adding 0 turns -0 into 0.
    (0..n).map(|joint| (100.0 * mean(joint)).round() / 100.0 + 0.0).collect()
}
