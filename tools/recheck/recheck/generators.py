"""The generators of reachable sets: the columns that a box of factors is multiplied by.

At sample k they are e^{A t_k} diag(r_x), then for each earlier sample j the columns of
(Gamma(t_k - t_j) - Gamma(t_k - t_{j+1})) diag(r_u), then diag(r_v).

Sums of thousands of columns have to be exact to more than the digits of a double. Each entry is
therefore rounded to a multiple of 2^-QUANTUM, and cut into slices of so few bits that doubles hold
the sum of all columns, with any signs and in any order, without rounding.
"""

import numpy

from .balls import arb, arb_mat
from .gains import UnevenSamples

# Entries are multiples of 2^-QUANTUM, and below 2^RANGE.
QUANTUM, RANGE = 130, 20
# Error of an entry: half a multiple by rounding, and as much for the radius of its ball.
ENTRY_ERROR = arb(2) ** -QUANTUM
HALF = arb(2) ** -(QUANTUM + 1)


class Columns:
    """Columns of balls, kept as slices of whole numbers in doubles."""

    def __init__(self, rows, capacity):
        self.width = 52 - max(capacity, 1).bit_length()
        count = -(-(QUANTUM + RANGE) // self.width)
        self._slices = numpy.zeros((count, rows, capacity))
        self._rounded = numpy.zeros((rows, capacity))
        self.count = 0

    def append(self, columns):
        """Appends columns, a matrix of balls."""
        rows, added, entries = columns.nrows(), columns.ncols(), columns.entries()
        for at, x in enumerate(entries):
            i, j = divmod(at, added)
            whole = _whole(x)
            self._rounded[i, self.count + j] = float(x)
            sign, size = (-1.0, -whole) if whole < 0 else (1.0, whole)
            for s in range(len(self._slices)):
                digit = (size >> (s * self.width)) & ((1 << self.width) - 1)
                self._slices[s, i, self.count + j] = sign * digit
        self.count += added

    def clear(self):
        """Drops all columns."""
        self.count = 0

    def rounded(self, states):
        """Returns the columns in doubles, rounded to nearest, in these states."""
        return self._rounded[states, : self.count]

    def sums(self, states, signs):
        """Returns the sums of all columns with these signs (columns x sums) as lists of balls,
        one for each sum."""
        slices = [part[states, : self.count] @ signs for part in self._slices]
        error = (ENTRY_ERROR * self.count).upper()
        return [
            [self._value([part[i, v] for part in slices], error) for i in range(len(states))]
            for v in range(signs.shape[1])
        ]

    def combination(self, states, numerators, bits):
        """Returns the sum of the columns times whole numbers over 2^bits, in balls."""
        used = numpy.flatnonzero(numerators)
        factors = [int(n) for n in numerators[used]]
        error = (ENTRY_ERROR * sum(map(abs, factors))).upper()
        found = []
        for i in states:
            wholes = (
                sum(int(part[i, j]) << (s * self.width) for s, part in enumerate(self._slices))
                for j in used
            )
            total = sum(n * whole for n, whole in zip(factors, wholes, strict=True))
            found.append((arb(total) / arb(2) ** QUANTUM + arb(0, error)) / arb(2) ** bits)
        return found

    def _value(self, digits, error):
        whole = sum(int(digit) << (s * self.width) for s, digit in enumerate(digits))
        return arb(whole) / arb(2) ** QUANTUM + arb(0, error)


def _whole(x):
    """Returns the multiple of 2^-QUANTUM next to a ball."""
    mantissa, exponent = x.mid().man_exp()
    shift = int(exponent) + QUANTUM
    mantissa = int(mantissa)
    whole = mantissa << shift if shift >= 0 else (mantissa + (1 << (-shift - 1))) >> -shift
    if not x.rad() <= HALF or abs(whole).bit_length() > QUANTUM + RANGE:
        raise ArithmeticError("a generator is too large, or not known well enough")
    return whole


def scaled(matrix, radii):
    """Returns a matrix of balls with its columns multiplied by these doubles."""
    rows, columns = matrix.nrows(), matrix.ncols()
    factors = [arb(r) for r in radii]
    entries = matrix.entries()
    return arb_mat(rows, columns, [
        entries[i * columns + j] * factors[j % len(factors)]
        for i in range(rows) for j in range(columns)
    ])


class Generators:
    """The generators on one grid, sample after sample."""

    def __init__(self, model, system, grid):
        n, m = system.states, system.inputs
        self.model, self.system, self.grid = model, system, grid
        self.is_constant = model.settings["disturbance"] == "constant"
        of_inputs = m if self.is_constant else m * len(grid)
        self.start, self.inputs = Columns(n, n), Columns(n, of_inputs)
        self.noise = Columns(n, n)
        self.noise.append(_diagonal(model.noise_radius))
        self.uneven = UnevenSamples(system) if grid.step is None else None

    def at(self, sample):
        """Returns the parts of the generators at a sample."""
        radii = self.model.input_set.radius
        self.start.clear()
        self.start.append(scaled(sample.e, self.model.initial_set.radius))
        if self.is_constant:
            self.inputs.clear()
            self.inputs.append(scaled(sample.gamma, radii))
        elif self.uneven is not None and sample.k > 0:
            self.inputs.clear()
            self.inputs.append(scaled(self.uneven.increments, radii))
        return [self.start, self.inputs, self.noise]

    def advance(self, sample):
        """Goes on from a sample to the next one."""
        if sample.k + 1 == len(self.grid) or self.is_constant:
            return
        span = self.grid.span(sample.k)
        step = self.system.step(span)
        if self.uneven is not None:
            self.uneven.advance(sample.e, step, span)
        else:
            self.inputs.append(scaled(sample.e * step.gamma, self.model.input_set.radius))


def _diagonal(radii):
    size = len(radii)
    return arb_mat(size, size, [
        arb(radii[i]) if i == j else arb(0) for i in range(size) for j in range(size)
    ])
