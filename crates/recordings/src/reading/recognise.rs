//! Recognition of units from the numbers of a log: positions that follow the integral of the
//! velocity, the joints' limits, and the time between samples.

use std::f64::consts::PI;

use super::unit::{AngleUnit, TimeUnit};
use crate::unwrap::is_wrap;

/// Relative deviation up to which a ratio shows its units; the nearest two are a factor of 3 apart.
const TOLERANCE: f64 = 0.3;

/// Correlation of the motion and the integral of the velocity above which their ratio counts.
const CORRELATION: f64 = 0.9;

/// Times between samples that robots have, s.
const STEPS: [f64; 2] = [1e-4, 0.25];

/// Times since 1970 that logs have, s: from 2001 to 2096.
const SINCE_1970: [f64; 2] = [1e9, 4e9];

/// Multiple of a limit up to which a position fits it, and beyond which it cannot.
const FITS: f64 = 1.5;
const BEYOND: f64 = 5.0;

/// The numbers of a log in the units in which it has them, K samples of n joints.
pub(super) struct Numbers<'a> {
    /// Times since the first sample.
    pub times: &'a [f64],
    /// Time of the first sample.
    pub first: f64,
    /// Positions, a column for each joint.
    pub q: &'a [Vec<f64>],
    /// Velocities, likewise.
    pub qd: Option<&'a [Vec<f64>]>,
    /// Whether each joint is revolute.
    pub revolute: &'a [bool],
    /// Largest magnitude of each joint's position, rad, where the robot limits it.
    pub limits: &'a [Option<f64>],
    /// Highest speed of each joint, rad/s, where the robot limits it.
    pub speeds: &'a [Option<f64>],
}

/// The units of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Units {
    pub time: TimeUnit,
    pub q: AngleUnit,
    pub qd: AngleUnit,
    /// Motion per integral of the velocity in these units, where it was recognised.
    pub ratio: Option<f64>,
    /// The ratio in these units where it does not fit any that are possible.
    pub contradiction: Option<f64>,
}

/// Recognises the units. `time` and `angle` are the units that names or settings give.
///
/// # Errors
///
/// A sentence about the ambiguity, and the setting that decides it.
pub(super) fn recognise(
    numbers: &Numbers,
    time: Option<TimeUnit>,
    angle: Option<AngleUnit>,
) -> Result<Units, [String; 2]> {
    let times = time.map_or(TimeUnit::ALL.to_vec(), |unit| vec![unit]);
    let ratios = ratios(numbers);
    let candidates = times.iter().flat_map(|&time| {
        let pairs = AngleUnit::ALL.into_iter().flat_map(|q| AngleUnit::ALL.map(|qd| (q, qd)));
        pairs.map(move |(q, qd)| (time, q, qd))
    });
    let expected = |(time, q, qd): &(TimeUnit, AngleUnit, AngleUnit)| {
        q.per_radian() / qd.per_radian() / time.per_second() as f64
    };
    let agreeing: Vec<_> = candidates
        .filter(|candidate| {
            let expected = expected(candidate);
            let near = ratios.iter().filter(|ratio| (*ratio / expected - 1.0).abs() < TOLERANCE);
            2 * near.count() > ratios.len()
        })
        .collect();
    let middle = middle(ratios);
    let Some(&(unit, q, qd)) = agreeing.first() else {
        let time = match times[..] {
            [unit] => unit,
            _ => match since_1970(numbers.first) {
                Some(unit) => unit,
                None => time_of_step(numbers.times)?,
            },
        };
        let q = angle.map_or_else(|| by_limits(numbers), Ok)?;
        let contradiction = middle.map(|ratio| ratio / expected(&(time, q, q)));
        return Ok(Units { time, q, qd: q, ratio: None, contradiction });
    };
    let ratio = middle.map(|ratio| ratio / expected(&(unit, q, qd)));
    let units = |q, qd| Units { time: unit, q, qd, ratio, contradiction: None };
    if q != qd {
        return Ok(units(q, qd));
    }
    let both = angle.map_or_else(|| by_limits(numbers), Ok)?;
    Ok(units(both, both))
}

