"""Loads an exported robot in MuJoCo and compares its inverse dynamics with ours.

    python check_mujoco.py FOLDER

FOLDER holds robot.xml, robot.urdf with robot.toml, and check_torques.csv: states and our torques
without friction.
"""

import sys
import tomllib
from pathlib import Path

import mujoco
import numpy as np

TOLERANCE = 1e-9


def inverse_dynamics(model, states):
    """Return MuJoCo's torques, states x joints, without friction and limits."""
    model.dof_damping[:] = 0
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    data, n = mujoco.MjData(model), model.nv
    torques = []
    for state in states:
        data.qpos[:], data.qvel[:], data.qacc[:] = state[:n], state[n:2 * n], state[2 * n:]
        mujoco.mj_inverse(model, data)
        torques.append(data.qfrc_inverse.copy())
    return np.array(torques)


def main():
    """Compare; exit with 1 where torques differ."""
    folder = Path(sys.argv[1])
    table = np.loadtxt(folder / "check_torques.csv", delimiter=",", skiprows=1)
    states, ours = np.split(table, [3 * table.shape[1] // 4], axis=1)
    companion = tomllib.loads((folder / "robot.toml").read_text())
    urdf = mujoco.MjModel.from_xml_path(str(folder / "robot.urdf"))
    urdf.dof_armature[:] = [joint["armature"] for joint in companion["joint"]]
    urdf.opt.gravity[:] = companion.get("gravity", [0.0, 0.0, -9.81])
    models = {"mjcf": mujoco.MjModel.from_xml_path(str(folder / "robot.xml")), "urdf": urdf}
    failed = False
    for name, model in models.items():
        error = np.abs(inverse_dynamics(model, states) - ours).max()
        failed |= not error < TOLERANCE
        print(f"{folder}: {name}, {len(states)} states, {model.nv} joints: torques differ by "
              f"{error:.1e} N m at most, of {np.abs(ours).max():.0f} N m")
    sys.exit(int(failed))


if __name__ == "__main__":
    main()
