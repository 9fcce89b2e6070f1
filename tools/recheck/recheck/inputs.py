"""The input u of each run (docs/method.md, corrections I and section 3), and the cases: runs that
share their input, sample times and nominal start.

For torques that are compensated already and a model without a correction, u is what was recorded.
Otherwise u is defined by an evaluation in double precision, which cannot be repeated to the last
bit. The u computed here then counts as known to `input_error` only, or it is read from a file.
"""

import csv
import math
from dataclasses import dataclass
from fractions import Fraction

import numpy

from .dynamics import Dynamics
from .errors import BadInput
from .recordings import Run
from .robot import SLOW, Robot, coulomb_torque, softened_coulomb_torque, viscous_torque

# A load (N m) whose sign depends on rounding.
NO_LOAD = 1e-9


@dataclass
class Case:
    """Runs with one nominal motion."""

    suite: str
    runs: list
    inputs: list
    start: list
    # How far each joint's inputs may be from the inputs that define the model, N m.
    doubt: list
    # The run where the suite's runs have nominal motions of their own.
    own: Run | None

    @property
    def grid(self):
        """The sample times of the longest run."""
        return self.runs[0].grid


@dataclass(frozen=True)
class Recorded:
    """A run with its input, and what evaluated it where that is not what was recorded."""

    run: Run
    inputs: list
    evaluation: object


class Inputs:
    """Evaluates the inputs of runs under a model."""

    def __init__(self, model, system, input_error, given=None):
        self.model, self.system, self.given = model, system, given
        self.robot = Robot(model.robot)
        self.error = input_error
        self.torque = model.settings["torque"]
        n = model.joints
        self.warms = any(self.robot.warming(j) for j in range(n))
        self.correction = model.correction
        if self.correction is None and self.warms:
            self.correction = {"joints": [{}] * n}
        self.equations = None
        if model.settings.get("equations", "model") == "robot":
            self.equations = RobotEquations(model, self.robot)
        is_recorded = self.correction is None and self.equations is None
        self.is_exact = self.torque == "compensated" and is_recorded

    def cases(self, suite, runs):
        """Returns the cases of a suite."""
        known = self.model.nominal_start(suite)
        is_own = self.model.settings["nominal"] == "own"
        recorded = [self._recorded(run) for run in runs]
        groups = _groups(recorded)
        shared = len(groups) == 1 and not is_own and not self._differs_by_run()
        if not shared or self.given is not None:
            groups = [[one] for one in recorded]
        cases = []
        for group in groups:
            longest = group[0]
            start = longest.run.states[0] if is_own else known or mean_start(runs)
            own = None if shared else longest.run
            runs_of_case = [one.run for one in group]
            case = Case(suite, runs_of_case, longest.inputs, list(start), [], own)
            self._finish(case, longest.evaluation)
            cases.append(case)
        return cases

    def _recorded(self, run):
        """The input of a run without the model's correction."""
        if self.is_exact:
            return Recorded(run, run.torques, None)
        evaluation, n = _Evaluation(self, run), self.model.joints
        rows = zip(run.states, run.torques, strict=True)
        inputs = [evaluation.recorded(x[:n], x[n:], tau) for x, tau in rows]
        return Recorded(run, inputs, evaluation)

    def _differs_by_run(self):
        if self.model.condition is not None:
            return False
        correction = self.correction or {}
        joints = correction.get("joints", [])
        kinds = ("warm_up", "warm_up_coulomb")
        by_warmth = any(joint.get(kind, 0.0) != 0.0 for joint in joints for kind in kinds)
        return by_warmth or self.warms

    def _finish(self, case, evaluation):
        if self.is_exact:
            case.doubt = [0.0] * self.model.joints
        else:
            if self.correction is not None or self.equations is not None:
                self._correct(case, evaluation)
            case.doubt = [self.error + jump for jump in evaluation.jumps]
        if self.given is not None:
            self._replace(case)

    def _correct(self, case, evaluation):
        """Takes the correction off along the nominal motion, sample by sample, and follows the
        robot's own equations where the model does."""
        n, grid = self.model.joints, case.grid
        x, rounded = numpy.array(case.start), {}
        case.inputs = list(case.inputs)
        for k in range(len(grid) - 1):
            u = case.inputs[k]
            if self.correction is not None:
                u = evaluation.corrected(x[:n], x[n:], u)
            if self.equations is not None:
                u = self.equations.replaced(x, u)
            case.inputs[k] = u
            step = self.system.step(grid.span(k))
            if id(step) not in rounded:
                rounded[id(step)] = step.rounded()
            phi, gamma, drift = rounded[id(step)]
            x = phi @ x + gamma @ numpy.array(u) + drift[:, 0]

    def _replace(self, case):
        file = case.runs[0].file
        rows = self.given.get(file, [])
        count = len(case.grid) - 1
        if len(rows) < count:
            raise BadInput(f"the inputs of {file} have {len(rows)} rows, but {count} act")
        for k in range(count):
            apart = max(abs(a - b) for a, b in zip(rows[k], case.inputs[k], strict=True))
            if apart > max(case.doubt):
                raise BadInput(
                    f"the inputs given for {file} differ by {apart:.3g} at sample {k} from those "
                    f"computed here"
                )
        case.inputs = [*rows[:count], case.inputs[-1]]
        case.doubt = [0.0] * self.model.joints


