"""The rows of whole commands."""

import hashlib
from pathlib import Path

import numpy
import peers
import recordings
from measure import in_turn

COPIES = 30
ROOT = Path(__file__).resolve().parents[2]


def rows_of_commands(builds, folder, options):
    """Yields each row: work, what each build takes, what a peer takes, the limit."""
    for work, arguments, peer, limit in works(builds, folder, options.long):
        if options.only not in work:
            continue
        commands = [command(build, arguments, folder) for build in builds]
        rounds = 1 if work.startswith("model 2") else options.rounds
        *costs, other = in_turn([*commands, peer and peer[1]], rounds)
        yield work, costs, f"{peer[0]}: {other}" if peer else "-", limit


def command(build, arguments, folder):
    """Returns the command of a build. The oldest builds know no --quiet, and name models
    otherwise."""
    # Newer builds overwrite no file of the oldest, which carries no mark.
    out = f"{build.name}.json" if "conform" in arguments else f"{build.name}.toml"
    arguments = [*arguments, "--out", folder / out]
    if build.name == "now":
        return [build.command, "--quiet", *arguments]
    renamed = {"--paper-model": "--model"} if not knows(build, "--paper-model") else {}
    return [build.command, *(renamed.get(part, part) for part in arguments)]


def knows(build, option):
    """Returns whether the command `conform` of a build has an option."""
    return option.encode() in build.command.read_bytes()


def works(builds, folder, is_long):
    """Yields each work with its arguments, its peer and its limit."""
    data = recordings.base(builds[-1].command, ROOT, folder)
    few = recordings.runs_of(data, folder / "few", COPIES * len(recordings.recorded(data)))
    many = recordings.suites_of(data, folder / "many", COPIES)
    whole = recordings.joined(many, folder / "whole.csv")
    limit = reading_limit(whole)
    common = ("conform", "--robot", "lwa4p", "--torque", "compensated", "--data")
    one = ("polars, one file", peers.polars(peers.POLARS_ONE, whole))
    files = ("polars, all files", peers.polars(peers.POLARS_MANY, many))
    yield "linear, 73 runs", [*common, data], None, "-"
    yield "linear, 2,190 runs in 4 suites", [*common, few], one, limit
    yield "linear, the same in 120 suites", [*common, many], files, limit
    yield "notion `exact`, 73 runs", [*common, data, "--notion", "exact"], None, "-"
    yield "model 1, p = 3, 73 runs", [*common, data, "--order", "3"], None, "-"
    settings = ROOT / "docs/identify/ur10e.toml"
    if (ROOT.parent / "shared/data/ur10e").is_dir():
        yield "`identify`, UR10e", ["identify", "--settings", settings], None, "-"
    if is_long:
        model = ["--order", "5", "--paper-model", "2"]
        yield "model 2, p = 5, 73 runs", [*common, data, *model], None, "-"


def reading_limit(whole):
    """Words the time to read the bytes once from memory and to digest them on one core."""
    content = numpy.fromfile(whole, numpy.uint8)
    words = content[: len(content) // 8 * 8].view(numpy.uint64)
    reading = peers.least_time(words.max, count=1)
    digest = peers.least_time(lambda: hashlib.sha256(content), count=1, rounds=3)
    return f"reading {reading:.2f} s, SHA-256 {digest:.2f} s"
