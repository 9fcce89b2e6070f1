"""The gains kappa of the disturbance: how far it can push each state (docs/method.md, section 4).

Each class takes the samples one after another: `advance(e, step, span)` goes on from the sample
with e^{At} = `e` by one span, and `value(gamma)` is kappa at the present sample, where `gamma` is
Gamma(t) there.
"""

from .balls import arb, arb_mat, magnitudes, zeros
from .integral import integral_of_magnitudes


class Constant:
    """A disturbance that is constant over the run: |Gamma|."""

    def __init__(self, system):
        pass

    def advance(self, e, step, span):
        """Nothing is summed."""

    def value(self, gamma):
        """Returns kappa."""
        return magnitudes(gamma)


class EvenSamples:
    """A disturbance that is held over each sample of a uniform grid: a running sum of
    |e^{A jh} Gamma(h)|."""

    def __init__(self, system):
        self.sum = zeros(system.states, system.inputs)

    def advance(self, e, step, span):
        """Adds the increment of one more sample."""
        self.sum = self.sum + magnitudes(e * step.gamma)

    def value(self, gamma):
        """Returns kappa."""
        return self.sum


class UnevenSamples:
    """The same on any other grid: the increments Gamma(t_k - t_j) - Gamma(t_k - t_{j+1}) of all
    earlier samples side by side, which each span multiplies by its e^{Ah}."""

    def __init__(self, system):
        self.states, self.inputs = system.states, system.inputs
        self.increments = arb_mat(system.states, 0)

    def advance(self, e, step, span):
        """Moves the increments on by one span and appends the span's own increment."""
        width, m = self.increments.ncols(), self.inputs
        old, new = (step.phi * self.increments).entries(), step.gamma.entries()
        rows = (
            [*old[i * width : (i + 1) * width], *new[i * m : (i + 1) * m]]
            for i in range(self.states)
        )
        self.increments = arb_mat(list(rows))

    def value(self, gamma):
        """Returns kappa."""
        width, m = self.increments.ncols(), self.inputs
        sizes = [abs(x) for x in self.increments.entries()]
        return arb_mat(self.states, m, [
            sum(sizes[i * width + j : (i + 1) * width : m], arb(0))
            for i in range(self.states) for j in range(m)
        ])


class Measurable:
    """A disturbance that may change at any time: the integral of |e^{At} B|."""

    def __init__(self, system):
        self.system = system
        self.sum = zeros(system.states, system.inputs)

    def advance(self, e, step, span):
        """Adds the integral over one span."""
        self.sum = self.sum + integral_of_magnitudes(self.system, e, step, span)

    def value(self, gamma):
        """Returns kappa."""
        return self.sum


def gains(disturbance, system, grid):
    """Returns the gains of a class of disturbances on a grid."""
    if disturbance == "constant":
        return Constant(system)
    if disturbance == "measurable":
        return Measurable(system)
    return EvenSamples(system) if grid.step is not None else UnevenSamples(system)
