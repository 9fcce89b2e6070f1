"""The generators of reachable sets: the columns that a box of factors is multiplied by.

At sample k they are e^{A t_k} diag(r_x), then for each earlier sample j the columns of
(Gamma(t_k - t_j) - Gamma(t_k - t_{j+1})) diag(r_u), then diag(r_v).

Sums of thousands of columns have to be exact to more than the digits of a double. Each entry is
therefore rounded to a multiple of 2^-QUANTUM, each factor is a multiple of 2^-BITS, and both are
cut into digits of so few bits that doubles hold the sums of their products without rounding, in
any order.
"""

import numpy

from .balls import arb, arb_mat
from .gains import UnevenSamples

# Entries are multiples of 2^-QUANTUM, and below 2^RANGE.
QUANTUM, RANGE = 130, 20
# Factors are multiples of 2^-BITS, in digits of DIGIT bits.
BITS, DIGIT = 47, 12
# Error of an entry: half a multiple by rounding, and as much for the radius of its ball.
ENTRY_ERROR = arb(2) ** -QUANTUM
HALF = arb(2) ** -(QUANTUM + 1)


class Columns:
    """Columns of balls, kept as digits of whole numbers in doubles."""

    def __init__(self, rows, capacity):
        # A sum of `capacity` products of digits stays below 2^53.
        self.width = 52 - DIGIT - max(capacity, 1).bit_length()
        count = -(-(QUANTUM + RANGE) // self.width)
        self._digits = numpy.zeros((count, rows, capacity))
        self._rounded = numpy.zeros((rows, capacity))
        self.count = 0

    def append(self, columns):
        """Appends columns, a matrix of balls."""
        added, entries = columns.ncols(), columns.entries()
        mask = (1 << self.width) - 1
        for at, x in enumerate(entries):
            i, j = divmod(at, added)
            whole = _whole(x)
            self._rounded[i, self.count + j] = float(x)
            sign, size = (-1.0, -whole) if whole < 0 else (1.0, whole)
            for s in range(len(self._digits)):
                self._digits[s, i, self.count + j] = sign * ((size >> (s * self.width)) & mask)
        self.count += added

    def clear(self):
        """Drops all columns."""
        self.count = 0

    def rounded(self, states):
        """Returns the columns in these states in doubles that are off by a last digit at most."""
        return self._rounded[states, : self.count]

    def combination(self, states, factors):
        """Returns the sum of the columns times these factors, multiples of 2^-BITS of at most 1,
        in balls."""
        numerators = numpy.abs(factors) * 2.0**BITS
        signs, totals = numpy.sign(factors), [0] * len(states)
        for t in range(-(-(BITS + 1) // DIGIT)):
            digit = signs * numpy.floor(numpy.fmod(numerators * 2.0 ** (-t * DIGIT), 2.0**DIGIT))
            for s, part in enumerate(self._digits):
                sums = part[states, : self.count] @ digit
                shift = s * self.width + t * DIGIT
                totals = [total + (int(x) << shift) for total, x in zip(totals, sums, strict=True)]
        error = (ENTRY_ERROR * self.count).upper()
        return [arb(total) / arb(2) ** (QUANTUM + BITS) + arb(0, error) for total in totals]


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
    """The generators on one grid, sample after sample. The disturbance is held over each of
    `parts` equal parts of a step."""

    def __init__(self, model, system, grid, parts=1):
        n, m = system.states, system.inputs
        self.model, self.system, self.grid = model, system, grid
        self.is_constant = model.settings["disturbance"] == "constant"
        self.parts = parts
        of_inputs = m if self.is_constant else m * len(grid) * parts
        self.start, self.inputs = Columns(n, n), Columns(n, of_inputs)
        self.noise = Columns(n, n)
        self._at = None
        self.noise.append(_diagonal(model.noise_radius))
        self.uneven = UnevenSamples(system) if grid.step is None else None
        # A measurable disturbance reaches more than one that is held over (parts of) samples.
        self.is_whole = model.settings["disturbance"] != "measurable"

    def at(self, sample):
        """Returns the parts of the generators at a sample."""
        if self._at == sample.k:
            return [self.start, self.inputs, self.noise]
        self._at = sample.k
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

    def ages(self):
        """Returns the age of the step that each generator of the disturbance belongs to, steps x
        inputs: 0 for the last one before the sample."""
        inputs = self.system.inputs
        steps = numpy.arange(self.inputs.count // inputs)
        ages = steps if self.uneven is None or self.is_constant else steps[::-1]
        return numpy.repeat(ages[:, None], inputs, axis=1)

    def advance(self, sample):
        """Goes on from a sample to the next one."""
        if sample.k + 1 == len(self.grid) or self.is_constant:
            return
        step = self.system.step(self.grid.span(sample.k) / self.parts)
        e = sample.e
        for _ in range(self.parts):
            if self.uneven is not None:
                self.uneven.advance(e, step, None)
            else:
                self.inputs.append(scaled(e * step.gamma, self.model.input_set.radius))
            e = step.phi * e


def _diagonal(radii):
    size = len(radii)
    return arb_mat(size, size, [
        arb(radii[i]) if i == j else arb(0) for i in range(size) for j in range(size)
    ])
