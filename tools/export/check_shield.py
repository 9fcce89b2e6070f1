"""Reads the robot file of the SaRA shield as the shield does and compares its axes with MuJoCo's.

    python check_shield.py FOLDER ROBOT

FOLDER holds robot_parameters.yaml, and ROBOT the robot.urdf of the same robot.
"""

import sys
from pathlib import Path

import mujoco
import numpy as np
import yaml

TOLERANCE = 1e-9


def frames(matrices, q):
    """Return the frames of the links by the formula of the shield's `forwardKinematic`."""
    frame, all_frames = np.eye(4), []
    for matrix, angle in zip(matrices, q, strict=True):
        turn = np.eye(4)
        turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        frame = frame @ matrix @ turn
        all_frames.append(frame)
    return all_frames


def main():
    """Compare; exit with 1 where the axes differ."""
    folder, robot = map(Path, sys.argv[1:])
    config = yaml.safe_load((folder / "robot_parameters.yaml").read_text())
    n = config["nb_joints"]
    matrices = np.array(config["transformation_matrices"]).reshape(n, 4, 4)
    for key, count in [("enclosures", 7), ("link_masses", 1), ("link_inertias", 6),
                       ("link_centers_of_mass", 6)]:
        assert np.isfinite(config[key]).all() and len(config[key]) == count * n, key
    model = mujoco.MjModel.from_xml_path(str(robot / "robot.urdf"))
    data, worst = mujoco.MjData(model), 0.0
    for q in np.random.default_rng(1).uniform(-3, 3, (100, n)):
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        ours = frames(matrices, q)
        worst = max(worst, np.abs(data.xanchor - [frame[:3, 3] for frame in ours]).max(),
                    np.abs(data.xaxis - [frame[:3, 2] for frame in ours]).max())
    print(f"{folder}: {n} joints of the shield, secure radius {config['secure_radius']:.4f} m, "
          f"axes off by {worst:.1e}")
    sys.exit(int(not worst < TOLERANCE))


if __name__ == "__main__":
    main()
