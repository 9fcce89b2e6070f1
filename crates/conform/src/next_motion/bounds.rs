//! Bounds of the probability that the next motion leaves a set.

/// Returns the one-sided Clopper-Pearson upper bound of a probability at confidence 1 - β after
/// `hits` in `trials`: the p at which that few hits have probability β.
pub(crate) fn clopper_pearson(trials: usize, hits: usize, beta: f64) -> f64 {
    if hits >= trials {
        return 1.0;
    }
    let tail = |p: f64| {
        (0..=hits)
            .map(|k| (ln_choose(trials, k) + power(p, k) + power(1.0 - p, trials - k)).exp())
            .sum()
    };
    bisect(|p| -> f64 { tail(p) }, beta, 0.0, 1.0)
}

/// Returns the wait-and-judge scenario bound ε(k) of Campi and Garatti (Mathematical Programming
/// 2018, Theorem 1): with confidence 1 - β, a convex program with `scenarios` scenarios of which
/// `support` are of support is violated by the next one with probability at most ε.
///
/// 1 - ε is the root in (0, 1) of β/(N+1) Σ_{m=k}^{N} C(m,k) t^{m-k} = C(N,k) t^{N-k}.
pub(crate) fn scenario_bound(scenarios: usize, support: usize, beta: f64) -> f64 {
    let (n, k) = (scenarios, support);
    if k >= n {
        return 1.0;
    }
    // The quotient of the two sides falls from infinity to below 1 as t grows to 1.
    let quotient = |t: f64| {
        let term = |m: usize| {
            (ln_choose(m, k) - ln_choose(n, k) + power(t, m - k) - power(t, n - k)).exp()
        };
        beta / (n as f64 + 1.0) * (k..=n).map(term).sum::<f64>()
    };
    1.0 - bisect(quotient, 1.0, 0.0, 1.0)
}

/// Returns k ln x, and 0 for k = 0.
fn power(x: f64, k: usize) -> f64 {
    if k == 0 { 0.0 } else { k as f64 * x.ln() }
}

fn ln_choose(n: usize, k: usize) -> f64 {
    (0..k).map(|i| ((n - i) as f64 / (k - i) as f64).ln()).sum()
}

/// Finds where the decreasing function `f` is `value`.
fn bisect(f: impl Fn(f64) -> f64, value: f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) > value { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_hit_the_hold_out_bound_is_in_closed_form() {
        for trials in [1, 10, 59, 300] {
            let exact = 1.0 - 0.05f64.powf(1.0 / trials as f64);
            assert!((clopper_pearson(trials, 0, 0.05) - exact).abs() < 1e-12);
        }
        assert_eq!(clopper_pearson(3, 3, 0.05), 1.0);
    }

    #[test]
    fn tabulated_hold_out_bounds() {
        // 1 of 10: 0.3942, 2 of 20: 0.2826 (one-sided 95 %, standard tables).
        assert!((clopper_pearson(10, 1, 0.05) - 0.3942).abs() < 5e-5);
        assert!((clopper_pearson(20, 2, 0.05) - 0.2826).abs() < 5e-5);
    }

    #[test]
    fn the_scenario_bound_solves_its_equation_and_grows_with_support() {
        let (n, beta) = (50, 0.05);
        let mut last = 0.0;
        for k in 0..n {
            let epsilon = scenario_bound(n, k, beta);
            assert!(epsilon > last && epsilon <= 1.0, "support {k}: {epsilon}");
            last = epsilon;
            let t = 1.0 - epsilon;
            let choose = |m: usize, k: usize| {
                (0..k).map(|i| (m - i) as f64 / (k - i) as f64).product::<f64>()
            };
            let left: f64 =
                (k..=n).map(|m| choose(m, k) * t.powi((m - k) as i32)).sum::<f64>() * beta / 51.0;
            let right = choose(n, k) * t.powi((n - k) as i32);
            assert!((left / right - 1.0).abs() < 1e-6, "support {k}");
        }
        assert_eq!(scenario_bound(2, 2, beta), 1.0);
    }

    #[test]
    fn the_hold_out_bound_covers_the_true_probability_about_as_often_as_it_says() {
        // Exact coverage, by summing the binomial over all outcomes.
        let (trials, p) = (30, 0.1f64);
        let covered: f64 = (0..=trials)
            .filter(|&k| clopper_pearson(trials, k, 0.05) >= p)
            .map(|k| (ln_choose(trials, k) + power(p, k) + power(1.0 - p, trials - k)).exp())
            .sum();
        assert!((0.95..0.99).contains(&covered), "{covered}");
    }
}
