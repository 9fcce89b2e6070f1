from collections.abc import Callable, Sequence
from typing import Literal, TypeAlias, final

import numpy as np
import numpy.typing as npt

_Array: TypeAlias = npt.NDArray[np.float64]
_Progress: TypeAlias = Callable[[int, int, list[str]], object] | None

__all__ = [
    "Abstraction",
    "Fleet",
    "Fold",
    "Monitor",
    "Robot",
    "Run",
    "Source",
    "among_others",
    "check",
    "check_findings",
    "check_model",
    "check_runs",
    "check_system",
    "check_tracking",
    "conform",
    "conform_system",
    "cut",
    "excite",
    "flowpipe",
    "given_system",
    "identify",
    "make_tracking",
    "model",
    "model_findings",
    "model_report",
    "model_schema",
    "open_system",
    "paddings",
    "parse_system",
    "parse_tracking",
    "plan_tube",
    "prepare",
    "prepared",
    "reach",
    "reach_runs",
    "read_log",
    "report",
    "stop",
    "tolerances",
    "verify",
    "version",
]

def version() -> str: ...

@final
class Robot:
    @staticmethod
    def load(
        path: str, base: str | None = None, tip: str | None = None, lock: list[str] = ...
    ) -> Robot: ...
    @staticmethod
    def from_toml(text: str, origin: str) -> Robot: ...
    @staticmethod
    def from_description(text: str) -> Robot: ...
    def to_toml(self) -> str: ...
    def updated_urdf(self, robot: Robot) -> tuple[str, str] | None: ...
    def description(self) -> str: ...
    def rnea(self, q: _Array, qd: _Array, qdd: _Array) -> _Array: ...
    def aba(self, q: _Array, qd: _Array, tau: _Array) -> _Array: ...
    def mass_matrix(self, q: _Array) -> _Array: ...
    def gravity(self, q: _Array) -> _Array: ...
    def coriolis(self, q: _Array, qd: _Array) -> _Array: ...
    def friction(self, q: _Array, qd: _Array) -> tuple[_Array, _Array]: ...
    def regressor(self, q: _Array, qd: _Array, qdd: _Array) -> _Array: ...
    def parameters(self) -> tuple[list[str], list[float]]: ...

_Left: TypeAlias = tuple[
    float, float, int, str, Literal["upper", "lower"], float, float, float, bool, bool
]

@final
class Monitor:
    def __new__(
        cls,
        model: str,
        step: float,
        horizon: float | None,
        every: float | None,
        max_gap: float | None,
        differentiate: bool,
        healthy: Source | None,
    ) -> Monitor: ...
    def push(self, times: _Array, q: _Array, qd: _Array, tau: _Array) -> list[_Left]: ...
    def finish(self) -> None: ...
    def alarms(self) -> list[tuple[float, str, int | None, float, float, float]]: ...
    def alarm_bound(self) -> float | None: ...
    def findings(self) -> str: ...
    def totals(self) -> tuple[int, int, int, int, int]: ...
    def used(self) -> _Array: ...
    def largest_used(self) -> _Array: ...
    def drift(self) -> _Array: ...
    def delay(self) -> float: ...
    def horizon(self) -> float: ...

@final
class Run:
    def __new__(
        cls,
        start: float | None,
        t: _Array,
        q: _Array,
        qd: _Array,
        tau: _Array,
        temperature: _Array | None = None,
    ) -> Run: ...
    def arrays(self) -> tuple[_Array, _Array, _Array, _Array, _Array | None]: ...
    def start(self) -> float: ...
    def samples(self) -> int: ...
    def joints(self) -> int: ...
    def duration(self) -> float: ...

@final
class Source:
    @staticmethod
    def open(folder: str) -> Source: ...
    @staticmethod
    def of_runs(
        runs: Sequence[tuple[Run, str, str | None, str | None, int | None, float | None]],
        simulated: bool,
    ) -> Source: ...
    def index(
        self,
    ) -> list[tuple[str, str | None, str | None, str | None, int, float | None]]: ...
    def simulated(self) -> bool: ...
    def read(self, index: int) -> Run: ...
    def inspection(self, max_gap: float | None = None) -> str | None: ...

@final
class Fleet:
    @staticmethod
    def to_conform(
        robot: Robot | None, abstraction: Abstraction | None, settings: str
    ) -> Fleet: ...
    @staticmethod
    def to_check(model: str, settings: str) -> Fleet: ...
    def fold(self) -> Fold: ...
    def merge(self, parts: list[bytes]) -> bytes: ...
    def count(self, fold: bytes) -> tuple[int, int, list[str]]: ...
    def check_fit(self, fit: list[str], pull: float | None = None) -> None: ...
    def conform(
        self,
        fold: bytes,
        report: bool,
        fit: list[str],
        pull: float | None = None,
        progress: _Progress = None,
    ) -> tuple[str, list[str]]: ...
    def check(self, fold: bytes, report: bool) -> str: ...

_Entry: TypeAlias = tuple[int, str, str, str | None, int, str | None, float | None]
_Taken: TypeAlias = tuple[tuple[str, int, float] | None, list[str]]

@final
class Fold:
    def take_csv(self, row: _Entry, content: bytes) -> _Taken: ...
    def take_run(self, row: _Entry, run: Run) -> _Taken: ...
    def take_defect(self, row: _Entry, problem: str, remedy: str) -> _Taken: ...
    def merge(self, fleet: Fleet, part: bytes) -> None: ...
    def to_bytes(self) -> bytes: ...

