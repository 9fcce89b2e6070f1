"""Dynamics over many states, against identities and the oracle of another library."""

from __future__ import annotations

import json

import numpy as np
import pytest

import reachtube as rt

from conftest import SHARED

RANDOM = np.random.default_rng(7)


def states(n: int, shape: tuple[int, ...]) -> list[np.ndarray]:
    return [RANDOM.uniform(-1.5, 1.5, (*shape, n)) for _ in range(3)]


@pytest.mark.parametrize("shape", [(), (1,), (5,), (3, 7), (1001,)])
def test_algorithms_agree_with_each_other(robot: rt.Robot, shape: tuple[int, ...]) -> None:
    q, qd, qdd = states(6, shape)
    tau = robot.rnea(q, qd, qdd)
    assert tau.shape == (*shape, 6)
    assert np.allclose(robot.aba(q, qd, tau), qdd, rtol=0, atol=1e-9)
    mass = robot.crba(q)
    assert mass.shape == (*shape, 6, 6)
    by_parts = np.einsum("...ij,...j->...i", mass, qdd) + robot.coriolis(q, qd) + robot.gravity(q)
    assert np.allclose(tau, by_parts, rtol=0, atol=1e-10)
    parameters = robot.regressor(q, qd, qdd) @ robot.parameter_values
    # This robot's gravity has parameters of its own, so the links' gravity is taken off.
    still = robot.regressor(q, 0 * qd, 0 * qdd) @ robot.parameter_values
    assert np.abs(tau - robot.gravity(q)).max() > 1.0
    assert np.allclose(parameters - still, tau - robot.gravity(q), rtol=0, atol=1e-9)


def test_each_state_is_computed_as_if_it_were_alone(robot: rt.Robot) -> None:
    q, qd, qdd = states(6, (67,))
    together = robot.rnea(q, qd, qdd)
    alone = np.array([robot.rnea(*state) for state in zip(q, qd, qdd, strict=True)])
    assert np.array_equal(together, alone)
    # More states than one core takes at once.
    q, qd, _ = states(6, (600,))
    together = np.hstack([robot.viscous_friction(qd), robot.coulomb_friction(q, qd)])
    for k in (0, 255, 256, 599):
        one = np.hstack([robot.viscous_friction(qd[k]), robot.coulomb_friction(q[k], qd[k])])
        assert np.array_equal(together[k], one) and one.all()


def test_arguments_are_broadcast(robot: rt.Robot) -> None:
    q = RANDOM.uniform(-1, 1, (5, 1, 6))
    qd = RANDOM.uniform(-1, 1, (3, 6))
    found = robot.rnea(q, qd, np.zeros(6))
    assert found.shape == (5, 3, 6)
    assert np.array_equal(found[4, 2], robot.rnea(q[4, 0], qd[2], np.zeros(6)))


@pytest.mark.skipif(not SHARED.is_dir(), reason="needs the oracle, ../shared/oracle")
@pytest.mark.parametrize("name", ["dh6", "ur5"])
def test_the_oracle_of_another_library_agrees(name: str) -> None:
    record = json.loads((SHARED / "oracle" / f"{name}.json").read_text())
    robot = rt.Robot.from_urdf(SHARED / "oracle" / f"{name}.urdf")
    armature = np.array([link["armature"] for link in record["links"]])
    states = {key: np.array([s[key] for s in record["states"]]) for key in ("q", "qd", "qdd")}
    # The URDF has no motors, and the oracle's torques have their inertia.
    found = robot.rnea(*states.values()) + armature * states["qdd"]
    expected = np.array([state["rnea"] for state in record["states"]])
    assert len(expected) == 100 and np.abs(expected).max() > 10
    assert np.allclose(found, expected, rtol=1e-12, atol=1e-11)
    by_parameters = robot.regressor(*states.values()) @ robot.parameter_values
    assert np.allclose(by_parameters, robot.rnea(*states.values()), rtol=1e-12, atol=1e-11)


def test_robots_are_values(robot: rt.Robot, tmp_path: object) -> None:
    import pickle
    from pathlib import Path

    assert pickle.loads(pickle.dumps(robot)) == robot
    path = Path(str(tmp_path)) / "arm.toml"
    robot.save(path)
    assert rt.Robot.load(path) == robot
    with pytest.raises(rt.ReachtubeError, match="force=True"):
        robot.save(path)
    robot.save(path, force=True)
    assert robot.joint_names[0] in repr(robot)


def test_a_missing_or_wrong_robot_file_is_an_error_that_names_it(tmp_path: object) -> None:
    from pathlib import Path

    with pytest.raises(rt.ReachtubeError, match="no/such.urdf"):
        rt.Robot.from_urdf("no/such.urdf")
    with pytest.raises(rt.ReachtubeError, match="mine"):
        rt.Robot.from_toml("nonsense", "mine")
    with pytest.raises(rt.SettingError, match="base and a tip"):
        rt.Robot(rt._reachtube.Robot.load("lwa4p", "base"))
    xacro = Path(str(tmp_path)) / "arm.urdf.xacro"
    xacro.write_text("<robot/>")
    with pytest.raises(rt.ReachtubeError, match=r"xacro \S*arm.urdf.xacro > \S*arm.urdf$"):
        rt.Robot.from_urdf(xacro, base="world")
    for path in ("arm.toml", "lwa4p"):
        with pytest.raises(rt.SettingError, match=r"ends with \.urdf; Robot\.load"):
            rt.Robot.from_urdf(path)
