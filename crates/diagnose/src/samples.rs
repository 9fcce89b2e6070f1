use std::ops::Range;

use reachtube_recordings::Run;

use crate::agreement::median;

/// A jump is at least this far beyond what the velocity explains, rad or m, ...
const LEAST_JUMP: f64 = 0.03;

/// ... and this many times as far as the joint moves from one sample to the next at most.
const JUMP: f64 = 5.0;

/// Most samples of one jump there and back.
const AWAY: usize = 50;

/// A jump back differs from the jump there by less than this part.
const RETURN: f64 = 0.2;

/// The motion after samples that repeat differs from what the velocity explains by less than this
/// part.
const HELD: f64 = 0.5;

/// A torque beyond this multiple of nearly all others of the joint is a wrong sample.
const HUGE: f64 = 10.0;

/// The part of the torques that is nearly all.
const NEARLY_ALL: f64 = 0.99;

/// Longest step that counts as one, in usual steps.
const ONE_STEP: f64 = 1.9;

/// Part of the samples that repeat the one before where a sensor is slower than the log.
const REPEATED: f64 = 0.3;

/// Positions below this may be zeros, rad or m.
const NEAR_ZERO: f64 = 0.02;

/// Samples that cannot be right.
#[derive(Debug, Clone, PartialEq)]
pub struct WrongSamples {
    /// The first of them, from 0; `None` if it is about all.
    pub sample: Option<usize>,
    /// The joint, from 0; `None` if it is about all.
    pub joint: Option<usize>,
    /// What is wrong, as the predicate of the joint or of the samples.
    pub text: String,
    /// Whether the samples are wrong for sure; else they are only few.
    pub is_certain: bool,
    /// The samples without which the others are right; empty if there are none such.
    pub rows: Vec<Range<usize>>,
}

/// Returns samples of a recording that cannot be right: rows of zeros, positions that jump, torques
/// far beyond all others, and samples that repeat the one before.
#[must_use]
pub fn wrong_samples(run: &Run) -> Vec<WrongSamples> {
    if run.len() < 16 {
        return Vec::new();
    }
    let mut found: Vec<WrongSamples> = zeros(run).into_iter().collect();
    // Positions jump to zeros and back.
    let zeros: Vec<Range<usize>> = found.iter().flat_map(|found| found.rows.clone()).collect();
    found.extend((0..run.joints).filter_map(|joint| jump(run, joint, &zeros)));
    found.extend((0..run.joints).filter_map(|joint| huge_torque(run, joint)));
    found.extend(repeated(run));
    found
}

/// Returns the first row of zeros beside a position that is none.
fn zeros(run: &Run) -> Option<WrongSamples> {
    let is_zero = |k: usize| run.state(k).iter().chain(run.torque(k)).all(|value| *value == 0.0);
    let is_away = |k: usize| k < run.len() && run.q(k).iter().any(|q| q.abs() > NEAR_ZERO);
    let is_dropped = |k: &usize| is_zero(*k) && (is_away(k.wrapping_sub(1)) || is_away(k + 1));
    let first = (0..run.len()).find(is_dropped)?;
    let zeros: Vec<usize> = (0..run.len()).filter(|k| is_zero(*k)).collect();
    let chunks = zeros.chunk_by(|a, b| a + 1 == *b).map(|chunk| chunk[0]..chunk[0] + chunk.len());
    // A robot may also rest at zero.
    let rows: Vec<Range<usize>> =
        chunks.filter(|rows| rows.clone().any(|k| is_dropped(&k))).collect();
    let text = match rows[0].len() {
        1 => "is a row of zeros".into(),
        count => format!("is the first of {count} rows of zeros"),
    };
    Some(WrongSamples { sample: Some(first), joint: None, text, is_certain: true, rows })
}

/// Returns what nearly all of some values do not exceed.
fn nearly_all(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted[((sorted.len() - 1) as f64 * NEARLY_ALL) as usize]
}

fn usual_step(run: &Run) -> f64 {
    median(run.times.windows(2).map(|pair| pair[1] - pair[0])).unwrap_or_default()
}

