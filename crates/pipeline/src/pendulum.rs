use reachtube_robot::Robot;

/// Returns a pendulum about a horizontal axis.
pub(crate) fn pendulum() -> Robot {
    let robot = "schema_version = 1\nname = \"pendulum\"\n[[joint]]\nname = \"hinge\"\n\
                 placement = { translation = [0.0, 0.0, 1.0] }\naxis = [0.0, 1.0, 0.0]\n\
                 mass = 1.0\ncom = [0.0, 0.0, -0.3]\n\
                 inertia = [0.02, 0.0, 0.0, 0.02, 0.0, 0.01]\n";
    Robot::from_toml(robot, "pendulum").unwrap()
}
