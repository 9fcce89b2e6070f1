"""Notebooks with their outputs as pages of the site."""

import json

# Kinds of output that a page shows, the best first.
KINDS = ["image/png", "text/html", "text/plain"]


def is_executed(path):
    """Returns whether a notebook has outputs."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return any(cell.get("outputs") for cell in cells)


def as_markdown(path):
    """Returns a notebook as Markdown: its text, its code, and its outputs."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    parts = []
    for cell in cells:
        text = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(text)
        else:
            parts.append(fenced(text, "python"))
            parts.extend(output(each) for each in cell["outputs"])
    return "\n\n".join(part for part in parts if part) + "\n"


def fenced(text, language):
    """Returns a block of code."""
    return f"```{language}\n{text.rstrip()}\n```"


def output(found):
    """Returns an output of a cell; warnings on standard error are shown as other text."""
    if found["output_type"] == "stream":
        return fenced("".join(found["text"]), "text")
    data = found.get("data", {})
    kind = next((kind for kind in KINDS if kind in data), None)
    content = "".join(data.get(kind, ""))
    if kind == "image/png":
        source = f"data:image/png;base64,{content.strip()}"
        return f'<p><img alt="Figure of the code above" src="{source}"></p>'
    if kind == "text/html":
        lines = " ".join(content.split("\n"))
        return f'<div class="output">{lines}</div>'
    return fenced(content, "text") if kind else ""
