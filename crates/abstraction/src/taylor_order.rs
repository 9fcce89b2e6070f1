//! The order of the Taylor models that bound a model's error.

use crate::model_kind::ModelKind;
use crate::polynomial_model::PolynomialModel;

/// Order for models 1 and 2, whose error begins at the first order of q, and lowest order: a
/// shorter series of M_m⁻¹ would need many more parts.
const LOW_ORDER: u32 = 5;
/// Number of orders above the order of model 3. The first is its error, which must be exact; the
/// others make the rest small.
const HIGHER_ORDERS: u32 = 3;
/// Highest order, for robots with few joints.
const MAX_ORDER: u32 = 24;
/// Largest work for one part, in products of coefficients: some 3 s.
const MAX_WORK: f64 = 4e8;

/// Returns the order of the Taylor models in q with which the error of a model is bounded. It is
/// limited by the work for one part.
pub(crate) fn taylor_order(model: &PolynomialModel) -> u32 {
    let wanted = match model.kind() {
        ModelKind::Three => model.order().saturating_add(HIGHER_ORDERS).clamp(LOW_ORDER, MAX_ORDER),
        _ => LOW_ORDER,
    };
    let fits = |order: &u32| part_cost(model.joints(), *order) <= MAX_WORK;
    (LOW_ORDER - 1..=wanted).rev().find(fits).unwrap_or(LOW_ORDER - 1)
}

/// Returns the work for one part, in products of coefficients: n⁴ products of Taylor models in k
/// variables, each of C(order + 2k, order) products of coefficients.
pub(crate) fn part_cost(joints: usize, order: u32) -> f64 {
    let variables = joints.saturating_sub(1).max(1) as f64;
    let products = (1..=order).map(f64::from).fold(1.0, |c, i| c * (2.0 * variables + i) / i);
    (joints as f64).powi(4) * products
}