/// Returns the unit of a time that counts from 1970.
fn since_1970(first: f64) -> Option<TimeUnit> {
    let fits = |unit: &TimeUnit| {
        let seconds = first / unit.per_second() as f64;
        (SINCE_1970[0]..SINCE_1970[1]).contains(&seconds)
    };
    TimeUnit::ALL.into_iter().find(fits)
}

/// Returns the unit in which the usual time between samples is one that robots have.
fn time_of_step(times: &[f64]) -> Result<TimeUnit, [String; 2]> {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    let Some(&usual) = steps.get(steps.len() / 2) else { return Ok(TimeUnit::Seconds) };
    let fits = |unit: &TimeUnit| {
        (STEPS[0]..=STEPS[1]).contains(&(usual / unit.per_second() as f64 * (1.0 + 1e-9)))
    };
    let fitting: Vec<TimeUnit> = TimeUnit::ALL.into_iter().filter(fits).collect();
    match fitting[..] {
        [unit] => Ok(unit),
        // Seconds that no robot has are the user's own: a slow recording by hand.
        [] if usual > STEPS[1] && usual < 100.0 => Ok(TimeUnit::Seconds),
        _ => Err([
            format!("the unit of the time is ambiguous: samples are {usual} apart"),
            "give columns.time_unit = \"s\", \"ms\", \"us\" or \"ns\", or record the velocity"
                .into(),
        ]),
    }
}

/// Returns the unit in which positions, or else velocities, fit the limits of their joints.
fn by_limits(numbers: &Numbers) -> Result<AngleUnit, [String; 2]> {
    let revolute = || (0..numbers.q.len()).filter(|joint| numbers.revolute[*joint]);
    let turns = vec![Some(2.0 * PI); numbers.q.len()];
    let has_limits = revolute().any(|joint| numbers.limits[joint].is_some());
    let limits = if has_limits { numbers.limits } else { &turns };
    let of = |values: &[Vec<f64>], limits: &[Option<f64>]| {
        let share = |joint: usize| {
            let most = values[joint].iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            limits[joint].filter(|limit| *limit > 0.0).map(|limit| [most / limit, most, limit])
        };
        revolute().filter_map(share).max_by(|a, b| a[0].total_cmp(&b[0]))
    };
    let Some([share, furthest, limit]) = of(numbers.q, limits) else {
        return Ok(AngleUnit::Radians);
    };
    if let Some(unit) = unit_of_share(share) {
        return Ok(unit);
    }
    let fastest = numbers.qd.and_then(|qd| of(qd, numbers.speeds));
    fastest.and_then(|[share, ..]| unit_of_share(share)).ok_or_else(|| {
        [
            format!(
                "the unit of the positions is ambiguous: they reach {furthest:.3}, where the limit \
                 is {limit:.3} rad"
            ),
            "give columns.angle = \"rad\" or \"deg\"".into(),
        ]
    })
}

/// Returns the unit of values whose largest is this multiple of its limit in radians; `None` if it
/// may be either.
fn unit_of_share(share: f64) -> Option<AngleUnit> {
    let degrees = share / AngleUnit::Degrees.per_radian();
    if share > BEYOND && degrees <= FITS {
        Some(AngleUnit::Degrees)
    } else if share <= FITS || degrees > FITS {
        // The check of the limits names joints that are far beyond them in any unit.
        Some(AngleUnit::Radians)
    } else {
        None
    }
}

/// Returns the ratio of motion and integral of the velocity of each revolute joint of which one
/// follows the other.
fn ratios(numbers: &Numbers) -> Vec<f64> {
    let Some(qd) = numbers.qd else { return Vec::new() };
    let revolute = (0..numbers.q.len()).filter(|joint| numbers.revolute[*joint]);
    revolute.filter_map(|i| ratio(numbers.times, &numbers.q[i], &qd[i])).collect()
}

