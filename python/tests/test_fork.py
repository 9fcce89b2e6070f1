"""Processes: a fork has no threads that compute."""

from __future__ import annotations

import os
import select
import signal
from collections.abc import Callable

import numpy as np
import pytest

import reachtube as rt

pytestmark = pytest.mark.skipif(not hasattr(os, "pidfd_open"), reason="needs a process descriptor")

#: Time limit for a child that hangs, s.
LIMIT = 60.0


def status_of_fork(job: Callable[[], object]) -> int:
    """Run a job in a forked process and return its status: 0 for a RuntimeError with the remedy."""
    child = os.fork()
    if child == 0:
        status = 2
        try:
            job()
            status = 1
        except RuntimeError as error:
            status = 0 if "forkserver" in str(error) and "spawn" in str(error) else 3
        finally:
            os._exit(status)
    ready, _, _ = select.select([os.pidfd_open(child)], [], [], LIMIT)
    if not ready:
        os.kill(child, signal.SIGKILL)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
def test_a_forked_process_raises_at_once(
    robot: rt.Robot, data: rt.Recordings, model: rt.Model
) -> None:
    states = np.zeros((4, 6))
    robot.rnea(states, states, states)
    assert status_of_fork(lambda: robot.rnea(states, states, states)) == 0
    assert status_of_fork(lambda: rt.conform(robot, data, torque="motor")) == 0
    assert status_of_fork(lambda: rt.check(model, data)) == 0
    assert status_of_fork(lambda: rt.model(robot, data, torque="motor")) == 0
    # What reads and computes with no other thread goes on.
    assert status_of_fork(lambda: data[0].q.sum()) == 1
    # The parent has its threads.
    assert robot.rnea(states, states, states).shape == (4, 6)