/// Returns the first jump of a joint's position that its velocity does not explain, and the number
/// of jumps. Jumps to and from rows of `zeros` are none.
fn jump(run: &Run, joint: usize, zeros: &[Range<usize>]) -> Option<WrongSamples> {
    let usual = usual_step(run);
    let step = |k: usize| run.times[k] - run.times[k - 1];
    let moved = |k: usize| run.q(k)[joint] - run.q(k - 1)[joint];
    // Velocities in a wrong unit explain no motion, and a few jumps are not the usual motion.
    // Velocities that are derived from positions jump with them.
    let usual_move = nearly_all((1..run.len()).map(|k| moved(k).abs()));
    let fastest = nearly_all((0..run.len()).map(|k| run.qd(k)[joint].abs()));
    let limit = LEAST_JUMP.max(JUMP * usual_move.max(fastest * usual));
    let speed = |k: usize| 0.5 * (run.qd(k)[joint] + run.qd(k - 1)[joint]);
    let beyond = |k: usize| moved(k) - step(k) * speed(k);
    // A velocity may be wrong where the position is not.
    let is_far = |k: usize| beyond(k).abs() > limit && moved(k).abs() > limit;
    let is_jump = |k: &usize| step(*k) < ONE_STEP * usual && is_far(*k);
    let is_of_zeros = |k: &usize| zeros.iter().any(|rows| (rows.start..=rows.end).contains(k));
    let jumps: Vec<usize> = (1..run.len()).filter(|k| is_jump(k) && !is_of_zeros(k)).collect();
    let first = *jumps.first()?;
    let is_back = |a: usize, b: usize| {
        b - a <= AWAY && (beyond(a) + beyond(b)).abs() < RETURN * beyond(a).abs()
    };
    // While samples repeat, the joint moves on as fast as before and after.
    let held = |k: usize| {
        let count =
            (1..k).take_while(|back| run.state(k - back) == run.state(k - back - 1)).count();
        let explained = speed(k) * (run.times[k] - run.times[k - 1 - count]);
        let is_held = (moved(k) - explained).abs() < HELD * moved(k).abs();
        (count > 0 && is_held).then_some(k - count..k)
    };
    let (mut rows, mut at) = (Vec::new(), 0);
    while let Some(&k) = jumps.get(at) {
        let back = jumps.get(at + 1).filter(|next| is_back(k, **next));
        let Some(wrong) = back.map(|next| k..*next).or_else(|| held(k)) else { break };
        at += if back.is_some() { 2 } else { 1 };
        rows.push(wrong);
    }
    let mut how = match rows.first() {
        Some(away) if away.start == first && away.len() == 1 => " in one sample and back".into(),
        Some(away) if away.start == first => format!(" for {} samples", away.len()),
        Some(held) => format!(" after {} samples that repeat the one before", held.len()),
        None => " in one sample".to_string(),
    };
    // What remains of the jumps is of unknown extent.
    let (places, is_whole) = (rows.len(), at == jumps.len());
    let more = if is_whole { places - 1 } else { jumps.len() - 1 };
    match more {
        0 => (),
        1 => how += ", and once more",
        _ => how += &format!(", and {more} times more"),
    }
    let text = format!(
        "jumps by {:.3}{how}, where its velocity explains {:.3}",
        moved(first),
        moved(first) - beyond(first)
    );
    let rows = if is_whole { rows } else { Vec::new() };
    Some(WrongSamples { sample: Some(first), joint: Some(joint), text, is_certain: true, rows })
}

/// Returns the first torque that is far beyond nearly all others.
fn huge_torque(run: &Run, joint: usize) -> Option<WrongSamples> {
    let sizes = || (0..run.len()).map(|k| run.torque(k)[joint].abs());
    let usual = nearly_all(sizes());
    let is_huge = |(k, size): (usize, f64)| (size > HUGE * usual).then_some(k..k + 1);
    let rows: Vec<Range<usize>> =
        sizes().enumerate().filter_map(is_huge).filter(|_| usual > 0.0).collect();
    let sample = rows.first()?.start;
    let text = format!(
        "has a torque of {:.1}, and below {usual:.1} in 99 % of the samples",
        run.torque(sample)[joint]
    );
    Some(WrongSamples { sample: Some(sample), joint: Some(joint), text, is_certain: true, rows })
}

