"""Long jobs: interrupts, progress, threads."""

from __future__ import annotations

import os
import signal
import threading
import time

import numpy as np
import pytest

import reachtube as rt


@pytest.mark.parametrize("after", [0.1, 0.4])
def test_an_interrupt_ends_a_long_call_at_once(robot: rt.Robot, after: float) -> None:
    # A shell lets jobs in the background ignore interrupts, and they would do so here.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    # Processor time of this process, which other processes do not lengthen.
    started, sent = time.process_time(), []

    def interrupt() -> None:
        while time.process_time() < started + after:
            time.sleep(0.001)
        sent.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            rt.abstract(robot, paper_model=3, order=9)
        assert time.process_time() - sent[0] < 0.2 * min(4, os.cpu_count() or 1)
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("job", ["excite", "friction"])
def test_other_threads_run_during_a_job(robot: rt.Robot, job: str) -> None:
    counted = 0
    states = np.ones((200_000, 6))
    done = threading.Event()

    def count() -> None:
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    first = time.monotonic()
    if job == "excite":
        rt.excite(robot, trials=400)
    else:
        robot.coulomb_friction(states, states)
    took = time.monotonic() - first
    done.set()
    thread.join()
    # Arrays are copied with the interpreter, which takes a part of the time.
    assert counted > min(20, 100 * took)


def test_progress_is_told(robot: rt.Robot, data: rt.Recordings) -> None:
    told: list[tuple[int, int, list[str]]] = []
    rt.conform(
        robot, data, torque="motor", progress=lambda *now: told.append(now), notion="phase-plane"
    )
    assert told[-1][:2] == (6, 6)
    assert any("cutting planes" in sentence for _, _, words in told for sentence in words)


def test_an_exception_of_the_observer_ends_the_job(robot: rt.Robot, data: rt.Recordings) -> None:
    def stop(*now: object) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        rt.conform(robot, data, torque="motor", progress=stop)


def test_a_bar_is_drawn_where_tqdm_is_installed(
    robot: rt.Robot, data: rt.Recordings, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("tqdm")
    rt.check(rt.conform(robot, data, torque="motor", progress=True), data, progress=True)
    assert "conform" in capsys.readouterr().err
