"""Certificates: points of the reachable set, points at its boundary, and points outside."""

import csv
import json
import math
import random
from fractions import Fraction
from types import SimpleNamespace

import numpy
import pytest
import toy

from recheck.balls import arb, arb_mat
from recheck.certificate import Certificate
from recheck.cli import main
from recheck.errors import BadInput
from recheck.generators import Columns, Generators
from recheck.grid import Grid
from recheck.membership import Projection, Recipe
from recheck.model import Box
from recheck.reachable import samples
from recheck.system import System
from recheck.verdict import Verdict

LIMIT = 1.0 - 1e-9


def factors_of(g, point, limit):
    """Finds y such that the factors clip(g_j' y, -limit, limit) give about `point`: Newton's
    method on a convex function whose gradient is G clip(G' y) - point, with shorter and shorter
    steps where the value does not fall."""
    scale = 1.0 / numpy.abs(g).sum(axis=1)
    g, point = g * scale[:, None], point * scale

    def value(y):
        product = g.T @ y
        alpha = numpy.clip(product, -limit, limit)
        return (alpha * (product - 0.5 * alpha)).sum() - point @ y

    y = numpy.zeros(len(point))
    for _ in range(100):
        product = g.T @ y
        rest = point - g @ numpy.clip(product, -limit, limit)
        if numpy.abs(rest).max() < 1e-14:
            break
        free = g[:, numpy.abs(product) < limit]
        step = numpy.linalg.solve(free @ free.T + 1e-12 * numpy.eye(len(y)), rest)
        size = 1.0
        while size > 1e-9 and value(y + size * step) > value(y):
            size *= 0.5
        y = y + size * step
    return list(y * scale)


def generators(model, k, h):
    """The generators of the toy at sample k, in doubles from the closed form."""
    r_x, r_u = model["initial_set"]["radius"], model["input_set"]["radius"]
    columns = [toy.exact_step(k * h)[0] * r_x]
    for j in range(k):
        later, earlier = (toy.exact_step((k - i) * h)[1] for i in (j, j + 1))
        columns.append((later - earlier) * r_u)
    return numpy.concatenate(columns, axis=1)


def write_certificate(folder, model, h, notion, samples, held=1):
    """Writes a certificate for the toy's recordings, with generators from the closed form. The
    disturbance is held over `held` steps, counted back from the sample."""
    start = numpy.array(model["data"]["suites"][0]["nominal_start"])
    projections = [[0, 1, 2, 3]] if notion == "exact" else [[0, 2], [1, 3]]
    header = {"format": "reachtube-certificate", "version": 1, "notion": notion,
              "model_sha256": model["sha256"], "limit": LIMIT}
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
        newest = [g[:, 4 + 2 * j : 6 + 2 * j] for j in reversed(range(k))]
        groups = [sum(newest[j : j + held]) for j in range(0, k, held)]
        g = numpy.concatenate([g[:, :4], *groups], axis=1)
        for states in projections if k > 0 else []:
            for file, rows in runs.items():
                point = rows[k, 1:5][states] - centre[states]
                y = factors_of(g[states], point, LIMIT)
                point = {"suite": "S", "run": file, "sample": k, "states": states, "y": y,
                         "held": held}
                lines.append(json.dumps(point))
        centre = phi @ centre + gamma @ (runs["r0.csv"][k, 5:7] + c_u)
    path = folder / "certificate.jsonl"
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize(("notion", "held"), [("exact", 1), ("phase-plane", 1), ("exact", 5)])
def test_points_within_the_set_hold_and_missing_ones_are_open(tmp_path, capsys, notion, held):
    model, samples, h = toy.content(), 12, 0.05
    toy.write(tmp_path, model, runs=3, samples=samples, h=h, part=0.4)
    path = write_certificate(tmp_path, model, h, notion, samples, held)

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


def projection(is_whole=True):
    """Some generators in the plane: the unit square's and a diagonal one."""
    columns = Columns(2, 3)
    columns.append(arb_mat([[1, 0, arb(0.5)], [0, 1, arb(0.5)]]))
    nothing = numpy.zeros((0, 1), dtype=int)
    made = SimpleNamespace(at=lambda sample: [columns], ages=lambda: nothing, is_whole=is_whole)
    return Projection(made, None, [0, 1])


def ball(*numbers):
    return [arb(x) for x in numbers]


def verdict(point, y, limit=LIMIT, is_whole=True):
    return projection(is_whole).judge([(point, Recipe(y, limit))])[0][0]


def test_a_vertex_is_in_the_set_and_a_little_beyond_is_not():
    inside = 1.0 - 2.0**-40
    near = ball(1.5 * inside, 1.5 * inside)
    assert verdict(near, [9.0, 9.0], inside) is Verdict.HOLDS
    # Generators are known to 2^-130, so that no room at all leaves the vertex itself undecided.
    assert verdict(ball(1.5, 1.5), [9.0, 9.0], 1.0) is Verdict.UNDECIDED
    beyond = ball(1.5 * (1.0 + 2.0**-40), 1.5)
    assert verdict(beyond, [9.0, 9.0], inside) is Verdict.FAILS


def test_a_poor_recipe_is_mended_or_proves_nothing():
    for y in ([0.0, 0.0], [0.3, -0.2], [5.0, -5.0], [float("nan"), 0.0], [1e300, 1e300]):
        assert verdict(ball(0.5, 0.25), y) is Verdict.HOLDS
        assert verdict(ball(1.6, 0.25), y) is Verdict.FAILS
    # A point that is known to 0.1 only may be outside.
    assert verdict([arb(1.45, 0.1), arb(0.5)], [0.9, 0.0]) is Verdict.UNDECIDED


