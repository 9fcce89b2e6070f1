"""Findings and reports: codes, remedies in Python's own form, and the program of the README."""

from __future__ import annotations

from pathlib import Path

import reachtube as rt


def test_findings_have_codes_and_are_written_for_python(
    model: rt.Model, data: rt.Recordings
) -> None:
    findings = model.findings
    assert findings[0].code == "conformant" and findings[0].numbers["rows_outside"] == 0
    assert any(finding.code == "cost" for finding in findings)
    verdict = model.check(data)
    for finding in [*findings, *verdict.findings, *model.report.findings]:
        assert "--" not in str(finding) and "--" not in finding.text, finding
    assert str(findings[0]) in str(model.report)
    assert "<table" in model.report._repr_html_()


def test_the_program_of_five_lines(robot: rt.Robot, data: rt.Recordings, tmp_path: Path) -> None:
    model = rt.conform(robot, data, torque="motor")
    print(*model.findings, sep="\n")
    model.save(tmp_path / "model.json")
    assert bool(model.check(data))
