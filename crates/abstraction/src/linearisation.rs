//! The derivatives of a polynomial model along its motion.

use nalgebra::DMatrix;
use reachtube_robot::JointKind;
use reachtube_scalar::{MapWorkspace, PolynomialMap};

use crate::layout::Layout;
use crate::polynomial_model::PolynomialModel;

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
        let (layout, n) = (self.layout, self.layout.joints);
        for i in 0..n {
            self.offsets[layout.velocity(i)] = x[n + i];
            self.offsets[layout.input(i)] = u[i];
            if layout.trigonometric {
                (self.offsets[layout.sine(i)], self.offsets[layout.cosine(i)]) =
                    self.joint_kinds[i].sin_cos(&x[i]);
            }
        }
        self.offsets.iter_mut().zip(&self.origin).for_each(|(offset, origin)| *offset -= origin);
        self.map.evaluate_into(&self.offsets, &mut self.workspace, &mut self.slopes);
        for (i, slopes) in self.slopes.chunks_exact(layout.variables()).enumerate() {
            for (j, q) in x[..n].iter().enumerate() {
                if layout.trigonometric {
                    self.a[(n + i, j)] = match self.joint_kinds[j] {
                        JointKind::Revolute => {
                            slopes[layout.sine(j)] * q.cos() - slopes[layout.cosine(j)] * q.sin()
                        }
                        JointKind::Prismatic => slopes[layout.sine(j)],
                    };
                }
                self.a[(n + i, n + j)] = slopes[layout.velocity(j)];
                self.b[(n + i, j)] = slopes[layout.input(j)];
            }
        }
        (&self.a, &self.b)
    }
}
