"""Runs and data sets."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from os import PathLike, fspath
from typing import Any, overload

import numpy as np
import numpy.typing as npt

from . import _reachtube
from ._arrays import Array, above_zero, frozen, label, numbers, samples, whole
from .errors import SettingError


class Run:
    """A recording: K samples of n joints.

    Parameters
    ----------
    t : array of shape (K,)
        Times, s, which increase.
    q : array of shape (K, n)
        Positions, rad (m for prismatic joints).
    qd : array of shape (K, n)
        Velocities, rad/s (m/s for prismatic joints).
    tau : array of shape (K, n)
        Torques, N m; the caller that uses the run states what they mean.
    suite
        The test suite: runs that start from one state under one input.
    motion
        The motion that the suite is part of; suites of one motion are not independent.
    name
        A name for messages; the number of the run in its data set if there is none.
    temperature : array of shape (K, n), optional
        Temperatures of the joints, °C.
    order
        Place in the order in which the suite's runs were recorded, from 1.

    Raises
    ------
    SettingError
        For shapes that do not fit, numbers that are not finite, and times that do not increase.

    Examples
    --------
    >>> import numpy as np, reachtube as rt
    >>> run = rt.Run([0.0, 0.1], np.zeros((2, 6)), np.zeros((2, 6)), np.zeros((2, 6)), suite="A")
    >>> len(run), run.joints, run.suite
    (2, 6, 'A')
    """

    __slots__ = ("_arrays", "_native", "motion", "name", "order", "suite")

    def __init__(
        self,
        t: npt.ArrayLike,
        q: npt.ArrayLike,
        qd: npt.ArrayLike,
        tau: npt.ArrayLike,
        *,
        suite: str | None = None,
        motion: str | None = None,
        name: str | None = None,
        temperature: npt.ArrayLike | None = None,
        order: int | None = None,
    ) -> None:
        times, positions = numbers("t", t), numbers("q", q)
        if times.ndim != 1:
            raise SettingError(f"t has the shape {times.shape}, but one axis is needed")
        if positions.ndim != 2:
            raise SettingError(
                f"q has the shape {positions.shape}, but two axes are needed: one row for each "
                "sample, one column for each joint"
            )
        shape = (len(times), positions.shape[1])
        warm = None if temperature is None else samples("temperature", temperature, shape)
        native = _reachtube.Run(
            None,
            times,
            samples("q", positions, shape),
            samples("qd", qd, shape),
            samples("tau", tau, shape),
            warm,
        )
        self._set(native, suite, motion, name, order)

    def _set(
        self,
        native: _reachtube.Run,
        suite: str | None,
        motion: str | None,
        name: str | None,
        order: int | None,
    ) -> None:
        self._native = native
        self._arrays: list[Array | None] | None = None
        self.suite, self.motion = label("suite", suite), label("motion", motion)
        self.name = label("name", name)
        self.order = None if order is None else whole("order", order, 1)

    @classmethod
    def _of(
        cls,
        native: _reachtube.Run,
        suite: str | None,
        motion: str | None,
        name: str | None,
        order: int | None = None,
    ) -> Run:
        run = cls.__new__(cls)
        run._set(native, suite, motion, name, order)
        return run

    def _array(self, index: int) -> Array | None:
        if self._arrays is None:
            arrays = self._native.arrays()
            self._arrays = [None if array is None else frozen(array) for array in arrays]
        return self._arrays[index]

    def _values(self, index: int) -> Array:
        array = self._array(index)
        assert array is not None
        return array

    @property
    def t(self) -> Array:
        """Times, K, s, to rounding."""
        return self.start + self._values(0)

    @property
    def start(self) -> float:
        """Time of the first sample, s."""
        return self._native.start()

    @property
    def q(self) -> Array:
        """Positions, K x n, rad."""
        return self._values(1)

    @property
    def qd(self) -> Array:
        """Velocities, K x n, rad/s."""
        return self._values(2)

    @property
    def tau(self) -> Array:
        """Torques, K x n, N m."""
        return self._values(3)

    @property
    def temperature(self) -> Array | None:
        """Temperatures, K x n, °C, if they were recorded."""
        return self._array(4)

    @property
    def joints(self) -> int:
        """The number of joints n."""
        return self._native.joints()

    @property
    def duration(self) -> float:
        """Time from the first sample to the last, s."""
        return self._native.duration()

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame with the columns t, q1.., qd1.., tau1.. of the CSV format."""
        import pandas

        columns: dict[str, Array] = {"t": self.t}
        parts = {"q": self.q, "qd": self.qd, "tau": self.tau, "temp": self.temperature}
        for prefix, values in parts.items():
            if values is not None:
                columns.update({f"{prefix}{j + 1}": values[:, j] for j in range(self.joints)})
        return pandas.DataFrame(columns)

    def __len__(self) -> int:
        return self._native.samples()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Run):
            return NotImplemented
        return self.__reduce__() == other.__reduce__()

    def __hash__(self) -> int:
        return hash(self.__reduce__())

    def __repr__(self) -> str:
        name = f"{self.name}: " if self.name else ""
        suite = f", suite {self.suite}" if self.suite else ""
        samples = f"{len(self)} samples of {self.joints} joints"
        return f"<Run {name}{samples}, {self.duration:g} s{suite}>"

    def __reduce__(self) -> tuple[Any, ...]:
        warm = self.temperature
        arrays = [self._values(0), self.q, self.qd, self.tau, warm]
        data = tuple(None if a is None else a.tobytes() for a in arrays)
        labels = (self.suite, self.motion, self.name, self.order)
        return _restored, (self.joints, self.start, data, labels)


