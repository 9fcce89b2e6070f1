"""Ball arithmetic: numbers known up to a radius, from python-flint.

Every operation on `arb` and `arb_mat` encloses the exact result. Comparisons are true only where
they hold for all numbers of the balls.
"""

from flint import arb, arb_mat, ctx

BITS = 200

ctx.prec = BITS


def matrix(rows):
    """Returns the matrix of these rows of doubles, which are taken as exact numbers."""
    return arb_mat([[arb(x) for x in row] for row in rows])


def column(values):
    """Returns the column of these numbers."""
    return arb_mat(len(values), 1, [arb(x) for x in values])


def zeros(rows, columns):
    """Returns a matrix of zeros."""
    return arb_mat(rows, columns)


def identity(size):
    """Returns the identity."""
    return arb_mat(size, size, [int(i == j) for i in range(size) for j in range(size)])


def magnitudes(m):
    """Returns the matrix of absolute values."""
    return arb_mat(m.nrows(), m.ncols(), [abs(x) for x in m.entries()])


def block(m, rows, columns):
    """Returns the part of a matrix in these ranges of rows and columns."""
    return arb_mat(len(rows), len(columns), [m[i, j] for i in rows for j in columns])


def between(low, high):
    """Returns a ball around all numbers from `low` to `high`."""
    return arb(low).union(arb(high))


def symmetric(radius):
    """Returns a ball about 0 with at least this radius."""
    bound = arb(radius).abs_upper()
    return (-bound).union(bound)


def row_sum_norm(m):
    """Returns an upper bound of the largest row sum of absolute values."""
    rows, columns = m.nrows(), m.ncols()
    sums = (sum((abs(m[i, j]) for j in range(columns)), arb(0)) for i in range(rows))
    return max((total.upper() for total in sums), default=arb(0))


def up(x):
    """Returns a double that is at least every number of the ball, for reports."""
    from math import inf, nextafter

    return nextafter(float(x.upper()), inf)


def down(x):
    """Returns a double that is at most every number of the ball, for reports."""
    return -up(-x)
