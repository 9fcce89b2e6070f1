"""The answer, for people and for programs."""

from math import isfinite

from .claim import NOTIONS
from .verdict import Verdict

ANSWERS = {
    0: "everything holds",
    1: "something fails",
    2: "nothing fails, but something is undecided",
}


def as_text(claim, found, code, count, seconds):
    """Returns the answer for people."""
    lines = []
    for kind, tallies in found.items():
        width = max(len(tally.name) for tally in tallies)
        header = "".join(f"{verdict.name.lower():>11}" for verdict in Verdict)
        lines.append(f"{kind:<{width}}{header}")
        for tally in tallies:
            lines.append(tally.name.ljust(width) + "".join(f"{n:>11}" for n in tally.counts))
        for tally in tallies:
            for finding in tally.worst(count):
                by = f", by up to {finding.excess:.3g}" if isfinite(finding.excess) else ""
                lines.append(
                    f"  {finding.verdict.name.lower()}: {tally.name}: {finding.place}{by}"
                )
    lines += claim.facts
    lines += [f"missing: {missing}" for missing in claim.missing]
    answer = ", provided that ".join([ANSWERS[code], *claim.conditions])
    lines.append(f"notion {claim.notion} ({NOTIONS[claim.notion]}): {answer} "
                 f"({seconds:.1f} s of processor time)")
    return "\n".join(lines)


def as_json(claim, found, notes, code):
    """Returns the answer for programs."""
    parts = {kind: [_part(tally) for tally in tallies] for kind, tallies in found.items()}
    judged = {"notion": claim.notion, "missing": claim.missing, "conditions": claim.conditions,
              "facts": claim.facts}
    return {"exit_code": code, "claim": judged, "notes": notes, **parts}


def _part(tally):
    counts = {verdict.name.lower(): tally.counts[verdict] for verdict in Verdict}
    findings = [
        {
            "verdict": finding.verdict.name.lower(),
            "excess": finding.excess if isfinite(finding.excess) else None,
            "place": finding.place,
        }
        for finding in tally.worst(100)
    ]
    return {"name": tally.name, **counts, "findings": findings}
