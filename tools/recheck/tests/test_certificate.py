"""Certificates: points of the reachable set, points at its boundary, and points outside."""

import csv
import json
import random
from fractions import Fraction

import numpy
import pytest
import toy
from recheck.balls import arb, arb_mat
from recheck.cli import main
from recheck.generators import Columns
from recheck.membership import Projection
from recheck.verdict import Verdict


def weights_of(g, point, rounds=200):
    """Finds directions, and weights >= 0, whose vertices G sign(G' l) sum to about `point`: the
    direction of the rest is added, and all weights are found anew, until the rest is small."""
    directions, vertices = [], numpy.zeros((len(point), 0))
    weights, rest = numpy.zeros(0), point
    scale = 1.0 / numpy.abs(g).sum(axis=1)
    for _ in range(rounds):
        if numpy.abs(rest * scale).max() < 1e-13:
            break
        directions.append(rest * scale**2)
        vertex = g @ numpy.where(g.T @ directions[-1] >= 0.0, 1.0, -1.0)
        vertices = numpy.column_stack([vertices, vertex])
        weights = not_negative(vertices * scale[:, None], point * scale)
        rest = point - vertices @ weights
    return [list(l) for l in directions], list(weights)


def not_negative(a, b):
    """The least squares of a w = b with w >= 0, by active sets (Lawson and Hanson 1974)."""
    w, used = numpy.zeros(a.shape[1]), numpy.zeros(a.shape[1], dtype=bool)
    for _ in range(10 * a.shape[1]):
        gradient = numpy.where(used, -numpy.inf, a.T @ (b - a @ w))
        if used.all() or gradient.max() <= 1e-15:
            break
        used[gradient.argmax()] = True
        while True:
            inner = numpy.zeros_like(w)
            inner[used] = numpy.linalg.lstsq(a[:, used], b, rcond=None)[0]
            if (inner[used] > 0.0).all():
                w = inner
                break
            below = used & (inner <= 0.0)
            step = (w[below] / (w[below] - inner[below])).min()
            w = w + step * (inner - w)
            used &= w > 1e-15
            w[~used] = 0.0
    return w


def generators(model, k, h):
    """The generators of the toy at sample k, in doubles from the closed form."""
    r_x, r_u = model["initial_set"]["radius"], model["input_set"]["radius"]
    columns = [toy.exact_step(k * h)[0] * r_x]
    for j in range(k):
        later, earlier = (toy.exact_step((k - i) * h)[1] for i in (j, j + 1))
        columns.append((later - earlier) * r_u)
    return numpy.concatenate(columns, axis=1)


