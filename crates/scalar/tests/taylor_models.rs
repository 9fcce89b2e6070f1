//! Every operation of a Taylor model encloses the true function over its box, and not by much more.

use reachtube_scalar::{Elementary, Interval, Scalar, TaylorBox, TaylorModel, TaylorSpace};

/// A function that can be evaluated over any number.
trait Function {
    const NAME: &'static str;
    fn at<S: Elementary>(x: &[S]) -> S;
}

macro_rules! functions {
    ($($Name:ident |$x:ident| $value:expr;)*) => {
        $(
            struct $Name;
            impl Function for $Name {
                const NAME: &'static str = stringify!($Name);
                fn at<S: Elementary>($x: &[S]) -> S {
                    $value
                }
            }
        )*
        /// Calls a generic check with every function.
        macro_rules! for_all_functions {
            ($check:ident($arguments:expr)) => { $($check::<$Name>($arguments);)* };
        }
    };
}

fn sum_of<S: Scalar>(x: &[S]) -> S {
    x.iter().enumerate().fold(S::from(0.25), |sum, (i, x)| sum + x.clone() * S::from(0.5 - 0.2 * i as f64))
}

/// Positive over the box: 2 + small linear and quadratic parts.
fn positive<S: Scalar>(x: &[S]) -> S {
    S::from(2.0) + x[0].clone() * x[1].clone() * S::from(0.3) - sum_of(x) * S::from(0.2)
}

functions! {
    Sum |x| sum_of(x) + x[1].clone() * x[1].clone();
    Difference |x| x[0].clone() * x[1].clone() - sum_of(x);
    Product |x| positive(x) * sum_of(x) * x[2].clone();
    Cube |x| { let s = sum_of(x); s.clone() * s.clone() * s };
    Power |x| { let s = positive(x); let q = s.clone() * s; q.clone() * q.clone() * q };
    Quotient |x| sum_of(x) / positive(x);
    QuotientByNumber |x| (sum_of(x) * x[0].clone() + x[2].clone()) / S::from(3.0);
    Reciprocal |x| S::one() / positive(x);
    Root |x| positive(x).sqrt();
    Exponential |x| (x[0].clone() * x[1].clone() + sum_of(x)).exp();
    Logarithm |x| positive(x).ln();
    Sine |x| (positive(x) * x[0].clone()).sin_cos().0;
    Cosine |x| (positive(x) + x[2].clone() * x[2].clone()).sin_cos().1;
    Angle |x| sum_of(x).atan2(&positive(x));
    AngleBehind |x| positive(x).atan2(&(sum_of(x) - S::from(1.5)));
}

fn sides(half: f64) -> [Interval; 3] {
    [0.3, -0.6, 0.9].map(|mid| Interval::centered(mid, half))
}

/// Points of a box: a van der Corput sequence a variable, and its corners.
fn points(sides: &[Interval], count: u32) -> Vec<Vec<f64>> {
    let radical = |n: u32, base: u32| {
        let (mut n, mut value, mut unit) = (n, 0.0, 1.0);
        while n > 0 {
            unit /= f64::from(base);
            value += unit * f64::from(n % base);
            n /= base;
        }
        value
    };
    let inside =
        |side: &Interval, s: f64| (side.lo() + s * (side.hi() - side.lo())).clamp(side.lo(), side.hi());
    let corners = (0..1u32 << sides.len()).map(|bits| {
        sides
            .iter()
            .enumerate()
            .map(|(i, side)| if bits >> i & 1 == 0 { side.lo() } else { side.hi() })
            .collect()
    });
    let base = [2, 3, 5, 7, 11];
    let sequence = (1..count)
        .map(|n| sides.iter().zip(base).map(|(side, base)| inside(side, radical(n, base))).collect());
    corners.chain(sequence).collect()
}

/// The model of F, and the largest distance of the true values from its polynomial.
fn checked<F: Function>(order: u32, half: f64, count: u32) -> (TaylorModel, f64) {
    let sides = sides(half);
    let domain = TaylorBox::new(&TaylorSpace::new(3, order).unwrap(), &sides);
    let model = F::at(&domain.variables());
    let polynomial_alone = model.clone() - TaylorModel::from(model.remainder());
    let middle = |x: Interval| x.mid();
    let mut largest = 0.0f64;
    for at in points(&sides, count) {
        let at: Vec<Interval> = at.into_iter().map(Interval::point).collect();
        let truth = F::at(&at);
        // Both sides have rounding errors and are enclosed: the true value and the model's set must have a point in common, and the
        // model's set may be left by no more than these errors.
        let enclosed = domain.evaluate(&model, &at);
        let slack = truth.width() + 1e-14;
        assert!(
            Interval::new(enclosed.lo() - slack, enclosed.hi() + slack).unwrap().encloses(&truth)
                && enclosed.intersection(truth).is_some(),
            "{} at {at:?}: {truth:?} is not in {enclosed:?}",
            F::NAME
        );
        assert!(
            model.range().intersection(truth).is_some(),
            "{} at {at:?}: {truth:?} is not in the range",
            F::NAME
        );
        let polynomial = middle(domain.evaluate(&polynomial_alone, &at));
        largest = largest.max((truth.mid() - polynomial).abs());
    }
    (model, largest)
}

fn encloses_samples<F: Function>((order, half): (u32, f64)) {
    checked::<F>(order, half, 10_000);
}

#[test]
fn all_operations_enclose_the_truth() {
    for_all_functions!(encloses_samples((3, 0.2)));
}