class RobotEquations:
    """The input under which the linear model accelerates as the robot itself does."""

    def __init__(self, model, robot):
        n = model.joints
        self.dynamics, self.joints = Dynamics(robot), n
        self.of_state, self.of_input = numpy.array(model.a)[n:], numpy.array(model.b)[n:]
        self.drift = numpy.array(model.drift)[n:]

    def replaced(self, x, u):
        """Returns the input of the model in place of the robot's input `u` at the state `x`."""
        qdd = self.dynamics.acceleration(x[: self.joints], x[self.joints :], u)
        missing = qdd - self.of_state @ x - self.drift
        return [float(value) for value in numpy.linalg.solve(self.of_input, missing)]


class _Evaluation:
    """The formulas of u for one run, in doubles."""

    def __init__(self, inputs, run):
        self.robot, self.torque = inputs.robot, inputs.torque
        self.correction = inputs.correction or {}
        self.n = inputs.model.joints
        self.origin = inputs.model.settings["expansion_point"]["qd"]
        condition = inputs.model.condition or {}
        place = condition.get("place", run.place)
        temperatures = condition.get("temperatures") if condition else run.temperatures
        self.factors = [
            _factors(self.robot.warming(j), j, place, temperatures) for j in range(self.n)
        ]
        self.warms = inputs.warms
        self.warmth = [math.log(place)] * self.n
        reference = self.correction.get("reference_temperatures")
        if reference is not None:
            known = temperatures or reference
            self.warmth = [own - other for own, other in zip(known, reference, strict=True)]
        self.jumps = [0.0] * self.n
        joints = self.correction.get("joints", [])
        warm_coulomb = self.warms and self.torque == "compensated"
        self.parts = [
            [part + own.get("warm_up_coulomb", 0.0) * warmth for part in own.get("coulomb", (0.0,) * 4)]
            for own, warmth in zip(joints, self.warmth)
        ]
        self.loads = warm_coulomb or any(any(parts) for parts in self.parts)

    def recorded(self, q, qd, tau):
        """The input of eq. (11) from what was recorded."""
        if self.torque == "compensated":
            return list(tau)
        gravity, u = self.robot.gravity_torque(q), []
        for j in range(self.n):
            coulomb, viscous = self.factors[j]
            if self.torque == "link":
                friction = -viscous * viscous_torque(self.robot.viscous(j), qd[j])
            else:
                friction = coulomb * self._dry(j, gravity[j], qd[j])
            u.append(tau[j] - friction - gravity[j])
        return u

    def _dry(self, j, load, velocity):
        coefficients = self.robot.coulomb(j)
        self._note_jump(j, load, velocity, coefficients)
        return coulomb_torque(coefficients, load, velocity) + self.robot.stribeck(j, velocity)

    def _note_jump(self, j, load, velocity, coefficients):
        """Friction may jump where a load vanishes, and rounding then decides its quadrant."""
        if abs(load) <= NO_LOAD and velocity != 0.0:
            pair = (0, 3) if velocity > 0.0 else (1, 2)
            one, other = (coefficients[2 * at] for at in pair)
            self.jumps[j] = max(self.jumps[j], abs(one - other))

    def corrected(self, q, qd, recorded):
        """The recorded input less the correction at a nominal state."""
        u, robot = list(recorded), self.robot
        loads = robot.gravity_torque(q) if self.loads else [0.0] * self.n
        for j, terms in enumerate(self.correction["joints"]):
            offset = qd[j] - self.origin[j]
            cubic = terms.get("quadratic", 0.0) + terms.get("cubic", 0.0) * offset
            u[j] -= cubic * offset * offset + terms.get("warm_up", 0.0) * self.warmth[j] * qd[j]
            coulomb, viscous = self.factors[j]
            u[j] -= (viscous - 1.0) * viscous_torque(robot.viscous(j), qd[j])
            parts, coefficients = self.parts[j], robot.coulomb(j)
            u[j] -= softened_coulomb_torque(coefficients, loads[j], qd[j], parts)
            if self.warms and self.torque == "compensated":
                warm = [coulomb * a for a in coefficients]
                u[j] -= softened_coulomb_torque(warm, loads[j], qd[j])
                u[j] += softened_coulomb_torque(coefficients, loads[j], qd[j])
                slow = min(abs(qd[j]) / SLOW, 1.0)
                u[j] -= slow * (coulomb - 1.0) * robot.stribeck(j, qd[j])
        payload = self.correction.get("payload", 0.0)
        if payload != 0.0:
            weights = robot.payload_torque(q)
            u = [a - payload * b for a, b in zip(u, weights, strict=True)]
        return u


