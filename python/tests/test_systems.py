"""Abstractions, flowpipes of own systems, exciting motions and identification."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import reachtube as rt


def test_an_abstraction_is_evaluated_over_arrays(robot: rt.Robot, tmp_path: Path) -> None:
    made = rt.abstract(robot, paper_model=2, order=3)
    random = np.random.default_rng(2)
    q, qd, u = random.uniform(-0.1, 0.1, (3, 5, 4, 6))
    x = made.state(q, qd)
    assert x.shape == (5, 4, 24)
    rate = made.rate(x, u)
    assert rate.shape == x.shape and np.array_equal(rate[..., :6], qd)
    tau = u - robot.viscous_friction(qd) + robot.gravity(q)
    exact = robot.aba(q, qd, tau)
    assert np.abs(rate[..., 6:12] - exact).max() < 0.05 * np.abs(exact).max()
    assert np.array_equal(made.rate(x[2, 3], u[2, 3]), rate[2, 3])
    made.save(tmp_path / "model.json")
    assert rt.Abstraction.load(tmp_path / "model.json") == made == pickle.loads(pickle.dumps(made))
    with pytest.raises(rt.SettingError, match="same"):
        made.rate(x, u[0])
    with pytest.raises(rt.SettingError, match="x has the shape"):
        made.rate(x[..., :12], u)


def test_a_flowpipe_holds_sampled_trajectories() -> None:
    q, qd, u = rt.variables("q qd u")
    t = np.linspace(0.0, 1.0, 201)
    found = rt.flowpipe(
        {q: qd, qd: u - rt.sin(q) - 0.1 * qd}, {q: (0.9, 1.1), qd: 0.0}, t, inputs={u: (-0.1, 0.1)}
    )
    assert found.is_reached and found.states == ("q", "qd")
    random = np.random.default_rng(11)
    x = np.array([random.uniform(0.9, 1.1, 500), np.zeros(500)])
    for k, (now, later) in enumerate(zip(t, t[1:], strict=False)):
        inputs = random.choice([-0.1, 0.1], 500)
        for _ in range(20):
            h = (later - now) / 20

            def rate(x: np.ndarray, held: np.ndarray = inputs) -> np.ndarray:
                return np.array([x[1], held - np.sin(x[0]) - 0.1 * x[1]])

            middle = x + h / 2 * rate(x)
            x = x + h * rate(middle)
        assert (x.T >= found.lower[k + 1] - 1e-6).all() and (x.T <= found.upper[k + 1] + 1e-6).all()
    assert pickle.loads(pickle.dumps(found)) == found


@pytest.fixture(scope="module")
def values(robot: rt.Robot) -> list[Any]:
    """Results of every kind that is made of arrays."""
    x, y = rt.variables("x y")
    pipe = rt.flowpipe({x: y, y: -x}, {x: (0.9, 1.1), y: 0.0}, [0.0, 0.1, 0.2])
    lost = rt.flowpipe({x: x**2}, {x: (0.0, 2.0)}, np.linspace(0.0, 1.0, 11))
    assert pipe.is_reached and not lost.is_reached
    motion = rt.excite(robot, trials=2, starts=1)
    box = rt.Box(np.array([0.0, 1.0]), np.array([0.5, 0.25]))
    return [pipe, lost, motion, box]


def test_results_of_arrays_are_values(values: list[Any]) -> None:
    for index, value in enumerate(values):
        again = pickle.loads(pickle.dumps(value))
        assert again == value and hash(again) == hash(value) and type(again) is type(value)
        assert [other == value for other in values] == [k == index for k in range(len(values))]
        arrays = {name: part for name, part in again.to_dict().items() if hasattr(part, "dtype")}
        assert len(arrays) >= 2
        for name, array in arrays.items():
            assert np.array_equal(array, value.to_dict()[name])
            with pytest.raises(ValueError, match="read-only"):
                array[...] = 0.0
    assert values[1].ended == pickle.loads(pickle.dumps(values[1])).ended


def test_bytes_of_other_results_are_refused(values: list[Any]) -> None:
    pipe, motion = values[0].to_bytes(), values[2].to_bytes()
    with pytest.raises(rt.ModelFileError, match="Excitation.*not Flowpipe, version 1"):
        rt.Flowpipe.from_bytes(motion)
    for wrong in (b"", b"nonsense", b"[]\n", pipe.replace(b'"version": 1', b'"version": 2')):
        with pytest.raises(rt.ModelFileError, match="not Flowpipe"):
            rt.Flowpipe.from_bytes(wrong)
    for damaged in (pipe[:-1], pipe[:-8], pipe + bytes(8), pipe.replace(b"upper", b"uper", 1),
                    pipe.replace(b'"values"', b'"value"')):
        with pytest.raises(rt.ModelFileError, match="damaged"):
            rt.Flowpipe.from_bytes(damaged)


def test_taylor_models_and_pieces_are_tighter() -> None:
    x, y = rt.variables("x y")
    system = {x: y, y: (1 - x**2) * y - x}
    t = np.linspace(0.0, 2.0, 201)
    start = {x: (1.3, 1.5), y: (2.35, 2.45)}
    widths = {}
    for name, options in {
        "plain": {"method": "linearisation"},
        "taylor": {"method": "taylor", "taylor_order": 6},
        "pieces": {"pieces": {x: 4, y: 2}},
    }.items():
        found = rt.flowpipe(system, start, t, **options)  # type: ignore[arg-type]
        widths[name] = float((found.upper - found.lower)[-1].sum()) if found.is_reached else np.inf
    assert widths["taylor"] < widths["plain"] and widths["pieces"] < widths["plain"]


def test_settings_that_are_not_given_are_found_and_named() -> None:
    x, y = rt.variables("x y")
    # Steps of 2 s are too long for linearisation.
    found = rt.flowpipe({x: -(x**3)}, {x: (0.9, 1.1)}, np.arange(0.0, 11.0, 2.0))
    assert found.is_reached and found.parts > 1 and "parts of each step" in repr(found)
    given = rt.flowpipe(
        {x: -(x**3)}, {x: (0.9, 1.1)}, np.arange(0.0, 11.0, 2.0), method="linearisation"
    )
    assert not given.is_reached and given.choice == "linearisation"
    # A large set is tighter as a Taylor model.
    system = {x: y, y: (1 - x**2) * y - x}
    start, t = {x: (1.25, 1.55), y: (2.35, 2.45)}, np.linspace(0.0, 3.0, 301)
    found = rt.flowpipe(system, start, t)
    assert found.method == "taylor" and f"order {found.taylor_order}" in repr(found)
    assert rt.Flowpipe.from_bytes(found.to_bytes()) == found
    cut = rt.flowpipe(system, start, t, pieces={x: 8, y: 4})
    assert cut.choice == "linearisation, 8 pieces of x, 4 pieces of y" and cut.pieces == (8, 4)


@pytest.mark.parametrize(
    ("rates", "initial", "words"),
    [
        ("x", {"x": 1.0}, "y: neither a state"),
        ("x y", {"x": 1.0}, "y has no initial value"),
        ("x y", {"x": (2.0, 1.0), "y": 0.0}, "lower bound comes first"),
    ],
)
def test_systems_that_are_incomplete_are_refused(
    rates: str, initial: dict[str, object], words: str
) -> None:
    x, y = rt.variables("x y")
    own = {name: rate for name, rate in {"x": y, "y": -x}.items() if name in rates.split()}
    with pytest.raises(rt.SettingError, match=words):
        rt.flowpipe(own, initial, [0.0, 0.1])  # type: ignore[arg-type]


def test_polynomials_are_computed_with() -> None:
    x, y = rt.variables("x y")
    assert (x + y) * (x - y) == x**2 - y**2 and (x - x) == 0 and 2 * x / 4 == 0.5 * x
    assert str(rt.sin(x) * y) in ("sin x y", "y sin x")
    with pytest.raises(rt.SettingError, match="single variable"):
        rt.sin(x + y)


def test_an_exciting_motion_stays_within_limits(robot: rt.Robot) -> None:
    found = rt.excite(robot, period=8.0, trials=100, starts=1)
    assert found.q.shape == (801, 6) and found.condition > 1
    limits = np.array([joint["velocity_limit"] for joint in robot.to_dict()["joint"]])
    assert (np.abs(found.qd).max(axis=0) <= 0.9 * limits + 1e-12).all()
    assert (np.abs(found.qd).max(axis=0) > 0.1 * limits).any()


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ({"period": 1e300}, "period of 1e\\+300 s at a rate of 100.0 .*10000000 at most"),
        ({"period": 0.0}, "period is 0.0 s; give a finite number above 0"),
        ({"period": "long"}, "period has the type"),
        ({"rate": float("inf")}, "rate is inf"),
        ({"rate": -1.0}, "rate is -1.0"),
        ({"rate": [1.0, 2.0]}, "rate has the shape"),
        ({"harmonics": 1001}, "harmonics is 1001; give 1 to 1000"),
        ({"harmonics": -1}, "harmonics is -1"),
        ({"harmonics": 2.5}, "harmonics is 2.5 of type float"),
        ({"seed": -1}, "seed is -1"),
        ({"starts": 2**64}, "starts is 18446744073709551616"),
        ({"margin": 1.5}, "margin = 1.5"),
        ({"criterion": "trace"}, "criterion is 'trace'"),
    ],
)
def test_wrong_settings_of_a_motion_are_named(
    robot: rt.Robot, setting: dict[str, object], words: str
) -> None:
    with pytest.raises(rt.SettingError, match=words):
        rt.excite(robot, **{"trials": 2, "starts": 1, **setting})  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ({"order": -1}, "order is -1; give 1 to 255"),
        ({"order": 2**40}, "order is 1099511627776"),
        ({"order": 1.5}, "order is 1.5 of type float"),
        ({"paper_model": 4}, "paper_model is 4; give 1 to 3"),
    ],
)
def test_wrong_settings_of_an_abstraction_are_named(
    robot: rt.Robot, setting: dict[str, object], words: str
) -> None:
    with pytest.raises(rt.SettingError, match=words):
        rt.abstract(robot, **setting)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ({"pieces": {"x": 0}}, "pieces of x is 0"),
        ({"pieces": {"x": 10**7}}, "10000000 pieces"),
        ({"pieces": {"z": 2}}, "pieces: z is no state"),
        ({"method": "taylor", "taylor_order": -1}, "taylor_order is -1"),
        ({"method": "taylor", "taylor_order": 256}, "taylor_order is 256; give 1 to 255"),
        ({"method": "tayler"}, "method is 'tayler'"),
        ({"order": -2}, "order is -2"),
        ({"vertex_variables": 25}, "vertex_variables is 25; give 0 to 24"),
        ({"taylor_order": 6}, "give method='taylor' too"),
        ({"method": "linearisation", "taylor_order": 6}, "give method='taylor' too"),
        ({"method": "taylor", "vertex_variables": 2}, "give method='linearisation'"),
    ],
)
def test_wrong_settings_of_a_flowpipe_are_named(
    setting: dict[str, Any], words: str
) -> None:
    x, y = rt.variables("x y")
    with pytest.raises(rt.SettingError, match=words):
        rt.flowpipe({x: y, y: -x}, {x: 1.0, y: 0.0}, [0.0, 0.1], **setting)


def test_exponents_that_do_not_fit_are_named() -> None:
    x, y = rt.variables("x y")
    with pytest.raises(rt.SettingError, match=r"x\^256: exponents are 255 at most"):
        rt.flowpipe({x: -(x**256)}, {x: 0.5}, [0.0, 0.1])
    with pytest.raises(rt.SettingError, match="400"):
        rt.flowpipe({x: -(x**200 * y**200), y: 0.0}, {x: 0.5, y: 0.5}, [0.0, 0.1])


def test_identification_recovers_the_robot_that_moved(robot: rt.Robot, tmp_path: Path) -> None:
    found = rt.excite(robot, period=10.0, trials=100, starts=1, rate=250.0)
    t = np.concatenate([found.t, found.t[-1] + found.t[1:]])
    q, qd, qdd = (np.concatenate([part, part[1:]]) for part in (found.q, found.qd, found.qdd))
    # Without slow motions, only friction that does not depend on the load can be recovered.
    tau = robot.rnea(q, qd, qdd) + robot.viscous_friction(qd)
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        # The paper's links are combinations that no bodies have.
        model = {"windows": [0.5], "physical": False}
        result = rt.identify(robot, excitation=rt.Run(t, q, qd, tau), model=model)
    other = result.robot
    predicted = other.rnea(q, qd, qdd) + other.viscous_friction(qd) + other.coulomb_friction(q, qd)
    moving = np.abs(qd) > 0.05
    error = np.sqrt(np.mean((predicted - tau)[moving] ** 2) / np.mean(tau[moving] ** 2))
    assert error < 0.02
    # A run in memory is the CSV file with the same numbers.
    names = [f"{part}{joint}" for part in ("q", "qd", "tau") for joint in range(1, 7)]
    rows = np.hstack([t[:, None], q, qd, tau]).tolist()
    lines = [",".join(["t", *names]), *(",".join(map(repr, row)) for row in rows)]
    (tmp_path / "run.csv").write_text("\n".join(lines))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        by_file = rt.identify(robot, excitation=tmp_path / "run.csv", model=model)
    ours, theirs = [identified.to_dict() for identified in (other, by_file.robot)]
    # Digests are of the text of a file.
    assert ours.pop("identified_from") != theirs.pop("identified_from")
    assert ours == theirs
    again = pickle.loads(pickle.dumps(result))
    assert again == result != by_file and hash(again) == hash(result)
    assert again.robot == other and again.to_dict() == result.to_dict()
    with pytest.raises(rt.ModelFileError, match="not Identification, version 1"):
        rt.Identification.from_bytes(b"nonsense")
    whole = result.to_bytes()
    for damaged in (whole[:-5], whole[:-5] + b"\xff"):
        with pytest.raises(rt.ModelFileError, match="Identification. are damaged"):
            rt.Identification.from_bytes(damaged)
    assert result.to_pandas().shape[0] == len(result.parameters)
    page = result.report(tmp_path / "identify.html")
    assert "<svg" in page.read_text(encoding="utf-8")
    result.save(tmp_path / "arm.toml")
    assert rt.Robot.load(tmp_path / "arm.toml") == other
    with pytest.raises(rt.ReachtubeError, match="not read from a URDF"):
        result.save_urdf(robot, tmp_path / "arm.urdf")
    with pytest.raises(rt.SettingError, match="cutoff"):
        rt.identify(robot, excitation=rt.Run(t, q, qd, tau), prepare={"cutoff": 5.0})


def test_a_defect_of_a_run_in_memory_names_the_run() -> None:
    robot = rt.Robot.lwa4p()
    t = 0.01 * np.arange(1000)
    t[500:] += 3.0
    q, qd = (np.tile(wave(t)[:, None], robot.joints) for wave in (np.sin, np.cos))
    with pytest.raises(rt.DefectsError, match=r"^excitation_1:502: there is a gap") as refused:
        rt.identify(robot, excitation=rt.Run(t, q, qd, np.zeros_like(q)))
    assert refused.value.defects[0].file == "excitation_1"
