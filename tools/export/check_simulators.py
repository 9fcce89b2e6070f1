"""Loads an exported robot in MuJoCo, Pinocchio and Drake and compares its torques with ours.

    python check_simulators.py FOLDER

FOLDER holds robot.xml and, where friction is no line, robot_linear.xml; robot.urdf with robot.toml;
and check_torques.csv: states and our torques without friction. A simulator that is not installed is
named and left out.
"""

import sys
import tomllib
from pathlib import Path

import mujoco
import numpy as np

TOLERANCE = 1e-9


def with_mujoco(model, states):
    """Return MuJoCo's torques, states x joints, without friction and limits."""
    model.dof_damping[:] = 0
    model.dof_dampingpoly[:] = 0
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    data, n = mujoco.MjData(model), model.nv
    torques = []
    for state in states:
        data.qpos[:], data.qvel[:], data.qacc[:] = state[:n], state[n:2 * n], state[2 * n:]
        mujoco.mj_inverse(model, data)
        torques.append(data.qfrc_inverse.copy())
    return np.array(torques)


def damping_error(path, companion):
    """Return how far MuJoCo's damping is from v1 qd + v3 qd^3 of the robot, N m."""
    model = mujoco.MjModel.from_xml_path(str(path))
    data, worst = mujoco.MjData(model), 0.0
    viscous = [joint.get("friction", {}).get("viscous", [0.0] * 3) for joint in companion["joint"]]
    for speed in (-1.3, -0.4, 0.2, 1.0):
        data.qvel[:] = speed
        mujoco.mj_forward(model, data)
        ours = [max(v1, 0.0) * speed + v3 * speed**3 for v1, _, v3 in viscous]
        worst = max(worst, np.abs(data.qfrc_damper + ours).max())
    return worst


def with_pinocchio(pinocchio, model, states):
    """Return Pinocchio's torques, states x joints; they count its `armature`."""
    data, n = model.createData(), model.nv
    return np.array([pinocchio.rnea(model, data, state[:n], state[n:2 * n], state[2 * n:])
                     for state in states])


def with_drake(path, states):
    """Return Drake's torques, states x joints; the mass matrix has the motors' inertia."""
    import logging

    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import MultibodyForces

    # Drake has no dry friction, and says so for each joint.
    logging.getLogger("drake").setLevel(logging.ERROR)
    plant = MultibodyPlant(0.0)
    Parser(plant).AddModels(str(path))
    plant.Finalize()
    context, n = plant.CreateDefaultContext(), plant.num_velocities()
    torques = []
    for state in states:
        plant.SetPositions(context, state[:n])
        plant.SetVelocities(context, state[n:2 * n])
        forces = MultibodyForces(plant)
        gravity = plant.CalcGravityGeneralizedForces(context)
        torque = plant.CalcInverseDynamics(context, state[2 * n:], forces) - gravity
        torques.append(torque)
    return np.array(torques)


def main():
    """Compare; exit with 1 where torques differ."""
    folder = Path(sys.argv[1])
    table = np.loadtxt(folder / "check_torques.csv", delimiter=",", skiprows=1)
    states, ours = np.split(table, [3 * table.shape[1] // 4], axis=1)
    companion = tomllib.loads((folder / "robot.toml").read_text())
    armature = np.array([joint["armature"] for joint in companion["joint"]])
    gravity = companion.get("gravity", [0.0, 0.0, -9.81])
    linear = folder / "robot_linear.xml"
    line = linear if linear.exists() else folder / "robot.xml"

    urdf = mujoco.MjModel.from_xml_path(str(folder / "robot.urdf"))
    urdf.dof_armature[:] = armature
    urdf.opt.gravity[:] = gravity
    torques = {"MuJoCo, MJCF": with_mujoco(mujoco.MjModel.from_xml_path(str(folder / "robot.xml")),
                                           states),
               "MuJoCo, linear MJCF": with_mujoco(mujoco.MjModel.from_xml_path(str(line)), states),
               "MuJoCo, URDF": with_mujoco(urdf, states)}
    try:
        import pinocchio
    except ImportError:
        print("Pinocchio is not installed")
    else:
        model = pinocchio.buildModelFromMJCF(str(line))
        torques["Pinocchio, MJCF"] = with_pinocchio(pinocchio, model, states)
        model = pinocchio.buildModelFromUrdf(str(folder / "robot.urdf"))
        model.gravity.linear, model.armature = np.array(gravity), armature
        torques["Pinocchio, URDF"] = with_pinocchio(pinocchio, model, states)
    try:
        import pydrake  # noqa: F401
    except ImportError:
        print("Drake is not installed")
    else:
        torques["Drake, MJCF"] = with_drake(line, states)

    damping = damping_error(folder / "robot.xml", companion)
    failed = not damping < TOLERANCE
    print(f"{folder}: {len(states)} states, {len(armature)} joints, torques up to "
          f"{np.abs(ours).max():.0f} N m; damping off by {damping:.1e} N m")
    for name, theirs in torques.items():
        error = np.abs(theirs - ours).max()
        failed |= not error < TOLERANCE
        print(f"  {name}: torques differ by {error:.1e} N m at most")
    sys.exit(int(failed))


if __name__ == "__main__":
    main()
