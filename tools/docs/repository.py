"""A hook of MkDocs by which links of the repository work in the site as well.

Markdown links are relative to the file that they are in, as a code-hosting site reads them. Pages
of the site come from two places: `docs/`, and the files of `PAGES` beside it. A link to one of them
is turned to its page. A link to any other file of the repository loses its address and keeps its
words, because the site has no copy of the file. A link to nothing is an error. A notebook that was
executed is a page with its outputs.
"""

import posixpath
import re
import sys
from pathlib import Path

from mkdocs.plugins import get_plugin_logger
from mkdocs.structure.files import File

sys.path.insert(0, str(Path(__file__).parent))
import notebooks  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
LOG = get_plugin_logger("repository")

# Files outside of docs/ that are pages, and the names of their pages.
PAGES = {
    "README.md": "index.md",
    "ARCHITECTURE.md": "repository/architecture.md",
    "CHANGELOG.md": "repository/changelog.md",
    "CONTRIBUTING.md": "repository/contributing.md",
    "PAPER.md": "repository/paper.md",
    "tools/recheck/README.md": "repository/recheck.md",
}
SOURCES = {page: path for path, page in PAGES.items()}

# Pages that are a section of their own: their width is for transcripts, not for a list of one page.
ALONE = {"your-arm.md"}

# The words and the target of a link or an image, outside of code in one line.
LINK = re.compile(r"(`[^`\n]*`)|(!?)\[([^\]]*)\]\(([^)\s]+)\)")

# Blocks of code.
BLOCKS = re.compile(r"(^```[\s\S]*?^```|^(?: {4}.*\n)+)", flags=re.M)


def on_files(files, config):
    """Adds the pages that do not lie in docs/, and the notebooks with outputs."""
    for path, page in PAGES.items():
        files.append(File.generated(config, page, abs_src_path=str(ROOT / path)))
    for path in executed():
        text = notebooks.as_markdown(path)
        files.append(File.generated(config, f"notebooks/{path.stem}.md", content=text))
    return files


def executed():
    """Returns the notebooks with outputs."""
    found = sorted((ROOT / "docs/notebooks").glob("*.ipynb"))
    return [path for path in found if notebooks.is_executed(path)]


def on_page_markdown(markdown, page, config, files):
    """Turns links, outside of blocks of code, to the pages of the site."""
    uri = page.file.src_uri
    source = SOURCES.get(uri, f"docs/{uri}")
    if uri in ALONE:
        page.meta["hide"] = ["navigation"]
    blocks = BLOCKS.split(markdown)
    for i, block in enumerate(blocks):
        if not block.startswith(("```", "    ")):
            blocks[i] = LINK.sub(lambda link: turned(link, source, uri), block)
    return "".join(blocks)


def turned(link, source, uri):
    """Returns a link of the file `source`, on the page `uri`."""
    code, image, words, target = link.groups()
    if code or ":" in target or target.startswith("#"):
        return link.group()
    path, hash_sign, anchor = target.partition("#")
    path = posixpath.normpath(posixpath.join(posixpath.dirname(source), path))
    if not (ROOT / path).exists():
        LOG.warning("%s: the link to %s leads to no file", source, target)
        return link.group()
    if path in PAGES:
        page = PAGES[path]
    elif ROOT / path in executed():
        page = path.removeprefix("docs/").removesuffix(".ipynb") + ".md"
    elif path.startswith("docs/") and (ROOT / path).is_file():
        page = path.removeprefix("docs/")
    else:
        return words
    start = posixpath.dirname(uri) or "."
    return f"{image}[{words}]({posixpath.relpath(page, start)}{hash_sign}{anchor})"
