"""Results as HTML, for notebooks."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from typing import Any

GOOD, BAD = "#1a7f4b", "#b3261e"


def table(header: list[str], rows: list[list[str]]) -> str:
    """Return a table whose first column is text."""
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    body = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def verdict(is_good: bool, words: str) -> str:
    """Return a verdict, green or red."""
    return f'<p style="color:{GOOD if is_good else BAD};font-weight:600">{escape(words)}</p>'


def bar(radius: float, largest: float) -> str:
    """Return a small bar as SVG."""
    width = 120 * radius / largest if largest > 0 else 0.0
    return (
        '<svg width="120" height="10" role="img" '
        f'aria-label="{radius:.3g}"><rect width="{width:.1f}" height="10" fill="#4878a8"/></svg>'
    )


def lines(findings: Iterable[object]) -> str:
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
