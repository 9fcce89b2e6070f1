//! Model 1 of order 3 of the Schunk LWA 4P about q = 0, M⁻¹ (u - friction), and the sets of Table
//! II, all of Liu & Althoff, IROS 2018.

use reachtube_reach::{Hyperrectangle, PolynomialSystem};

use crate::systems::{Polynomial, constant, variables};

/// M⁻¹ at q = 0 in 1/(kg m²), as printed by
/// `reachtube abstract --robot lwa4p --paper-model 1 --order 3`.
const INVERSE_MASS: [[f64; 6]; 6] = [
    [
        0.5799185615516497,
        0.014411651508731674,
        0.0019893472234957335,
        -0.03605479792963103,
        0.03334021357892145,
        -0.004815050514259264,
    ],
    [
        0.014411651508731672,
        0.283888330563861,
        0.11253987799238886,
        0.007280314176095894,
        0.07289719389591949,
        -0.00019204793095686703,
    ],
    [
        0.0019893472234957343,
        0.11253987799238888,
        0.47341667243880603,
        -0.011030611526638727,
        -0.08672889022303762,
        8.004604690423635e-05,
    ],
    [
        -0.03605479792963103,
        0.0072803141760958935,
        -0.011030611526638723,
        0.5777290668197254,
        0.03414862920505186,
        -0.0047956660131395195,
    ],
    [
        0.03334021357892145,
        0.07289719389591949,
        -0.08672889022303765,
        0.034148629205051864,
        1.5521645344686943,
        -0.0005975065979567262,
    ],
    [
        -0.004815050514259264,
        -0.000192047930956867,
        8.004604690423631e-05,
        -0.004795666013139519,
        -0.000597506597956726,
        1.5560451928255319,
    ],
];

/// Viscous friction of Table III: coefficients of q̇, q̇² and q̇³.
const FRICTION: [[f64; 3]; 6] = [
    [11.52, 0.088, -0.79],
    [10.08, 0.10, -1.02],
    [10.68, 0.93, -1.56],
    [8.41, -0.0098, 0.099],
    [3.61, 0.024, -0.24],
    [3.53, 0.11, -0.11],
];

/// Returns ẋ of the model in the variables (q, q̇, u).
pub(crate) fn components() -> Vec<Polynomial> {
    let z = variables(18, 3);
    let load = |j: usize| {
        let (v, [f1, f2, f3]) = (&z[6 + j], FRICTION[j]);
        let friction = v * &(constant(f1) + v * &(constant(f2) + v * &constant(f3)));
        z[12 + j].clone() - friction
    };
    let row = |i: usize| {
        let terms = (0..6).map(|j| &load(j) * &constant(INVERSE_MASS[i][j]));
        terms.reduce(|sum, term| sum + term).expect("6 terms")
    };
    z[6..12].iter().cloned().chain((0..6).map(row)).collect()
}

pub(crate) fn model1() -> PolynomialSystem {
    PolynomialSystem::new(12, 6, &components()).expect("12 components")
}

/// Returns X0 and U of the velocity-conformant model, as printed, times `scale`.
pub(crate) fn table2(scale: f64) -> (Hyperrectangle, Hyperrectangle) {
    let q = [0.0030, 0.0017, 0.0025, 0.0027, 0.0075, 0.0063].map(|q| [-q, q]);
    let velocity = [
        [-0.0317, 1.2140],
        [-0.6586, 0.2550],
        [-0.0154, 0.0463],
        [-0.0184, 0.0331],
        [-0.1179, 0.0551],
        [-0.0765, 0.0765],
    ];
    let input = [
        [-2.7201, 3.6017],
        [-2.3225, 7.1559],
        [-6.8833, 2.6287],
        [-1.7374, 2.0317],
        [-1.4919, 0.5486],
        [-1.0060, 1.0060],
    ];
    let set = |sides: &[[f64; 2]]| Hyperrectangle {
        centre: sides.iter().map(|[low, high]| 0.5 * scale * (low + high)).collect(),
        radius: sides.iter().map(|[low, high]| 0.5 * scale * (high - low)).collect(),
    };
    (set(&[q, velocity].concat()), set(&input))
}