@final
class Abstraction:
    def __new__(
        cls,
        robot: Robot,
        model: int,
        order: int,
        expansion: list[float],
        progress: _Progress = None,
    ) -> Abstraction: ...
    @staticmethod
    def parse(text: str, origin: str) -> Abstraction: ...
    def to_json(self) -> str: ...
    def formulas(self) -> str: ...
    def states(self, q: _Array, qd: _Array) -> _Array: ...
    def rate(self, x: _Array, u: _Array) -> _Array: ...

def conform(
    robot: Robot | None,
    abstraction: Abstraction | None,
    source: Source,
    suites: list[str],
    settings: str,
    fit: list[str],
    pull: float | None = None,
    resume: str | None = None,
    preparation: str | None = None,
    progress: _Progress = None,
) -> tuple[str, list[str]]: ...
def check_model(text: str, origin: str) -> None: ...
def model_schema() -> str: ...
def among_others(text: str, path: str) -> str: ...
def model_findings(text: str) -> str: ...
def check_findings(text: str) -> str: ...
def model_report(text: str) -> tuple[str, str]: ...
def check(
    model: str,
    source: Source,
    suites: list[str],
    settings: str,
    paths: list[str],
    runs: Source | None,
    progress: _Progress = None,
) -> str: ...
def reach(
    model: str, source: Source, suites: list[str], settings: str, progress: _Progress = None
) -> list[
    tuple[str, str | None, _Array, tuple[_Array, _Array, _Array], tuple[_Array, _Array], str | None]
]: ...
def report(
    model: str,
    source: Source,
    suites: list[str],
    settings: str,
    folder: str,
    beside: bool,
    progress: _Progress = None,
) -> str: ...
def identify(
    robot: Robot,
    recorded: list[tuple[list[str], list[tuple[Run, int | None]]]],
    toml: str | None,
    given: str,
    folder: str,
    progress: _Progress = None,
) -> tuple[str, str, str]: ...
def model(
    robot: Robot,
    paths: list[str],
    runs: Source | None,
    settings: str | None,
    given: str,
    progress: _Progress = None,
) -> tuple[str, list[str]]: ...
def cut(
    robot: Robot | None,
    abstraction: Abstraction | None,
    torque: str,
    horizon: float,
    calibrate: list[str],
    paths: list[str],
    runs: Source | None,
) -> tuple[Source, str, list[str]]: ...
def prepared(model: str, paths: list[str], runs: Source | None) -> Source: ...
def prepare(
    robot: Robot,
    paths: list[str],
    runs: Source | None,
    settings: str,
    cutting: tuple[float | None, bool, bool],
) -> tuple[Source, float, list[str]]: ...
def excite(
    robot: Robot,
    period: float,
    harmonics: int,
    condition: bool,
    margin: float,
    speed: float,
    acceleration: list[float],
    torque_noise: list[float],
    starts: int,
    trials: int,
    seed: int,
    rate: float,
) -> tuple[_Array, tuple[_Array, _Array, _Array], float, float]: ...
def flowpipe(
    inputs: int,
    angles: list[int],
    terms: list[list[tuple[list[int], float]]],
    times: list[float],
    centre: list[float],
    radius: list[float],
    measured: _Array,
    input_centre: list[float],
    input_radius: list[float],
    automatic: bool,
    taylor: int | None,
    vertex_variables: int | None,
    order: int | None,
    pieces: list[int],
) -> tuple[
    tuple[_Array, _Array],
    tuple[_Array, _Array],
    tuple[float, int] | None,
    tuple[int | None, int, list[int]],
]: ...
def read_log(
    paths: list[str],
    topics: list[str],
    joints: list[str],
    receipt_time: bool,
    recover: bool,
    cutting: tuple[str | None, bool, float, float | None],
) -> tuple[list[tuple[Run, str, str | None, str | None]], list[str], list[str]]: ...
def stop(
    model: str,
    source: Source,
    suites: list[str],
    settings: str,
    brakes: str,
    origin: str | None,
    question: tuple[int, int, bool],
    recorded: Source | None = None,
    progress: _Progress = None,
) -> str: ...
def verify(
    scenario: str,
    origin: str | None,
    folder: str,
    in_memory: tuple[str, Source] | None = None,
    progress: _Progress = None,
) -> str: ...

_Recorded: TypeAlias = tuple[str, _Array, _Array, _Array, list[float] | None]

def check_system(description: str) -> None: ...
def conform_system(description: str, recorded: Sequence[_Recorded]) -> tuple[str, str]: ...
def open_system(path: str) -> str: ...
def given_system(description: str) -> tuple[str, str]: ...
def parse_system(text: str, origin: str) -> tuple[str, str]: ...
def check_runs(model: str, recorded: Sequence[_Recorded]) -> str: ...
def reach_runs(
    model: str, recorded: Sequence[_Recorded]
) -> list[tuple[_Array, _Array, _Array]]: ...
def make_tracking(
    joints: Sequence[tuple[str, str]], followed: Sequence[tuple[str, _Array, _Array, _Array]]
) -> tuple[str, str]: ...
def parse_tracking(text: str, origin: str) -> tuple[str, str]: ...
def check_tracking(
    model: str,
    joints: Sequence[tuple[str, str]],
    followed: Sequence[tuple[str, _Array, _Array, _Array]],
) -> str: ...
def plan_tube(model: str, times: _Array, command: _Array) -> tuple[_Array, _Array]: ...
def tolerances(model: str) -> list[tuple[str, float, float]]: ...
def paddings(model: str, urdf: str, part: float) -> list[tuple[str, float, float]]: ...
