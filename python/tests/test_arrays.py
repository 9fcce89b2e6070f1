"""Arrays as users have them: any order in memory, type and library."""

from __future__ import annotations

import numpy as np
import pytest

import reachtube as rt

STATES = np.random.default_rng(3).uniform(-1, 1, (4, 6))


def run_of(t: object, q: object, qd: object, tau: object) -> rt.Run:
    return rt.Run(t, q, qd, tau, suite="A")  # type: ignore[arg-type]


def forms(array: np.ndarray) -> dict[str, object]:
    """Return the same numbers in other forms."""
    wide = np.zeros((2 * array.shape[0], 3 * array.shape[1]))
    wide[::2, ::3] = array
    locked = array.copy()
    locked.flags.writeable = False
    negative = np.ascontiguousarray(array[::-1])[::-1]
    import pandas
    import polars

    return {
        "C": np.ascontiguousarray(array),
        "Fortran": np.asfortranarray(array),
        "strided": wide[::2, ::3],
        "transposed": np.ascontiguousarray(array.T).T,
        "backward": negative,
        "read-only": locked,
        "list": array.tolist(),
        "big-endian": array.astype(">f8"),
        "pandas": pandas.DataFrame(array),
        "pandas.to_numpy": pandas.DataFrame(array).to_numpy(),
        "polars.to_numpy": polars.DataFrame(array).to_numpy(),
    }


@pytest.mark.parametrize("form", forms(STATES))
def test_values_keep_their_places_in_every_form(form: str, robot: rt.Robot) -> None:
    given = forms(STATES)[form]
    t = [0.0, 0.1, 0.2, 0.3]
    run = run_of(t, given, forms(2 * STATES)[form], forms(3 * STATES)[form])
    assert np.array_equal(run.q, STATES)
    assert np.array_equal(run.qd, 2 * STATES)
    assert np.array_equal(run.tau, 3 * STATES)
    expected = np.array([robot.rnea(q, q, q) for q in STATES])
    assert np.array_equal(robot.rnea(given, given, given), expected)  # type: ignore[arg-type]


def test_pandas_and_polars_give_fortran_order() -> None:
    given = forms(STATES)
    for name in ("pandas.to_numpy", "polars.to_numpy"):
        array = given[name]
        assert isinstance(array, np.ndarray)
        assert np.array_equal(run_of([0.0, 1.0, 2.0, 3.0], array, array, array).q, STATES)


def test_float32_and_whole_numbers_are_converted() -> None:
    single = STATES.astype(np.float32)
    run = run_of(np.arange(4), single, single, np.ones((4, 6), dtype=np.int32))
    assert np.array_equal(run.q, single.astype(np.float64))
    assert run.tau.dtype == np.float64 and run.t.tolist() == [0.0, 1.0, 2.0, 3.0]


def test_given_arrays_are_copied_and_those_of_a_run_cannot_be_written() -> None:
    q = STATES.copy()
    run = run_of([0.0, 1.0, 2.0, 3.0], q, q, q)
    q[:] = 0.0
    assert np.array_equal(run.q, STATES)
    with pytest.raises(ValueError, match="read-only"):
        run.q[0, 0] = 1.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (([0.0, 0.1], STATES, STATES, STATES), r"q has the shape \(4, 6\), but \(2, 6\)"),
        (([0.0, 0.1, 0.2, 0.3], STATES, STATES.T, STATES), r"qd has the shape \(6, 4\)"),
        (([0.0, 0.1, 0.2, 0.3], STATES, STATES, STATES[:, :3]), r"tau has the shape \(4, 3\)"),
        (([[0.0]], STATES, STATES, STATES), "t has the shape"),
        (([0.0] * 4, STATES[:, 0], STATES, STATES), "two axes"),
        (([0.0, 0.1, 0.1, 0.2], STATES, STATES, STATES), "sample 2 .*sort"),
        (([0.0, 0.1, 0.3, 0.2], STATES, STATES, STATES), "sample 3 .*sort"),
        (([0.0, 0.1, np.nan, 0.3], STATES, STATES, STATES), "t holds NaN at sample 2"),
        (([], STATES[:0], STATES[:0], STATES[:0]), "one sample at least"),
        (([0.0] * 4, STATES * 1j, STATES, STATES), "complex128"),
        (([0.0] * 4, [["a"] * 6] * 4, STATES, STATES), "type"),
        (([0.0] * 4, [[1.0], [1.0, 2.0]], STATES, STATES), "no array of numbers"),
    ],
)
def test_wrong_arrays_are_refused(arguments: tuple[object, ...], words: str) -> None:
    with pytest.raises(rt.SettingError, match=words):
        run_of(*arguments)


def test_numbers_that_are_not_finite_are_refused() -> None:
    for part in range(1, 4):
        arguments = [np.arange(4.0), STATES.copy(), STATES.copy(), STATES.copy()]
        arguments[part][1, 2] = np.inf
        with pytest.raises(rt.SettingError, match="inf at sample 1"):
            run_of(*arguments)


def test_dynamics_refuse_shapes_that_do_not_fit(robot: rt.Robot) -> None:
    with pytest.raises(rt.SettingError, match="last axis needs 6"):
        robot.rnea(np.zeros((6, 4)), np.zeros(6), np.zeros(6))
    with pytest.raises(rt.SettingError, match="do not fit together"):
        robot.rnea(np.zeros((2, 6)), np.zeros((3, 6)), np.zeros(6))
    assert robot.rnea(np.zeros((0, 6)), np.zeros(6), np.zeros(6)).shape == (0, 6)


def test_times_are_the_decimals_that_were_recorded() -> None:
    still = np.zeros((3, 6))
    run = run_of([1700000000.004, 1700000000.008, 1700000000.012], still, still, still)
    exact = run._native.arrays()[0]
    assert exact.tolist() == [0.0, 0.004, 0.008]
