"""The command line."""

import argparse
import json
import sys
import time

from . import outer, report
from .certificate import Certificate
from .claim import Claim
from .cost import Costs
from .errors import BadInput
from .grid import distinct
from .hulls import HullRows
from .inputs import Inputs, read_inputs
from .manifest import root
from .model import read_model
from .reach_files import ReachFiles, check_record
from .reachable import samples
from .recordings import read_index, read_places, read_run
from .system import System
from .verdict import exit_code

EXIT_CODES = """\
Exit codes: 0 everything holds; 1 something fails; 2 nothing fails, but something is undecided;
3 a file or an option cannot be judged."""


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        raise BadInput(f"{message}; see --help")


def parser():
    """Returns the parser of the command line."""
    found = _Parser(
        prog="recheck",
        description="Checks a model of reachtube against recordings a second time, with ball "
        "arithmetic.",
        epilog=EXIT_CODES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = found.add_argument
    add("model", help="model file that `reachtube conform` wrote")
    add("--data", required=True, metavar="FOLDER", help="recordings with their runs.csv")
    add("--suites", metavar="A,B", help="suites to check; by default the model file's")
    add("--any-run", action="store_true",
        help="check the sets any_run, which hold for every run")
    add("--inputs", metavar="FILE", help="inputs u that define the model, as CSV: file,k,u1,...")
    add("--reach", metavar="FOLDER", help="CSV files of `reachtube reach`, to be checked too")
    add("--certificate", metavar="FILE", help="certificate of `conform`, for points in the set")
    add("--every", type=int, default=1, metavar="N",
        help="check only every N-th sample of a certificate (default %(default)s)")
    add("--input-error", type=float, default=1e-12, metavar="U",
        help="how far inputs computed here may be from the inputs that define the model, N m "
        "(default %(default)s)")
    add("--list", type=int, default=5, metavar="N",
        help="findings to print for each suite (default %(default)s)")
    add("--json", action="store_true", help="print the result as JSON")
    return found


def run(arguments):
    """Judges what the arguments name. Returns the claim of the model, the tallies by what they are
    about, and notes."""
    model = read_model(arguments.model, arguments.any_run)
    claim, notes = Claim.of_model(model), list(model.notes)
    given = read_inputs(arguments.inputs, model.joints) if arguments.inputs else None
    judge = run_of_linear if model.polynomials is None else run_of_outer_sets
    return claim, judge(arguments, model, claim, given, notes), notes


def run_of_linear(arguments, model, claim, given, notes):
    """Judges a linear model. Returns the tallies."""
    system = System(model)
    inputs = Inputs(model, system, arguments.input_error, given)
    cases = read_cases(model, inputs, arguments, claim, notes)
    if not inputs.is_exact and given is None:
        claim.rests_on_inputs(arguments.input_error)
    visitors, certificate = {"rows": HullRows(model, cases)}, None
    if arguments.reach:
        check_record(model, arguments.reach, cases)
        visitors["bounds"] = ReachFiles(model, arguments.reach, cases)
    if arguments.certificate:
        certificate = Certificate(model, system, arguments.certificate, arguments.every, cases)
        visitors["points"] = certificate
        notes += certificate.notes
    claim.needs_points(model, certificate, arguments.every)
    if {case.suite for case in cases} == {suite["name"] for suite in model.suites} and (
        not arguments.any_run
    ):
        visitors["costs"] = Costs(model, cases)
    for grid in distinct([case.grid for case in cases]):
        here = [case for case in cases if case.grid.is_prefix_of(grid)]
        cases = [case for case in cases if not case.grid.is_prefix_of(grid)]
        for visitor in visitors.values():
            visitor.start(grid)
        for sample in samples(model, system, grid, here):
            for visitor in visitors.values():
                visitor.visit(sample, here)
    found = {kind: list(visitor.results()) for kind, visitor in visitors.items()}
    if "costs" in visitors:
        claim.facts += visitors["costs"].facts
    return {kind: tallies for kind, tallies in found.items() if tallies}


def run_of_outer_sets(arguments, model, claim, given, notes):
    """Judges a model that is not linear, as `run_of_linear` does, by sets computed here."""
    if arguments.certificate or arguments.any_run or model.correction is not None:
        raise BadInput(
            f"{arguments.model}: the model is not linear: certificates, any_run and corrections "
            f"of inputs are judged for linear models only"
        )
    inputs = Inputs(model, None, arguments.input_error, given)
    cases = read_cases(model, inputs, arguments, claim, notes)
    if not inputs.is_exact and given is None:
        claim.rests_on_inputs(arguments.input_error)
    claim.needs_points(model, None, 1)
    if arguments.reach:
        check_record(model, arguments.reach, cases)
    found, more = outer.judge(model, cases, arguments.reach)
    notes += more
    return found


def read_cases(model, inputs, arguments, claim, notes):
    """Reads the suites and returns their cases; notes which recordings of the claim are missing."""
    index = read_index(arguments.data)
    listed = {suite["name"]: suite.get("runs", []) for suite in model.suites}
    names = arguments.suites.split(",") if arguments.suites else list(listed)
    cases, entries = [], []
    if not names:
        raise BadInput(f"{arguments.model}: the model file lists no suite; name some with --suites")
    for name in names:
        if name not in index:
            raise BadInput(f"{arguments.data}: there is no suite {name!r} in runs.csv")
        until = model.settings.get("until")
        runs = [
            read_run(arguments.data, file, place, model.joints, until)
            for file, place in index[name]
        ]
        entries += [(run.file, name, run.sha256) for run in runs]
        hashes = {run.file: run.sha256 for run in runs}
        changed = [r["file"] for r in listed.get(name, []) if hashes.get(r["file"]) != r["sha256"]]
        if changed:
            claim.missing.append(
                f"suite {name}: {len(changed)} recordings that the model file lists are missing or "
                f"differ; the first is {changed[0]}"
            )
        if name not in listed and model.settings["nominal"] == "mean":
            notes.append(
                f"suite {name}: the model file has no nominal start, so it is the mean of the "
                f"first states here"
            )
        cases += inputs.cases(name, runs)
    if model.root is not None and set(listed) <= set(names):
        places = read_places(arguments.data)
        here = [(places[file], file, *rest) for file, *rest in entries if rest[0] in listed]
        if root(here) != model.root:
            claim.missing.append(
                "the recordings differ from the model file's, which does not list them: the "
                "root over their entries is another one"
            )
    return cases


def main(arguments=None):
    """Runs the command and returns its exit code."""
    started = time.process_time()
    try:
        parsed = parser().parse_args(arguments)
        if parsed.every < 1 or parsed.list < 0 or not parsed.input_error >= 0.0:
            raise BadInput("--every, --list or --input-error is too small; see --help")
        claim, found, notes = run(parsed)
    except BadInput as error:
        print(f"error: {error}", file=sys.stderr)
        return 3
    for note in notes:
        print(f"note: {note}", file=sys.stderr)
    code = claim.code(exit_code([tally for tallies in found.values() for tally in tallies]))
    if parsed.json:
        print(json.dumps(report.as_json(claim, found, notes, code), indent=2))
    else:
        print(report.as_text(claim, found, code, parsed.list, time.process_time() - started))
    return code