/// Returns the least-squares slope of q over the integral of qd; `None` if one does not follow the
/// other. Steps over whole turns are left out.
fn ratio(times: &[f64], q: &[f64], qd: &[f64]) -> Option<f64> {
    let (mut moved, mut integral) = (0.0, 0.0);
    let (mut motions, mut integrals) = (vec![0.0], vec![0.0]);
    for k in 1..times.len() {
        let step = q[k] - q[k - 1];
        moved += if is_wrap(q, k, 2.0 * PI) || is_wrap(q, k, 360.0) { 0.0 } else { step };
        integral += 0.5 * (times[k] - times[k - 1]) * (qd[k] + qd[k - 1]);
        motions.push(moved);
        integrals.push(integral);
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (a, b) = (mean(&motions), mean(&integrals));
    let pairs = motions.iter().zip(&integrals).map(|(x, y)| (x - a, y - b));
    let sums =
        |(xx, yy, xy): (f64, f64, f64), (x, y): (f64, f64)| (xx + x * x, yy + y * y, xy + x * y);
    let (xx, yy, xy) = pairs.fold((0.0, 0.0, 0.0), sums);
    let range = motions.iter().fold(0.0, |most: f64, value| most.max((value - a).abs()));
    (range > 0.01 && xy / (xx * yy).sqrt() > CORRELATION).then(|| xy / yy)
}

fn middle(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Recognises the units of a joint that swings by 1 rad, written in other units.
    fn found(
        time: f64,
        angles: [f64; 2],
        amplitude: f64,
        with_velocity: bool,
        [limit, speed]: [Option<f64>; 2],
    ) -> Result<Units, [String; 2]> {
        let seconds: Vec<f64> = (0..400).map(|k| 0.01 * k as f64).collect();
        let q = seconds.iter().map(|t| amplitude * t.sin() * angles[0]).collect::<Vec<_>>();
        let qd = seconds.iter().map(|t| amplitude * t.cos() * angles[1]).collect::<Vec<_>>();
        let times: Vec<f64> = seconds.iter().map(|t| t * time).collect();
        let (q, qd) = ([q], [qd]);
        let numbers = Numbers {
            times: &times,
            first: 0.0,
            q: &q,
            qd: with_velocity.then_some(&qd[..]),
            revolute: &[true],
            limits: &[limit],
            speeds: &[speed],
        };
        recognise(&numbers, None, None)
    }

    const DEG: f64 = 180.0 / PI;

    #[test]
    fn units_are_recognised_from_the_velocity_and_the_limits() {
        use AngleUnit::{Degrees, Radians};
        for time in TimeUnit::ALL {
            let per_second = time.per_second() as f64;
            let angles = [(Radians, 1.0), (Degrees, DEG)];
            for (q, a) in angles {
                for (qd, b) in angles {
                    let units = found(per_second, [a, b], 1.0, true, [Some(3.1), None]).unwrap();
                    assert_eq!((units.time, units.q, units.qd), (time, q, qd));
                    assert!((units.ratio.unwrap() - 1.0).abs() < 1e-3);
                }
            }
        }
        let without = found(1e3, [DEG, DEG], 1.0, false, [None; 2]).unwrap();
        assert_eq!((without.time, without.q), (TimeUnit::Milliseconds, Degrees));
    }

    #[test]
    fn what_may_mean_two_things_is_refused() {
        // 10 degrees, or 10 rad beyond a limit of 3.1 rad.
        let [problem, remedy] = found(1.0, [DEG, DEG], 0.17, true, [Some(3.1), None]).unwrap_err();
        assert!(problem.contains("9.7") && remedy.contains("columns.angle"), "{problem}");
        let fast = found(1.0, [DEG, DEG], 0.17, true, [Some(3.1), Some(1.5)]).unwrap();
        assert_eq!(fast.q, AngleUnit::Degrees);
        // 0.2 s or 0.2 ms between samples.
        let [problem, remedy] = found(20.0, [1.0; 2], 1.0, false, [None; 2]).unwrap_err();
        assert!(problem.contains("0.2") && remedy.contains("columns.time_unit"), "{problem}");
    }

    #[test]
    fn times_since_1970_show_their_unit() {
        assert_eq!(since_1970(1.7e18), Some(TimeUnit::Nanoseconds));
        assert_eq!(since_1970(1.7e12), Some(TimeUnit::Milliseconds));
        assert_eq!(since_1970(12.0), None);
    }
}