def write_certificate(folder, model, h, notion, samples):
    """Writes a certificate for the toy's recordings, with generators from the closed form."""
    start = numpy.array(model["data"]["suites"][0]["nominal_start"])
    projections = [[0, 1, 2, 3]] if notion == "exact" else [[0, 2], [1, 3]]
    header = {"format": "reachtube-certificate", "version": 1, "notion": notion,
              "model_digest": model["sha256"]}
    lines = [json.dumps(header)]
    runs = {}
    for path in sorted((folder / "data").glob("r[0-9].csv")):
        with open(path) as file:
            rows = list(csv.reader(file))[1:]
        runs[path.name] = numpy.array([[float(x) for x in row] for row in rows])
    c_x, c_u = (numpy.array(model[name]["centre"]) for name in ("initial_set", "input_set"))
    phi, gamma = toy.exact_step(h)
    centre = start + c_x
    for k in range(samples):
        g = generators(model, k, h)
        for states in projections if k > 0 else []:
            for file, rows in runs.items():
                point = rows[k, 1:5][states] - centre[states]
                directions, weights = weights_of(g[states], point)
                points = [{"file": file, "weights": weights}]
                group = {"suite": "S", "sample": k, "states": states, "directions": directions,
                         "points": points}
                lines.append(json.dumps(group))
        centre = phi @ centre + gamma @ (runs["r0.csv"][k, 5:7] + c_u)
    path = folder / "certificate.jsonl"
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("notion", ["exact", "phase-plane"])
def test_points_within_the_set_hold_and_missing_ones_are_open(tmp_path, capsys, notion):
    model, samples, h = toy.content(), 12, 0.05
    toy.write(tmp_path, model, runs=3, samples=samples, h=h, part=0.4)
    path = write_certificate(tmp_path, model, h, notion, samples)

    def judged(*options):
        code = main([str(tmp_path / "model.json"), "--data", str(tmp_path / "data"), "--json",
                     "--certificate", str(path), *options])
        return code, json.loads(capsys.readouterr().out)["points"][0]

    points = samples * 3 * (1 if notion == "exact" else 2)
    code, found = judged()
    assert (code, found["holds"]) == (0, points)
    code, found = judged("--every", "3")
    assert (code, found["holds"]) == (0, points // 3)
    path.write_text("\n".join(path.read_text().splitlines()[:-1]) + "\n")
    code, found = judged()
    assert (code, found["holds"], found["undecided"]) == (2, points - 1, 1)


def test_a_smaller_set_does_not_hold_the_same_points(tmp_path, capsys):
    model, samples, h = toy.content(), 8, 0.05
    toy.write(tmp_path, model, runs=2, samples=samples, h=h, part=0.4)
    path = write_certificate(tmp_path, model, h, "exact", samples)
    for name in ("initial_set", "input_set"):
        model[name]["radius"] = [0.02 * r for r in model[name]["radius"]]
    (tmp_path / "model.json").write_text(json.dumps(model))
    code = main([str(tmp_path / "model.json"), "--data", str(tmp_path / "data"), "--json",
                 "--certificate", str(path)])
    found = json.loads(capsys.readouterr().out)["points"][0]
    assert code == 1 and found["fails"] > found["undecided"] and found["holds"] == 0


def projection(directions):
    """Some generators in the plane: the unit square's and a diagonal one."""
    columns = Columns(2, 3)
    columns.append(arb_mat([[1, 0, arb(0.5)], [0, 1, arb(0.5)]]))
    return Projection([columns], [0, 1], directions)


def ball(*numbers):
    return [arb(x) for x in numbers]


def test_a_vertex_is_in_the_set_and_a_little_beyond_is_not():
    plane, inside = projection([[1.0, 1.0]]), 1.0 - 2.0**-40
    near = ball(1.5 * inside, 1.5 * inside)
    assert plane.judge([(near, [inside])])[0][0] is Verdict.HOLDS
    beyond = ball(1.5 * (1.0 + 2.0**-40), 1.5)
    assert plane.judge([(beyond, [inside])])[0][0] is Verdict.FAILS
    # The vertex itself is in the set, and nothing is left to absorb a rest.
    assert plane.judge([(ball(1.5, 1.5), [inside])])[0][0] is Verdict.UNDECIDED


def test_a_wrong_recipe_proves_nothing():
    plane, point = projection([[1.0, 1.0], [1.0, -1.0]]), ball(0.5, 0.25)
    for weights in ([1.5, 0.0], [0.9, -0.5], [0.5], [float("nan"), 0.0]):
        assert plane.judge([(point, weights)])[0][0] is not Verdict.HOLDS
    # A poor recipe is mended where the factors have room, and the point is proved all the same.
    assert plane.judge([(point, [0.1, 0.1])])[0][0] is Verdict.HOLDS


def test_factors_with_room_take_what_is_left():
    """On the edge in direction (1, 0) all factors but the second are used up."""
    plane, most = projection([[1.0, 1.0], [1.0, -1e-9]]), 1.0 - 2.0**-45
    point = ball(1.5 * most, 0.5 * most + 1e-3)
    assert plane.judge([(point, [most / 2, most / 2])])[0][0] is Verdict.HOLDS


def test_sums_of_columns_are_exact():
    numbers = random.Random(1)
    values = [[numbers.uniform(-1.0, 1.0) * 2.0 ** numbers.randint(-60, 12) for _ in range(3000)]
              for _ in range(2)]
    columns = Columns(2, 3000)
    columns.append(arb_mat([[arb(x) for x in row] for row in values]))
    signs = numpy.array([[numbers.choice((-1.0, 1.0))] for _ in range(3000)])
    (found,) = columns.sums([0, 1], signs)
    for i in range(2):
        exact = sum(Fraction(x) * int(s) for x, s in zip(values[i], signs[:, 0], strict=True))
        off = found[i] - arb(exact.numerator) / arb(exact.denominator)
        assert off.contains(0) and found[i].rad() < 1e-34
