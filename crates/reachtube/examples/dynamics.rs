//! Dynamics of the embedded arm: mass matrix, gravity, inverse and forward dynamics.

use reachtube::Robot;

fn main() {
    let robot = Robot::lwa4p();
    let (q, qd) = ([0.3, -0.4, 0.8, 0.1, -0.5, 0.2], [0.5; 6]);
    println!("mass matrix [kg m²] of {}:\n{:.3}", robot.name(), robot.mass_matrix(&q));
    println!("gravity torque [N m]: {:.3}", robot.gravity_torque(&q).transpose());

    // Torques that give an acceleration, and the acceleration that these torques give.
    let qdd = [1.0; 6];
    let torque = robot.inverse_dynamics(&q, &qd, &qdd);
    let back = robot.forward_acceleration(&q, &qd, torque.as_slice());
    println!("joint torque [N m] for 1 rad/s²: {:.3}", torque.transpose());
    println!("acceleration [rad/s²] under this torque: {:.6}", back.transpose());
}
