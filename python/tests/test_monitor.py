"""A monitor beside checks of the same recordings."""

from __future__ import annotations

import numpy as np
import pytest

import reachtube as rt

from conftest import runs


def test_a_replayed_run_has_the_rows_of_a_check(model: rt.Model, robot: rt.Robot) -> None:
    # The torques of another motion.
    run = runs(robot, count=1)[0]
    faulty = rt.Run(run.t, run.q, run.qd, run.tau + 3.0, suite="alone", name="alone")
    verdict = rt.check(model, [faulty])
    horizon = float(faulty.t[-1])
    watch = rt.monitor(model, step=0.004, horizon=horizon, every=horizon)
    left = watch.push(faulty.t, faulty.q, faulty.qd, faulty.tau)
    of_window = [one for one in left if one.window == 0.0]
    assert not verdict and len(of_window) == verdict.violations
    assert verdict.worst is not None
    assert max(one.excess for one in of_window) == verdict.worst["excess"]
    assert watch.samples == len(faulty) and watch.windows == 1 and watch.windows_left >= 1
    assert watch.rows_outside == len(left) and watch.rows == 12 * (len(faulty) + 1)
    assert watch.used.shape == watch.drift.shape == (12,) and watch.largest_used.max() > 1
    assert sum(one.first for one in left) == watch.windows_left and all(
        one.proved for one in left if one.excess > 1e-9
    )
    assert "windows left" in repr(watch)


def test_samples_one_by_one_say_what_arrays_say(model: rt.Model, robot: rt.Robot) -> None:
    run = runs(robot, count=1)[1]
    tau = run.tau + 2.0
    arrays, single = (rt.monitor(model, step=0.004, horizon=0.1) for _ in range(2))
    left = [
        one
        for k in range(len(run))
        for one in single.push(run.t[k], run.q[k], run.qd[k], tau[k])
    ]
    assert left == arrays.push(run.t, run.q, run.qd, tau) != []
    assert left[0].state.startswith("q") and left[0].side in ("upper", "lower")
    # A new recording may begin at any time.
    single.finish()
    assert single.delay == 0.0
    assert single.horizon == pytest.approx(0.1)
    assert single.push(-5.0, run.q[0], run.qd[0], run.tau[0]) == []


def test_samples_that_cannot_be_used_are_named(model: rt.Model) -> None:
    watch = rt.monitor(model, step=0.004, horizon=0.1)
    zeros = np.zeros((3, 6))
    with pytest.raises(rt.SettingError, match="sample 2: t is 0.004 s after"):
        watch.push([0.0, 0.004, 0.004], zeros, zeros, zeros)
    assert watch.samples == 2
    wrong = zeros.copy()
    wrong[0, 1] = np.nan
    with pytest.raises(rt.SettingError, match="sample 0: tau2 is NaN"):
        watch.push([0.008, 0.012, 0.016], zeros, zeros, wrong)
    with pytest.raises(rt.SettingError, match="q has the shape"):
        watch.push(0.008, np.zeros(5), np.zeros(6), np.zeros(6))
    with pytest.raises(rt.SettingError, match="gap"):
        watch.push(1.0, np.zeros(6), np.zeros(6), np.zeros(6))
    with pytest.raises(rt.SettingError, match="time between windows"):
        rt.monitor(model, step=0.004, horizon=0.1, every=0.2)


def test_a_model_that_is_not_linear_is_refused(robot: rt.Robot, data: rt.Recordings) -> None:
    model = rt.conform(robot, data, torque="motor", order=2, until=0.02, suites=["A"])
    with pytest.raises(rt.ReachtubeError, match="not linear"):
        rt.monitor(model, step=0.004, horizon=0.1)


def test_healthy_recordings_calibrate_alarms(model: rt.Model, robot: rt.Robot) -> None:
    recordings = runs(robot, count=4)
    watch = rt.monitor(model, step=0.004, horizon=0.1, healthy=recordings)
    assert watch.alarm_bound == pytest.approx(0.4)
    watch.push(*(getattr(recordings[0], name) for name in ("t", "q", "qd", "tau")))
    assert watch.alarms == []
    # A sudden torque at joint 2.
    watch.finish()
    first, pushed = recordings[0], recordings[0].tau.copy()
    pushed[40:, 1] += 30.0
    watch.push(first.t, first.q, first.qd, pushed)
    alarm = watch.alarms[0]
    assert (alarm.fault, alarm.part) == ("push", 2) and first.t[40] <= alarm.time
    assert not alarm.low <= alarm.value <= alarm.high
    assert rt.monitor(model, step=0.004, horizon=0.1).alarm_bound is None
    with pytest.raises(rt.ReachtubeError, match="healthy motion needs at least 2 recordings"):
        rt.monitor(model, step=0.004, horizon=0.1, healthy=recordings[:1])
