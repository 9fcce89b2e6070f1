"""Verdicts: what holds, what fails, and what the bounds leave open."""

from dataclasses import dataclass, field
from enum import IntEnum

from .balls import up


class Verdict(IntEnum):
    """The answer to one claim; the worse, the larger."""

    HOLDS = 0
    UNDECIDED = 1
    FAILS = 2


def of_margin(margin):
    """Judges a claim by a ball around its margin, which the claim says is not negative."""
    if margin >= 0:
        return Verdict.HOLDS
    return Verdict.FAILS if margin < 0 else Verdict.UNDECIDED


@dataclass(frozen=True)
class Finding:
    """A claim that does not hold, or is not decided."""

    verdict: Verdict
    # Up to this much the value may be outside, rad or rad/s.
    excess: float
    place: str


@dataclass
class Tally:
    """Counts of the claims of one kind in one part, with the worst findings."""

    name: str
    counts: list = field(default_factory=lambda: [0, 0, 0])
    findings: list = field(default_factory=list)

    def add(self, verdict, margin=None, place=""):
        """Counts a claim. `margin` is a ball, and `place` says what it is about."""
        self.counts[verdict] += 1
        if verdict is not Verdict.HOLDS:
            excess = up(-margin) if margin is not None else float("inf")
            self.findings.append(Finding(verdict, excess, place))

    @property
    def total(self):
        """Number of claims."""
        return sum(self.counts)

    def worst(self, count):
        """Returns the worst findings."""
        return sorted(self.findings, key=lambda f: (-f.verdict, -f.excess))[:count]


def exit_code(tallies):
    """0 where all claims hold, 1 where one fails, 2 where one is undecided and none fails."""
    failed, open_ = (sum(t.counts[v] for t in tallies) for v in (Verdict.FAILS, Verdict.UNDECIDED))
    return 1 if failed else 2 if open_ else 0
