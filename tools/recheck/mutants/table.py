"""The mutants: name, model that is edited, edit, options, and the exit code that they must get.

0: everything holds; 1: something fails; 2: something is undecided or missing; 3: cannot be judged.
"""

from edits import (
    after, bound, cell, entry, index_line, largest, lines_of, moved, nothing, of_record, point,
    recording, scaled,
)

X0, U = "initial_set.radius", "input_set.radius"
PLANES, POINTS = ["--certificate", "planes.jsonl"], ["--certificate", "points.jsonl"]
REACH = ["--reach", "cubic"]
UNPRICED = after(*(entry(key, None) for key in ("cost", "cost_lower_bound", "optimality_gap")))
ROOMY = after(scaled(X0, 1.02), scaled(U, 1.02))
TO_POINT = after(scaled(X0, 0.0), scaled(U, 0.0))
ZERO_POINT = point("points.jsonl", 490, y=[0.0] * 12)


def by_part(part):
    """Multiplies a number."""
    return lambda value: value * (1.0 + part)


def drop_line(number):
    """Drops a line."""
    return lambda lines: lines.__delitem__(number)


def end_early(rows):
    """Drops the second half of the samples within 0.4 s."""
    del rows[60:]


def swap_columns(rows):
    """Exchanges the columns q1 and q2 with their names."""
    for row in rows:
        row[1], row[2] = row[2], row[1]


def stretch(rows):
    """Makes time pass 1 % more slowly."""
    for row in rows[1:]:
        row[0] = repr(float(row[0]) * 1.01)


def exchange_points(lines):
    """Exchanges what two points say of their factors."""
    lines[5], lines[300] = lines[300], lines[5]


SETS = [
    ("nothing is changed", nothing, 0),
    ("U 0.1 % smaller", scaled(U, 0.999), 1),
    ("U 0.1 % smaller, without costs", after(scaled(U, 0.999), UNPRICED), 1),
    ("the largest U 0.1 % smaller", after(scaled(U, 0.999, largest), UNPRICED), 1),
    ("X0 0.1 % smaller", after(scaled(X0, 0.999), UNPRICED), 1),
    ("the largest X0 1e-9 smaller", after(scaled(X0, 1.0 - 1e-9, largest), UNPRICED), 1),
    ("centre of X0 moved by 1e-6 rad", after(moved("initial_set.centre", 1e-6), UNPRICED), 1),
    ("centre of U moved by 0.01 N m", after(moved("input_set.centre", 0.01), UNPRICED), 1),
    ("an entry of A 1 % larger", after(scaled("a.6", 1.01), UNPRICED), 1),
    ("an entry of B 1 % larger", after(scaled("b.6", 1.01), UNPRICED), 1),
    ("a drift", after(moved("drift", 0.01, 6), UNPRICED), 1),
    ("a nominal start moved", after(moved("data.suites.0.nominal_start", 0.01), UNPRICED), 1),
    ("U 0.1 % larger, with the old cost", scaled(U, 1.001), 1),
    ("U and X0 2 % larger, without costs", after(ROOMY, UNPRICED), 0),
    ("cost 0.1 % larger", entry("cost", by_part(1e-3)), 1),
    ("cost 1e-7 smaller", entry("cost", by_part(-1e-7)), 1),
    ("sum over samples 1e-7 larger", entry("cost_of_samples", by_part(1e-7)), 1),
    ("lower bound 1e-7 larger", entry("cost_lower_bound", by_part(1e-7)), 1),
    ("lower bound 1 % smaller", entry("cost_lower_bound", by_part(-0.01)), 1),
    ("lower bound 1 % smaller, with its gap",
     after(entry("cost_lower_bound", by_part(-0.01)), entry("optimality_gap", 0.0102)), 0),
    ("weights doubled", entry("settings.weights", {"given": [2.0] * 12}), 1),
    ("notion exact", entry("settings.notion", "exact"), 2),
    ("notion phase-plane", entry("settings.notion", "phase-plane"), 2),
    ("a notion that is unknown", entry("settings.notion", "all"), 3),
    ("a constant disturbance", entry("settings.disturbance", "constant"), 1),
    ("a measurable disturbance, with the old cost", entry("settings.disturbance", "measurable"), 1),
    ("positions alone, with the old bound", entry("settings.states", "positions"), 2),
    ("own nominal starts", after(entry("settings.nominal", "own"), UNPRICED), 1),
    ("torques of the motor", after(entry("drive.settings.torque", "motor"), UNPRICED), 1),
    ("all samples", after(entry("settings.until", None), UNPRICED), 1),
    ("half of the samples, with the old cost", entry("settings.until", 0.2), 1),
    ("half of the samples, without costs", after(entry("settings.until", 0.2), UNPRICED), 0),
    ("a suite less, with the old bound", lambda files: files.content["data"]["suites"].pop(), 2),
    ("a noise set, with the old cost",
     entry("noise_set", {"centre": [0.0] * 12, "radius": [1e-3] * 12}), 1),
    ("a link's mass, which compensated torques do not need",
     entry("drive.robot.joint.1.mass", 9.0), 0),
    ("the digest of a recording", entry("data.suites.0.runs.0.sha256", "0" * 64), 2),
    ("version 3", entry("version", 3), 3),
    ("a negative radius", scaled(U, -1.0, largest), 3),
    ("a row of A is missing", lambda files: files.content["a"].pop(), 3),
    ("a number that is no number", entry("cost", float("nan")), 3),
]

