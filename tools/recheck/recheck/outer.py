"""Models that are not linear, with the CSV files of `reachtube reach`.

Their outer sets are not computed again. Two things are checked: that every recorded value lies
within the printed bounds and V, exactly, and that no motion of the model leaves the bounds. Motions
are simulated in doubles from random starts in X0 under random disturbances in U; one that is
outside by more than its error of integration fails. Motions that stay inside prove nothing.
"""

import numpy

from .balls import arb
from .hulls import extremes, state_name
from .reach_files import read_bounds
from .verdict import Tally, Verdict, of_margin

# Motions of each case.
MOTIONS = 48
# A step of integration is at most this long, s.
LONGEST_STEP = 0.002
# Two integrations whose steps differ by a factor of 2 differ by 15 times the error of the finer
# one where the method is of order 4. This factor on their difference leaves room.
SAFETY = 2.0
# Rounding of a motion, rad and rad/s.
ROUNDING = 1e-10


def judge(model, folder, cases):
    """Judges the files of a folder, one for each case. Returns tallies of rows and of motions."""
    rows, motions = {}, []
    for number, case in enumerate(cases):
        name, at_samples, tube = read_bounds(model, folder, case)
        tally = rows.setdefault(case.suite, Tally(f"suite {case.suite}"))
        _judge_rows(model, case, at_samples, tally)
        motions.append(Tally(f"{name}.csv"))
        _judge_motions(model, case, at_samples, tube, motions[-1], seed=number)
    return {"rows": list(rows.values()), "motions": motions}


def _judge_rows(model, case, at_samples, tally):
    """Judges every recorded value of a case, both sides."""
    for k, of_states in enumerate(extremes(case)):
        for i, ((low, low_run), (high, high_run)) in enumerate(of_states[: model.states]):
            noise = arb(model.noise_radius[i])
            lower, upper = arb(at_samples[k][3 * i + 1]), arb(at_samples[k][3 * i + 3])
            sides = (
                (upper + noise - arb(high), "above", high_run),
                (arb(low) - (lower - noise), "below", low_run),
            )
            judged = [(of_margin(margin), margin, side, run) for margin, side, run in sides]
            verdict, margin, side, run = max(judged, key=lambda found: found[0])
            name = state_name(i, model.joints)
            place = f"{run}, sample {k} at {case.grid.times[k]:.6g} s, {name} {side}"
            tally.add(verdict, margin, place)


def _draws(random, box, shape):
    """Numbers of a box: a third of the motions anywhere in it, two thirds at its corners."""
    centre, radius = (numpy.array(part)[:, None] for part in (box.centre, box.radius))
    parts = random.uniform(-1.0, 1.0, shape)
    corners = shape[1] // 3
    parts[:, corners:] = numpy.sign(parts[:, corners:])
    return centre + radius * parts


def _judge_motions(model, case, at_samples, tube, tally, seed):
    """Simulates motions of a case and counts each as one claim."""
    n, random = model.joints, numpy.random.default_rng(seed)
    start = numpy.array(case.start)[:, None] + _draws(random, model.initial_set, (2 * n, MOTIONS))
    coarse, fine = start, start
    outside, places = numpy.full(MOTIONS, -numpy.inf), [""] * MOTIONS

    def compare(lower, upper, place):
        error = SAFETY * numpy.abs(fine - coarse) + ROUNDING
        excess = numpy.maximum(lower[:, None] - fine, fine - upper[:, None]) - error
        excess = numpy.where(numpy.isnan(excess), numpy.inf, excess)
        worst = excess.argmax(axis=0)
        for motion in numpy.flatnonzero(excess.max(axis=0) > outside):
            state = state_name(int(worst[motion]), n)
            places[motion] = f"motion {motion}, {place}, {state}"
        numpy.maximum(outside, excess.max(axis=0), out=outside)

    held = None
    for k, bounds in enumerate(numpy.array(at_samples)):
        compare(bounds[1::3], bounds[3::3], f"row {k}")
        for step in (k - 1, k):
            if 0 <= step < len(tube):
                row = numpy.array(tube[step])
                compare(row[2::2], row[3::2], f"step {step} at sample {k}")
        if k + 1 == len(at_samples):
            break
        fresh = _draws(random, model.input_set, (n, MOTIONS))
        # In the last third of the motions a disturbance changes seldom.
        change = random.uniform(size=(n, MOTIONS)) < 0.02
        change[:, : 2 * MOTIONS // 3] = True
        held = fresh if held is None else numpy.where(change, fresh, held)
        u = numpy.array(case.inputs[k])[:, None] + held
        span = float(case.grid.times[k + 1] - case.grid.times[k])
        steps = max(1, int(numpy.ceil(span / LONGEST_STEP)))
        coarse = model.polynomials.advance(coarse, u, span, steps)
        fine = model.polynomials.advance(fine, u, span, 2 * steps)
    for excess, place in zip(outside, places, strict=True):
        if excess <= 0.0:
            tally.add(Verdict.HOLDS)
        else:
            tally.add(Verdict.FAILS, arb(-float(excess)), place)