def test_factors_with_room_take_what_is_left():
    """On the edge in direction (1, 0) all factors but the second are used up."""
    most = 1.0 - 2.0**-45
    for height in (0.0, -0.95, 0.95):
        assert verdict(ball(1.5 * most, 0.5 * most + height), [9.0, 0.0], most) is Verdict.HOLDS
    assert verdict(ball(1.5 * most, 0.5 * most - 1.01), [9.0, 0.0], most) is not Verdict.HOLDS


def test_what_are_not_all_generators_cannot_prove_a_point_outside():
    assert verdict(ball(2.0, 0.0), [9.0, 0.0]) is Verdict.FAILS
    assert verdict(ball(2.0, 0.0), [9.0, 0.0], is_whole=False) is Verdict.UNDECIDED


def test_combinations_of_columns_are_exact():
    numbers = random.Random(1)
    values = [[numbers.uniform(-1.0, 1.0) * 2.0 ** numbers.randint(-60, 12) for _ in range(3000)]
              for _ in range(2)]
    columns = Columns(2, 3000)
    columns.append(arb_mat([[arb(x) for x in row] for row in values]))
    factors = [numbers.randint(-(2**47), 2**47) * 2.0**-47 for _ in range(2998)] + [1.0, -1.0]
    found = columns.combination([1, 0], numpy.array(factors))
    for total, row in zip(found, (values[1], values[0]), strict=True):
        exact = sum(Fraction(x) * Fraction(a) for x, a in zip(row, factors, strict=True))
        assert (total - arb(exact.numerator) / arb(exact.denominator)).contains(0)
        assert total.rad() < 1e-34


def test_generators_of_parts_of_steps_fill_more_of_the_set():
    """q'' = -q + u over a turn, in 7 steps: the reach in one direction grows with the parts of a
    step toward the measurable one, which is 4."""
    model = SimpleNamespace(
        joints=1, a=[[0.0, 1.0], [-1.0, 0.0]], b=[[0.0], [1.0]], drift=[0.0, 0.0],
        initial_set=Box((0.0, 0.0), (0.0, 0.0)), input_set=Box((0.0,), (1.0,)),
        noise_radius=(0.0, 0.0), settings={"disturbance": "measurable"},
    )
    system, times = System(model), [2.0 * math.pi * (k + 0.3 * (k % 2)) / 7 for k in range(7)]
    grids = [Grid((*times, 2.0 * math.pi), None), Grid(tuple(k * 0.75 for k in range(8)), 0.75)]
    case = SimpleNamespace(start=[0.0, 0.0], doubt=[0.0], inputs=[[0.0]] * 8)
    for grid in grids:
        case.grid, reached = grid, []
        for parts in (1, 3, 16):
            made = Generators(model, system, grid, parts)
            for sample in samples(model, system, grid, [case]):
                columns = made.at(sample)
                ages = made.ages()
                made.advance(sample)
            # The youngest part of a step is the one that ends at the sample.
            youngest = columns[1].rounded([0, 1])[:, ages[:, 0] == 0]
            last_part = system.step(grid.span(6) / parts).gamma
            assert youngest[:, 0] == pytest.approx([float(x) for x in last_part.entries()])
            assert sorted(ages[:, 0]) == list(range(7 * parts))
            reached.append(sum(numpy.abs(part.rounded([1])).sum() for part in columns))
        assert reached[0] < reached[1] < reached[2] <= float(sample.radius[1, 0]) + 1e-12
        assert reached[2] == pytest.approx(float(sample.radius[1, 0]), rel=2e-2)


def test_steps_that_share_their_factors_have_the_sum_of_their_generators():
    """Generators 1, 2, 4, 8, 16 of one input, the newest last: counted back, three and then two
    steps share their factors. The generators of X0 are for themselves."""
    start, inputs = Columns(1, 1), Columns(1, 5)
    start.append(arb_mat([[0.5]]))
    inputs.append(arb_mat([[1, 2, 4, 8, 16]]))
    made = SimpleNamespace(at=lambda sample: [start, inputs], is_whole=True,
                           ages=lambda: numpy.arange(5)[::-1, None])
    found = Projection(made, None, [0])._factors([Recipe([0.01], 0.25, 3)], 3)
    assert found[:, 0] == pytest.approx([0.005, 0.03, 0.03, 0.25, 0.25, 0.25])


HEADER = {"format": "reachtube-certificate", "version": 1, "notion": "exact", "model_sha256": "ab"}


@pytest.mark.parametrize("line", [
    "[" * 100_000, '{"suite": "A"}', '{"suite": "A", "sample": []}', "null", "\udcff", "1e",
])
def test_a_line_that_is_no_point_is_refused(tmp_path, line):
    model = SimpleNamespace(joints=1, states=2, settings={"disturbance": "sample"}, sha256="ab")
    path = tmp_path / "points.jsonl"
    path.write_bytes(f"{json.dumps(HEADER)}\n{line}\n".encode(errors="surrogateescape"))
    with pytest.raises(BadInput):
        Certificate(model, None, path, 1, [])


def test_a_number_beyond_all_doubles_is_refused(tmp_path):
    model = SimpleNamespace(joints=1, states=2, settings={"disturbance": "sample"}, sha256="ab")
    path = tmp_path / "points.jsonl"
    path.write_text(json.dumps(HEADER) + "\n")
    made = Certificate(model, None, path, 1, [])
    point = {"suite": "A", "run": "A_1.csv", "sample": 1, "states": [0, 1], "limit": 0.9,
             "y": [10**400, 0]}
    with pytest.raises(BadInput):
        made._take(SimpleNamespace(k=1), point, {}, {})