/// Returns whether samples in motion repeat the one before, as if a sensor were slower than the
/// log.
fn repeated(run: &Run) -> Option<WrongSamples> {
    let is_moving = |k: &usize| {
        let [before, after] = [run.qd(k - 1), run.qd(*k)];
        before.iter().chain(after).any(|qd| *qd != 0.0)
    };
    let moving: Vec<usize> = (1..run.len()).filter(is_moving).collect();
    let count = |is_same: &dyn Fn(usize) -> bool| {
        moving.iter().filter(|k| is_same(**k)).count() as f64 / moving.len().max(1) as f64
    };
    let states = count(&|k| run.state(k) == run.state(k - 1));
    // The torques of one joint may be equal by their resolution.
    let torques = count(&|k| run.joints > 2 && run.torque(k) == run.torque(k - 1));
    let (part, what) =
        if states > REPEATED { (states, "positions and velocities") } else { (torques, "torques") };
    let text = format!(
        "repeat the {what} of the sample before in {:.0} % of the motion: the sensor is slower \
         than the log; record at {:.0} Hz",
        100.0 * part,
        (1.0 - part) / usual_step(run)
    );
    let rows = Vec::new();
    let found = WrongSamples { sample: None, joint: None, text, is_certain: false, rows };
    (part > REPEATED).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two joints that move at 100 Hz, whose samples `change` makes.
    fn found(change: impl Fn(usize, &mut [f64])) -> Vec<WrongSamples> {
        let rows = (0..500).map(|k| {
            let t = 0.01 * f64::from(k);
            let mut row = [
                1.0 + t.sin(),
                (2.0 * t).sin(),
                t.cos(),
                2.0 * (2.0 * t).cos(),
                30.0 * t.cos(),
                5.0,
            ];
            change(k as usize, &mut row);
            row
        });
        let rows: Vec<[f64; 6]> = rows.collect();
        let times = (0..500).map(|k| 0.01 * f64::from(k)).collect();
        let states = rows.iter().flat_map(|row| row[..4].to_vec()).collect();
        let torques = rows.iter().flat_map(|row| row[4..].to_vec()).collect();
        wrong_samples(&Run::new(2, times, states, torques).unwrap())
    }

    #[test]
    fn samples_that_are_right_are_not_named() {
        assert_eq!(found(|_, _| ()), []);
        // Velocities in degrees per second explain no motion.
        assert_eq!(found(|_, row| row[2..4].iter_mut().for_each(|qd| *qd *= 57.3)), []);
        let round =
            |row: &mut [f64]| row.iter_mut().for_each(|x| *x = (*x * 200.0).round() / 200.0);
        assert_eq!(found(|_, row| round(row)), []);
    }

    #[test]
    fn wrong_samples_are_named_with_their_place() {
        let zeros = &found(|k, row| {
            if k == 250 {
                row.fill(0.0)
            }
        })[0];
        assert_eq!((zeros.sample, &*zeros.text), (Some(250), "is a row of zeros"));
        let zeros = &found(|k, row| {
            if (100..110).contains(&k) {
                row.fill(0.0)
            }
        })[0];
        assert_eq!(&*zeros.text, "is the first of 10 rows of zeros");
        let jump = &found(|k, row| {
            if k == 300 {
                row[1] += 0.5
            }
        })[0];
        assert_eq!((jump.sample, jump.joint), (Some(300), Some(1)));
        assert!(jump.text.contains("in one sample and back"), "{jump:?}");
        let step = &found(|k, row| {
            if k >= 300 {
                row[0] -= 0.3
            }
        })[0];
        assert!(step.text.starts_with("jumps by -0.3") && step.text.contains("in one sample,"));
        let torque = &found(|k, row| {
            if k == 7 {
                row[4] = -4000.0
            }
        })[0];
        assert!(torque.sample == Some(7) && torque.text.contains("-4000.0"), "{torque:?}");
    }

    #[test]
    fn a_few_wrong_samples_have_their_rows_and_a_step_has_none() {
        let rows = |change: &dyn Fn(usize, &mut [f64])| found(change).remove(0).rows;
        let spikes = |k: usize, row: &mut [f64]| {
            row[1] +=
                if k == 100 { 0.4 } else { 0.0 } - if (200..203).contains(&k) { 0.7 } else { 0.0 };
        };
        assert_eq!(rows(&spikes), [100..101, 200..203]);
        let text = &found(spikes)[0].text;
        assert!(text.contains("in one sample and back, and once more"), "{text}");
        assert_eq!(rows(&|k, row| row[0] += if k < 300 { 0.0 } else { 0.5 }), []);
        let zeros = |k: usize, row: &mut [f64]| {
            if k == 0 || (40..42).contains(&k) {
                row.fill(0.0);
            }
        };
        assert_eq!(rows(&zeros), [0..1, 40..42]);
        let both = found(|k, row| {
            row[1] += if k == 100 { 0.4 } else { 0.0 };
            zeros(k, row);
        });
        assert_eq!((both.len(), &both[1].rows[..]), (2, std::slice::from_ref(&(100..101))));
        let torque = |k: usize, row: &mut [f64]| row[4] *= if k % 200 == 9 { 1e3 } else { 1.0 };
        assert_eq!(rows(&torque), [9..10, 209..210, 409..410]);
        // A spike shows in velocities that were derived from the positions.
        let derived = |k: usize, row: &mut [f64]| match k {
            99 => row[2] += 25.0,
            100 => row[0] += 0.5,
            101 => row[2] -= 25.0,
            _ => (),
        };
        assert_eq!(rows(&derived), std::slice::from_ref(&(100..101)));
    }

    #[test]
    fn samples_that_stand_still_in_motion_have_their_rows() {
        let still = |k: usize, row: &mut [f64]| {
            if (160..180).contains(&k) {
                let t = 1.59f64;
                row[..4].copy_from_slice(&[
                    1.0 + t.sin(),
                    (2.0 * t).sin(),
                    t.cos(),
                    2.0 * (2.0 * t).cos(),
                ]);
            }
        };
        let found = &found(still)[0];
        assert_eq!((found.joint, &found.rows[..]), (Some(1), std::slice::from_ref(&(160..180))));
        assert!(found.text.contains("after 20 samples that repeat the one before"), "{found:?}");
    }

    #[test]
    fn samples_that_repeat_are_named_with_the_rate_of_the_sensor() {
        for held in [2, 5] {
            let found = found(|k, row| {
                let t = 0.01 * (k - k % held) as f64;
                row[..4].copy_from_slice(&[
                    1.0 + t.sin(),
                    (2.0 * t).sin(),
                    t.cos(),
                    2.0 * (2.0 * t).cos(),
                ]);
            });
            assert_eq!(found.len(), 1, "{found:?}");
            assert!(found[0].text.contains(&format!("record at {} Hz", 100 / held)), "{found:?}");
        }
    }
}
