"""Searches in doubles. Nothing that is found here is trusted: balls decide afterwards."""

import numpy

ROUNDS = 2000


def multipliers(of_centre, of_radius, prices, unused):
    """Returns y >= 0, one for each row, with y E near 0 and y R near the prices; only near or below
    the price of a radius that is not used."""
    safe = numpy.where(prices > 0.0, prices, 1.0)
    # Each radius, and the centre of the same number, in units that cost 1.
    of_radius = of_radius / safe
    of_centre = of_centre / safe[: of_centre.shape[1]]
    size = numpy.abs(of_radius).max(axis=1, initial=0.0)
    size = numpy.where(size > 0.0, size, 1.0)
    wanted = numpy.concatenate([numpy.zeros(of_centre.shape[1]), (prices > 0.0).astype(float)])
    columns = numpy.concatenate([of_centre, of_radius], axis=1).T / size
    slacks = numpy.eye(len(wanted))[:, of_centre.shape[1] :][:, unused]
    return nonnegative_least_squares(numpy.concatenate([columns, slacks], axis=1), wanted)[
        : len(size)
    ] / size


def nonnegative_least_squares(a, b):
    """Minimises |a x - b| for x >= 0 (Lawson and Hanson, Solving Least Squares Problems, 1974)."""
    x, passive = numpy.zeros(a.shape[1]), numpy.zeros(a.shape[1], dtype=bool)
    slope = a.T @ b
    for _ in range(ROUNDS):
        candidates = numpy.where(passive, -numpy.inf, slope)
        if not candidates.size or candidates.max() <= 1e-13 * numpy.abs(b).max(initial=1.0):
            break
        passive[candidates.argmax()] = True
        while True:
            wanted = numpy.zeros_like(x)
            wanted[passive] = numpy.linalg.lstsq(a[:, passive], b, rcond=None)[0]
            negative = passive & (wanted <= 0.0)
            if not negative.any():
                break
            part = (x[negative] / (x[negative] - wanted[negative])).min()
            x = x + part * (wanted - x)
            passive &= x > 1e-15 * numpy.abs(x).max(initial=0.0)
            x[~passive] = 0.0
        if numpy.array_equal(wanted, x):
            break
        x = wanted
        slope = a.T @ (b - a @ x)
    return x


def independent_rows(rows):
    """Returns the indices of rows that are independent, the largest remainder first."""
    rest, picked = numpy.array(rows, dtype=float), []
    sizes = numpy.abs(rest).max(axis=0, initial=0.0)
    rest = rest / numpy.where(sizes > 0.0, sizes, 1.0)
    for _ in range(rest.shape[1] if rest.size else 0):
        norms = (rest**2).sum(axis=1)
        at = int(norms.argmax())
        if norms[at] < 1e-20:
            break
        picked.append(at)
        direction = rest[at] / numpy.sqrt(norms[at])
        rest = rest - numpy.outer(rest @ direction, direction)
        rest[at] = 0.0
    return picked
