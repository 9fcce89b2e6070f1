"""Runs an exported HyLAA script and compares its bounds with ours and with sampled motions.

    python check_hylaa.py FOLDER equal|inside

FOLDER holds hylaa_reach.py and bounds.csv. `equal`: HyLAA's bounds are ours, where the disturbance
is held over samples. `inside`: ours lie in HyLAA's. Either way sampled motions lie in HyLAA's.
"""

import csv
import importlib.util
import sys
from pathlib import Path

import numpy as np
from scipy.linalg import expm

# HyLAA's linear programs are solved to about 1e-9 relative to the width of the set.
TOLERANCE = 1e-8
MOTIONS = 200
STRIDE = 10


def load(folder):
    """Return the exported script as a module."""
    spec = importlib.util.spec_from_file_location("hylaa_reach", folder / "hylaa_reach.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def our_bounds(model, folder):
    """Return our lower and upper bounds as the script counts them, samples x states each."""
    with open(folder / "bounds.csv", newline="") as file:
        table = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    column = {end: np.array([[row[f"{name}_{end}"] for name in model.STATES] for row in table])
              for end in ("lower", "nominal", "upper")}
    origin = column["nominal"] if model.DEVIATION else 0.0
    return column["lower"] - origin, column["upper"] - origin


def motions(model, steps, random):
    """Yield the states of random motions, states x motions, at each sample."""
    states, inputs = model.B.shape
    whole = np.zeros((states + inputs + 1,) * 2)
    whole[:states] = np.hstack([model.A, model.B, model.DRIFT[:, None]]) * model.STEP
    step = expm(whole)[:states]

    def draw(centre, radius, count):
        # Half of the points are corners, which the bounds must hold too.
        part = random.uniform(-1, 1, (count, MOTIONS))
        part[:, ::2] = np.sign(part[:, ::2])
        return np.array(centre)[:, None] + np.array(radius)[:, None] * part

    x = np.array(model.X_START)[:, None] + draw(model.X0_CENTRE, model.X0_RADIUS, states)
    for _ in range(steps):
        yield x
        u = draw(model.U_CENTRE, model.U_RADIUS, inputs)
        x = step @ np.vstack([x, u, np.ones((1, MOTIONS))])
    yield x


def main():
    """Compare; exit with 1 where something is wrong."""
    folder, wanted = Path(sys.argv[1]), sys.argv[2]
    model = load(folder)
    ours = our_bounds(model, folder)
    sampled = list(motions(model, model.STEPS, np.random.default_rng(1)))
    difference, outside, reached = 0.0, 0.0, 0.0
    for k, lower, upper in model.reach(model.STEPS, STRIDE):
        width = np.maximum(upper - lower, 1e-12)
        beyond = [(lower - ours[0][k]) / width, (ours[1][k] - upper) / width]
        difference = max(difference, *(np.max(np.abs(x) if wanted == "equal" else x)
                                       for x in beyond))
        low, high = sampled[k].min(axis=1), sampled[k].max(axis=1)
        outside = max(outside, np.max((lower - low) / width), np.max((high - upper) / width))
        reached = max(reached, np.max((high - low) / width))
    print(f"{folder}: ours {wanted} to {difference:.1e} widths; of {MOTIONS} motions at most "
          f"{outside:.1e} widths outside, and they fill {reached:.2f} of a width")
    sys.exit(int(difference > TOLERANCE or outside > TOLERANCE or reached < 0.5))


if __name__ == "__main__":
    main()
