"""Edits of models, recordings, certificates and reachable sets: functions that change a copy."""

import csv
import hashlib
import json


class Files:
    """A copy of the experiment's files, which an edit changes."""

    def __init__(self, folder, model):
        self.folder, self.name = folder, model
        self.path = folder / f"{model}.json"
        self.content = json.loads(self.path.read_text())

    def put(self, name, text):
        """Writes a file of the copy anew; the original keeps its content."""
        path = self.folder / name
        path.unlink(missing_ok=True)
        path.write_text(text)

    def read(self, name):
        """Returns the text of a file."""
        return (self.folder / name).read_text()

    def seal(self):
        """Writes the model, if it was changed, with the digest of its content."""
        if self.content == json.loads(self.path.read_text()):
            return
        self.content["sha256"] = ""
        text = json.dumps(self.content, separators=(",", ":"))
        self.content["sha256"] = hashlib.sha256(text.encode()).hexdigest()
        self.put(self.path.name, json.dumps(self.content, separators=(",", ":")))

    def relist(self):
        """Lists the recordings with the digests that they have now."""
        for suite in self.content["data"]["suites"]:
            for run in suite["runs"]:
                run["sha256"] = _digest(self.folder / "recordings" / run["file"])

    def record(self, **changes):
        """Writes the record of the reachable sets anew, for the model and the files as they are."""
        record = json.loads(self.read("cubic/reach.json"))
        record["model_sha256"] = self.content["sha256"]
        for entry in record["files"]:
            entry["sha256"] = _digest(self.folder / "cubic" / entry["file"])
        self.put("cubic/reach.json", json.dumps(record | changes))


def _digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


# Edits of the model's content.


def scaled(place, factor, index=None):
    """Multiplies the numbers at a place, or one of them."""
    def edit(files):
        values = _at(files.content, place)
        for i in range(len(values)) if index is None else [index(values)]:
            values[i] = values[i] * factor
    return edit


def moved(place, by, index=0):
    """Adds to a number at a place."""
    def edit(files):
        _at(files.content, place)[index] += by
    return edit


def entry(place, value):
    """Sets an entry; drops it if the value is None."""
    def edit(files):
        *path, last = place.split(".")
        parent = _at(files.content, ".".join(path)) if path else files.content
        last = int(last) if last.isdigit() else last
        if value is None:
            del parent[last]
        else:
            parent[last] = value(parent[last]) if callable(value) else value
    return edit


def _at(content, place):
    for key in place.split("."):
        content = content[int(key)] if key.isdigit() else content[key]
    return content


def largest(values):
    """The index of the largest number."""
    return max(range(len(values)), key=lambda i: values[i])


# Edits of recordings. A line is a sample.


def recording(change, is_listed=True, name="M1a/M1a_02.csv"):
    """Changes the cells of a recording, which are lists of text by sample."""
    def edit(files):
        path = f"recordings/{name}"
        rows = list(csv.reader(files.read(path).splitlines()))
        change(rows)
        files.put(path, "\n".join(",".join(row) for row in rows) + "\n")
        if is_listed:
            files.relist()
    return edit


def cell(sample, column, by):
    """Adds to one value; the first column is the time."""
    def change(rows):
        rows[1 + sample][column] = repr(float(rows[1 + sample][column]) + by)
    return change


def index_line(change):
    """Changes the lines of runs.csv about one recording."""
    def edit(files):
        lines = files.read("recordings/runs.csv").splitlines()
        kept = [change(line) if "M1a_02" in line else line for line in lines]
        files.put("recordings/runs.csv", "\n".join(line for line in kept if line) + "\n")
    return edit


# Edits of certificates and of reachable sets.


def lines_of(name, change):
    """Changes the lines of a file."""
    def edit(files):
        lines = files.read(name).splitlines()
        change(lines)
        files.put(name, "\n".join(lines) + "\n")
    return edit


def point(name, number, **changes):
    """Changes the entries of one point of a certificate; the header has number 0."""
    def change(lines):
        found = json.loads(lines[number])
        for key, value in changes.items():
            found[key] = value(found[key]) if callable(value) else value
        lines[number] = json.dumps(found)
    return lines_of(name, change)


def bound(row, column, by):
    """Moves a bound that `reach` printed."""
    def change(lines):
        cells = lines[row].split(",")
        cells[column] = repr(float(cells[column]) + by)
        lines[row] = ",".join(cells)
    return lines_of("cubic/M1a.csv", change)


def after(*edits):
    """Does several edits."""
    def edit(files):
        for one in edits:
            one(files)
    return edit


def nothing(files):
    """Changes nothing."""


def of_record(files):
    """Names the model as it is now in the record of the reachable sets."""
    files.seal()
    files.record()
