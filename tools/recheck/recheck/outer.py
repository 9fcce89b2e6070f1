"""Rows of a model that is not linear, by sets that are computed here (flowpipe.py).

A row is a suite at one sample in one state. It holds if all its recorded values are proved to be
reachable: motions of the model get at least as far on both sides, and everything in between is
reached too, since starts and disturbances can be changed from one motion to the other without a
jump. It fails if a value is outside the enclosure of all motions, with its ends rounded outward to
doubles: the model claims a computed outer set, whose ends are doubles. In between it is undecided.

Disturbances that are held over each step are enough for the motions; the enclosure is for all
measurable ones.
"""

from .balls import arb, up
from .expansion import Expansion
from .flowpipe import Flowpipe, Lost
from .hulls import extremes, state_name
from .reach_files import PrintedBounds
from .verdict import Tally, Verdict, of_margin


def judge(model, cases, folder=None):
    """Judges the rows of cases, and the files of `reach` in a folder. Returns tallies and notes."""
    rows, printed, notes = {}, [], []
    expansion = Expansion(model.polynomials)
    for case in cases:
        tally = rows.setdefault(case.suite, Tally(f"suite {case.suite}"))
        bounds = PrintedBounds(model, folder, case) if folder else None
        reached = _judge_case(model, case, Flowpipe(model, case, expansion), tally, bounds)
        if reached < len(case.grid):
            notes.append(
                f"suite {case.suite}: the reachable set was enclosed up to "
                f"{case.grid.times[reached - 1]:.6g} s only; the rows after that are undecided"
            )
        if bounds:
            printed += bounds.tallies
    found = {"rows": list(rows.values())}
    return (found | {"bounds": printed} if printed else found), notes


def _judge_case(model, case, flowpipe, tally, bounds):
    """Judges the rows of a case, and returns the number of samples that were reached."""
    reached, is_lost = 0, False
    for k, of_states in enumerate(extremes(case)):
        hull = None if is_lost else flowpipe.hull()
        for i, sides in enumerate(of_states[: model.states]):
            _judge_row(model, case, k, i, sides, hull, tally)
        if bounds:
            bounds.visit(k, hull)
        if hull is None:
            continue
        reached = k + 1
        if k + 1 < len(case.grid):
            try:
                flowpipe.advance(k, case.grid.span(k))
            except Lost:
                is_lost = True
    return reached


def _judge_row(model, case, k, i, sides, hull, tally):
    (low, low_run), (high, high_run) = sides
    place = f"sample {k} at {case.grid.times[k]:.6g} s, {state_name(i, model.joints)}"
    if hull is None:
        tally.add(Verdict.UNDECIDED, None, f"{high_run}, {place}")
        return
    noise, centre = arb(model.noise_radius[i]), hull.centre[i]
    found = []
    for value, side, run in (
        (arb(high) - centre, "above", high_run), (centre - arb(low), "below", low_run)
    ):
        inside, outside = hull.inner[i] + noise - value, hull.outer[i] + noise - value
        end = (centre if side == "above" else -centre) + hull.outer[i] + noise
        if (high if side == "above" else -low) > up(end):
            found.append((Verdict.FAILS, outside, side, run))
        elif inside >= 0 and hull.inner[i] >= 0:
            found.append((Verdict.HOLDS, None, side, run))
        else:
            found.append((Verdict.UNDECIDED, inside, side, run))
    verdict, margin, side, run = max(found, key=lambda one: one[0])
    tally.add(verdict, margin, f"{run}, {place} {side}")