def _restored(
    joints: int,
    start: float,
    data: tuple[bytes | None, ...],
    labels: tuple[str | None, str | None, str | None, int | None],
) -> Run:
    """Return the run that was pickled, to the last bit."""
    flat = [np.frombuffer(part or b"", dtype=np.float64) for part in data]
    q, qd, tau, warm = (values.reshape(-1, joints) for values in flat[1:])
    given = None if data[4] is None else warm
    return Run._of(_reachtube.Run(start, flat[0], q, qd, tau, given), *labels)


class Recordings:
    """A data set: runs in memory, or a folder of CSV files with an index.

    Parameters
    ----------
    runs
        The runs.
    simulated
        Whether they are simulated, and not measured; models and pages report it.

    Examples
    --------
    >>> import numpy as np, reachtube as rt
    >>> still = np.zeros((2, 6))
    >>> data = rt.Recordings([rt.Run([0.0, 0.1], still, still, still, suite="A")])
    >>> len(data), data.suites
    (1, ['A'])
    """

    __slots__ = ("_folder", "_index", "_native")

    def __init__(self, runs: Iterable[Run], *, simulated: bool = False) -> None:
        if isinstance(runs, (str, bytes, PathLike)):
            raise SettingError(
                f"{runs!r} is a path, not runs; Recordings.open({runs!r}) opens a folder"
            )
        named = []
        for k, run in enumerate(_iterated(runs), 1):
            if not isinstance(run, Run):
                kind = type(run).__name__
                raise SettingError(
                    f"item {k} of the recordings is of type {kind}; give runs: "
                    "Run(t, q, qd, tau, suite=...)"
                )
            name = run.name or f"run {k}"
            named.append((run._native, name, run.suite, run.motion, run.order, None))
        self._set(_reachtube.Source.of_runs(named, bool(simulated)), None)

    @classmethod
    def open(cls, folder: str | PathLike[str]) -> Recordings:
        """Open a folder with ``runs.csv`` and its recordings, which are read when they are used.

        Parameters
        ----------
        folder
            The folder.

        Returns
        -------
        Recordings

        Raises
        ------
        DefectsError
            If the index has defects.
        """
        data = cls.__new__(cls)
        data._set(_reachtube.Source.open(fspath(folder)), fspath(folder))
        return data

    @classmethod
    def _of(cls, native: _reachtube.Source) -> Recordings:
        data = cls.__new__(cls)
        data._set(native, None)
        return data

    def _set(self, native: _reachtube.Source, folder: str | None) -> None:
        self._native, self._folder, self._index = native, folder, native.index()

    @property
    def suites(self) -> list[str]:
        """The names of the test suites, in the order of their first runs."""
        return list(dict.fromkeys(row[1] for row in self._index if row[1] is not None))

    @property
    def simulated(self) -> bool:
        """Whether a run is marked as simulated, and not measured."""
        return self._native.simulated()

    def inspect(self, *, max_gap: float | None = None) -> dict[str, Any] | None:
        """Read all recordings of a folder and summarise them.

        Parameters
        ----------
        max_gap
            Longest time between two samples, s; by default 1.9 times the usual sample time, and 10
            times if sample times jitter.

        Returns
        -------
        dict or None
            What ``reachtube inspect --json`` prints; ``None`` for runs in memory.
        """
        limit = None if max_gap is None else above_zero("max_gap", max_gap)
        text = self._native.inspection(limit)
        return None if text is None else dict(json.loads(text))

    def __len__(self) -> int:
        return len(self._index)

    @overload
    def __getitem__(self, index: int) -> Run: ...

    @overload
    def __getitem__(self, index: slice) -> list[Run]: ...

    def __getitem__(self, index: int | slice) -> Run | list[Run]:
        if isinstance(index, slice):
            return [self._run(place) for place in range(len(self))[index]]
        if not -len(self) <= index < len(self):
            raise IndexError(f"there is no run {index}; there are {len(self)}")
        return self._run(index % len(self))

    def _run(self, place: int) -> Run:
        file, suite, motion, _, order, _ = self._index[place]
        return Run._of(self._native.read(place), suite, motion, file, order)

    def __iter__(self) -> Iterator[Run]:
        return (self._run(k) for k in range(len(self)))

    def __repr__(self) -> str:
        where = self._folder or "in memory"
        return f"<Recordings {where}: {len(self)} runs, {len(self.suites)} suites>"

    def __reduce__(self) -> tuple[Any, ...]:
        if self._folder is not None:
            return Recordings.open, (self._folder,)
        return _restored_set, (list(self), self.simulated)


def _restored_set(runs: list[Run], simulated: bool) -> Recordings:
    """Return the data set that was pickled."""
    return Recordings(runs, simulated=simulated)


def _iterated(runs: object) -> Iterable[object]:
    if not isinstance(runs, Iterable):
        raise SettingError(
            f"recordings are of type {type(runs).__name__}; give Recordings, runs or the path of "
            "a folder"
        )
    return runs


def source(data: Recordings | Run | Iterable[Run] | str | PathLike[str]) -> _reachtube.Source:
    """Return the native source of what a user gives as recordings."""
    if isinstance(data, (str, PathLike)):
        return Recordings.open(data)._native
    if not isinstance(data, Recordings):
        data = Recordings([data] if isinstance(data, Run) else data)
    if len(data) == 0:
        raise SettingError("there are no recordings; give at least one run")
    return data._native
