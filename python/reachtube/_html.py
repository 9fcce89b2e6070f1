"""Results as HTML, for notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from html import escape
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._built import BuiltModel
    from ._findings import Finding
    from ._model import Check, Model

GOOD, BAD = "#1a7f4b", "#b3261e"


def table(header: list[str], rows: list[list[str]]) -> str:
    """Return a table whose first column is text."""
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    body = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def verdict(is_good: bool, words: str) -> str:
    """Return a verdict, green or red."""
    return f'<p style="color:{GOOD if is_good else BAD};font-weight:600">{escape(words)}</p>'


def rows_of_sets(model: Model) -> Iterator[tuple[str, str, str, float, float]]:
    """Yield set, entry, unit, centre and radius of all entries."""
    n = model.joints
    units = list(model.state_units)
    states = [f"q{j + 1}" for j in range(n)] + [f"qd{j + 1}" for j in range(n)]
    forces = ["N" if unit == "m" else "N m" for unit in units[:n]]
    inputs = [f"u{j + 1}" for j in range(n)]
    boxes = [("X0", states, units, model.initial_set), ("U", inputs, forces, model.input_set)]
    if model.noise_set is not None:
        boxes.append(("V", states, units, model.noise_set))
    for name, entries, own, box in boxes:
        for k, entry in enumerate(entries):
            yield name, entry, own[k], float(box.centre[k]), float(box.radius[k])


def bar(radius: float, largest: float) -> str:
    """Return a small bar as SVG."""
    width = 120 * radius / largest if largest > 0 else 0.0
    return (
        '<svg width="120" height="10" role="img" '
        f'aria-label="{radius:.3g}"><rect width="{width:.1f}" height="10" fill="#4878a8"/></svg>'
    )


def lines(findings: Iterable[Finding]) -> str:
    """Return findings as paragraphs."""
    return "".join(f"<p>{escape(str(finding))}</p>" for finding in findings)


def report(sections: list[dict[str, Any]]) -> str:
    """Return the sections of a report."""
    text = ""
    for section in sections:
        title = section["title"]
        text += f"<h4>{escape(title)}</h4>" if title else ""
        text += "".join(f"<p>{escape(each['written'])}</p>" for each in section["findings"])
        for each in section["tables"]:
            rows = [[escape(cell) for cell in row] for row in each["rows"]]
            text += table(each["header"], rows)
        text += "".join(
            f"<p>{escape(name)}: {escape(value)}</p>" for name, value in section["facts"]
        )
    return text


def model(found: Model) -> str:
    """Return verdict, sets and their radii as bars."""
    findings = found.findings
    of = {finding.code: finding for finding in findings}
    text = verdict(found.verified, str(findings[0]))
    text += lines(each for each in findings if each.code == "cost" or each.severity != "info")
    rows = list(rows_of_sets(found))
    largest: dict[tuple[str, str], float] = {}
    for name, _, unit, _, radius in rows:
        largest[name, unit] = max(radius, largest.get((name, unit), 0.0))
    cells = [
        [name, entry, f"{centre:.4g}", f"{radius:.4g}", escape(unit),
         bar(radius, largest[name, unit])]
        for name, entry, unit, centre, radius in rows
    ]
    text += table(["set", "entry", "centre", "radius", "unit", ""], cells)
    return text + lines(of[code] for code in ("next-motion", "no-guarantee") if code in of)


def check(found: Check) -> str:
    """Return verdict and one row for each suite."""
    text = verdict(found.conformant, str(found.findings[0]))
    rows = []
    for suite in found.suites:
        worst = suite["violations"]["worst"] or {}
        place = f"{worst['state']} at {worst['time']:.3f} s in {worst['run']}" if worst else ""
        excess = f"{worst['excess']:.3g}" if worst else ""
        count = str(suite["violations"]["count"])
        rows.append([escape(suite["suite"]), str(suite["runs"]), count, excess, escape(place)])
    return text + table(["suite", "runs", "outside", "furthest", "where"], rows)


def built(found: BuiltModel, words: str) -> str:
    """Return verdict, sets beside the motion, and the comparison with what was held out."""
    text = verdict(found.useful, words)
    said = [str(finding) for finding in found.findings if finding.severity != "info"]
    text += "".join(f"<p>{escape(sentence)}</p>" for sentence in said)

    def number(value: float | None, form: str) -> str:
        return "-" if value is None else format(value, form)

    rows = [
        [
            escape(row.name),
            number(row.half_width, ".3g"),
            number(row.ratio, ".0%"),
            number(row.growth, ".3g"),
        ]
        for row in found.joints
    ]
    header = ["joint", "half the set [rad or m]", "of its motion", "factor, held out"]
    return text + table(header, rows)