RECORDINGS = [
    ("a velocity beyond the set", recording(cell(40, 7, 0.2)), 1),
    ("a velocity beyond the set, not listed", recording(cell(40, 7, 0.2), is_listed=False), 1),
    ("a first position beyond X0", recording(cell(0, 1, 0.01)), 1),
    ("a harmless change, not listed", recording(cell(125, 1, 1e-9), is_listed=False), 2),
    ("a harmless change, listed", recording(cell(125, 1, 1e-9)), 0),
    ("a recording is left out", index_line(lambda line: ""), 2),
    ("a recording of another suite", index_line(lambda line: line.replace("M1a,", "M2b,", 1)), 1),
    ("a recording that does not exist", index_line(lambda line: line.replace("_02.", "_99.")), 3),
    ("a sample is missing", recording(lambda rows: rows.__delitem__(40)), 1),
    ("a recording ends early", recording(end_early, is_listed=False), 2),
    ("time passes more slowly", recording(stretch), 1),
    ("a torque 50 N m larger at one sample", recording(cell(20, 13, 50.0)), 1),
    ("columns exchanged", recording(swap_columns), 3),
    ("a value that is no number", recording(lambda rows: rows[9].__setitem__(3, "nan")), 3),
]

CERTIFICATES = [
    ("exact", "a radius 0.1 % smaller, without certificate", after(scaled(U, 0.999, largest),
                                                                  UNPRICED), [], 2),
    ("exact", "the certificate as it is", nothing, POINTS, 0),
    ("exact", "U 1 % smaller", after(scaled(U, 0.99), UNPRICED), POINTS, 1),
    ("exact", "every second point", nothing, [*POINTS, "--every", "2"], 2),
    ("exact", "a point is missing", lines_of("points.jsonl", drop_line(17)), POINTS, 2),
    ("exact", "a point of another sample", point("points.jsonl", 9, sample=40), POINTS, 2),
    ("exact", "a point of another recording", point("points.jsonl", 9, run="M1a/M1a_01.csv"),
     POINTS, 2),
    ("exact", "factors of no use", ZERO_POINT, POINTS, 2),
    ("exact", "a limit beyond 1", point("points.jsonl", 9, limit=2.0), POINTS, 3),
    ("exact", "the certificate of another notion", point("points.jsonl", 0, notion="phase-plane"),
     POINTS, 2),
    ("exact", "a certificate of version 2", point("points.jsonl", 0, version=2), POINTS, 3),
    ("exact", "a line that is cut off",
     lines_of("points.jsonl", lambda lines: lines.__setitem__(9, lines[9][:40])), POINTS, 3),
    ("planes", "planes as they are", nothing, PLANES, 0),
    ("planes", "planes that claim to be exact", entry("settings.notion", "exact"), PLANES, 2),
    ("planes", "planes that claim to be hulls", entry("settings.notion", "hull"), [], 2),
]

CUBIC = [
    ("the sets as they are", nothing, [], 2),
    ("sets 2 % larger", ROOMY, [], 0),
    ("U 2 % smaller", scaled(U, 0.98), [], 1),
    ("X0 2 % smaller", scaled(X0, 0.98), [], 1),
    ("friction 2 % larger", scaled("drive.acceleration.0.0", 1.02, lambda term: 1), [], 1),
    ("sets of one point", TO_POINT, [], 1),
    ("sets of one point, with the old files", TO_POINT, REACH, 3),
    ("the files as they are", nothing, REACH, 2),
    ("the files of another model", after(ROOMY, recording(cell(9, 7, 1e-6))), REACH, 3),
    ("a bound moved by 0.01", bound(20, 3, -0.01), REACH, 3),
    ("a bound moved by 0.01, and listed", after(bound(20, 3, -0.01), of_record), REACH, 1),
    ("the files of other recordings", after(recording(cell(9, 7, 1e-6)), of_record), REACH, 3),
    ("files without a record", lambda files: files.put("cubic/reach.json", ""), REACH, 3),
    ("rows that are missing", after(lines_of("cubic/M1a.csv", drop_line(-1)), of_record), REACH, 3),
    ("notion exact", after(ROOMY, entry("settings.notion", "exact")), [], 2),
    ("a variable that is unknown", entry("drive.variables.3", "w4"), [], 3),
]

MUTANTS = [
    *(("short", name, edit, [], code) for name, edit, code in SETS + RECORDINGS),
    *CERTIFICATES,
    *(("cubic", *rest) for rest in CUBIC),
]
