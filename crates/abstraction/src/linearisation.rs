//! The derivatives of a polynomial model along its motion.

use nalgebra::DMatrix;
use reachtube_robot::JointKind;
use reachtube_scalar::{Lanes, Lanewise, MapWorkspace, PolynomialMap};

use crate::layout::Layout;
use crate::polynomial_model::PolynomialModel;

/// Several states at once.
type Many = Lanes<8>;

/// The derivatives A = ∂ẋ/∂x and B = ∂ẋ/∂u of a model with x = (q, q̇), at one state after another.
///
/// sin q and cos q count as functions of q, so their derivatives are part of A. The results are in
/// double precision, without directed rounding.
///
/// # Examples
///
/// ```
/// use reachtube_abstraction::{
///     ExpansionPoint, Linearisation, ModelKind, PolynomialModel, linear_model,
/// };
/// use reachtube_robot::Robot;
///
/// let (robot, rest) = (Robot::lwa4p(), ExpansionPoint::zero(6));
/// let cubic = PolynomialModel::new(&robot, ModelKind::One, 3, &rest)?;
/// let mut linearisation = Linearisation::new(&cubic);
/// let (a, b) = linearisation.at(&[0.0; 12], &[0.0; 6]);
/// let linear = linear_model(&robot, &rest)?;
/// assert!((a - linear.a()).amax() < 1e-12 && (b - linear.b()).amax() < 1e-12);
/// # Ok::<(), reachtube_abstraction::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Linearisation {
    layout: Layout,
    joint_kinds: Vec<JointKind>,
    origin: Vec<f64>,
    map: PolynomialMap,
    workspace: MapWorkspace<f64>,
    offsets: Vec<f64>,
    /// Derivatives ∂q̈/∂z, row-major joints x variables.
    slopes: Vec<f64>,
    a: DMatrix<f64>,
    b: DMatrix<f64>,
}

impl Linearisation {
    /// Prepares the derivatives of `model`.
    #[must_use]
    pub fn new(model: &PolynomialModel) -> Self {
        let (layout, n) = (model.layout(), model.joints());
        let map = PolynomialMap::new(layout.variables(), &model.derivatives().concat());
        let mut a = DMatrix::zeros(2 * n, 2 * n);
        a.view_mut((0, n), (n, n)).fill_with_identity();
        Self {
            layout,
            joint_kinds: model.joint_kinds().to_vec(),
            origin: model.origin().to_vec(),
            workspace: map.workspace(),
            map,
            offsets: vec![0.0; layout.variables()],
            slopes: vec![0.0; n * layout.variables()],
            a,
            b: DMatrix::zeros(2 * n, n),
        }
    }

    /// Returns A (2n x 2n) and B (2n x n) at the state `x` = (q, q̇) (2n, rad and rad/s, or m
    /// and m/s) under the input `u` (n, N m or N).
    pub fn at(&mut self, x: &[f64], u: &[f64]) -> (&DMatrix<f64>, &DMatrix<f64>) {
        let mut offsets = std::mem::take(&mut self.offsets);
        self.offsets(x, u, |variable, offset| offsets[variable] = offset);
        let mut slopes = std::mem::take(&mut self.slopes);
        self.map.evaluate_into(&offsets, &mut self.workspace, &mut slopes);
        self.set_matrices(x, |at| slopes[at]);
        (self.offsets, self.slopes) = (offsets, slopes);
        (&self.a, &self.b)
    }

    /// Shows A and B at many states to `visit`, one after the other, with their numbers from 0. The
    /// derivatives are evaluated at several states at once.
    ///
    /// `points` has the states (2n) and inputs (n), as [`at`](Self::at) takes them.
    pub(crate) fn along(
        &mut self,
        points: &[(&[f64], &[f64])],
        mut visit: impl FnMut(usize, &DMatrix<f64>, &DMatrix<f64>),
    ) {
        let mut offsets = vec![Many::from(0.0); self.offsets.len()];
        let mut slopes = vec![Many::from(0.0); self.slopes.len()];
        let mut workspace = self.map.workspace::<Many>();
        // The offsets of one point after another.
        let mut columns = vec![vec![0.0; offsets.len()]; Many::LANES];
        for (chunk, points) in points.chunks(Many::LANES).enumerate() {
            // The last lanes of the last chunk repeat its last point.
            for (lane, column) in columns.iter_mut().enumerate() {
                let (x, u) = points[lane.min(points.len() - 1)];
                self.offsets(x, u, |variable, offset| column[variable] = offset);
            }
            for (variable, offset) in offsets.iter_mut().enumerate() {
                *offset = Many::from_lanes(|lane| columns[lane][variable]);
            }
            self.map.evaluate_into(&offsets, &mut workspace, &mut slopes);
            for (lane, (x, _)) in points.iter().enumerate() {
                self.set_matrices(x, |at| slopes[at].lane(lane));
                visit(chunk * Many::LANES + lane, &self.a, &self.b);
            }
        }
    }

    /// Hands the offsets of all variables from the expansion point to `set`.
    fn offsets(&self, x: &[f64], u: &[f64], mut set: impl FnMut(usize, f64)) {
        let (layout, n) = (self.layout, self.layout.joints);
        let mut set = |variable: usize, value: f64| set(variable, value - self.origin[variable]);
        for i in 0..n {
            set(layout.velocity(i), x[n + i]);
            set(layout.input(i), u[i]);
            if layout.trigonometric {
                let (sine, cosine) = self.joint_kinds[i].sin_cos(&x[i]);
                set(layout.sine(i), sine);
                set(layout.cosine(i), cosine);
            }
        }
    }

    /// Sets A and B at the state `x` from the derivatives there, joints x variables.
    fn set_matrices(&mut self, x: &[f64], slope: impl Fn(usize) -> f64) {
        let (layout, n) = (self.layout, self.layout.joints);
        for i in 0..n {
            let slope = |variable: usize| slope(i * layout.variables() + variable);
            for (j, q) in x[..n].iter().enumerate() {
                if layout.trigonometric {
                    self.a[(n + i, j)] = match self.joint_kinds[j] {
                        JointKind::Revolute => {
                            slope(layout.sine(j)) * q.cos() - slope(layout.cosine(j)) * q.sin()
                        }
                        JointKind::Prismatic => slope(layout.sine(j)),
                    };
                }
                self.a[(n + i, n + j)] = slope(layout.velocity(j));
                self.b[(n + i, j)] = slope(layout.input(j));
            }
        }
    }
}