def _factors(law, j, place, temperatures):
    """Factors of Coulomb and viscous friction of a joint at a place in the order of a suite, or at
    the temperature of the joint where it is known."""
    if not law:
        return 1.0, 1.0
    by, reference = law.get("by", "temperature"), law["reference"]
    if by == "temperature":
        warmth = temperatures[j] - reference if temperatures else 0.0
    elif by == "runs":
        warmth = math.log(place / reference)
    else:
        constant = law.get("time_constant") or 1.0
        warmth = math.exp(-(reference - 1) / constant) - math.exp(-(place - 1) / constant)
    return tuple(math.exp(-law.get(kind, 0.0) * warmth) for kind in ("coulomb", "viscous"))


def _groups(recorded):
    """Groups runs: the first has the inputs and times of each other one, and maybe more."""
    groups = []
    for one in sorted(recorded, key=lambda one: -len(one.run.grid)):
        acting = len(one.run.grid) - 1
        for group in groups:
            longest = group[0]
            same = one.inputs[:acting] == longest.inputs[:acting]
            if same and one.run.grid.is_prefix_of(longest.run.grid):
                group.append(one)
                break
        else:
            groups.append([one])
    return groups


def mean_start(runs):
    """The mean of the first states, rounded to nearest."""
    columns = zip(*(run.states[0] for run in runs), strict=True)
    return [float(sum(map(Fraction, column)) / len(runs)) for column in columns]


def read_inputs(path, joints):
    """Reads inputs: CSV with the columns file, k, u1 to un, sample by sample."""
    given = {}
    try:
        with open(path, encoding="utf-8", newline="") as file:
            reader = csv.reader(file)
            if next(reader, []) != ["file", "k", *(f"u{j}" for j in range(1, joints + 1))]:
                raise BadInput(f"{path}:1: the header is not file,k,u1 to u{joints}")
            for row in reader:
                rows = given.setdefault(row[0], [])
                if int(row[1]) != len(rows) or len(row) != 2 + joints:
                    raise BadInput(f"{path}:{reader.line_num}: a sample or a value is missing")
                rows.append([float(x) for x in row[2:]])
    except (OSError, ValueError, IndexError) as error:
        raise BadInput(f"{path}: {error}") from error
    return given
