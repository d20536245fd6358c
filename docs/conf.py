"""How Sphinx makes a site of README, CONTRIBUTING, CHANGELOG and this folder: `make docs`."""

import re
from importlib import metadata
from pathlib import Path
from typing import Any

project = "Showtell"
author = "The Showtell developers"
try:
    release = metadata.version("showtell")
except metadata.PackageNotFoundError:  # a clone that is not installed
    release = ""

extensions = ["myst_parser"]
root_doc = "docs/index"  # the source directory is the repository, so that links between its pages are checked too
include_patterns = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/*.md"]
exclude_patterns = [".*", "build", "dist", "demo-out", "demos", "tests", "**/__pycache__"]
myst_heading_anchors = 4
nitpicky = True
highlight_language = "text"
html_theme = "furo"
html_title = "Showtell"
html_show_sourcelink = False
html_show_copyright = False


def _with_contents(app: Any, name: str, source: list[str]) -> None:
    """Put what the index links to into the side bar, in the order of the index; what it forgets comes last.

    So the index stays a page that reads well without Sphinx.
    """
    if name != root_doc:
        return
    text = source[0]
    pages = list(dict.fromkeys(re.findall(r"\]\(([^)#:]+\.md)\)", text)))
    folder = Path(app.srcdir) / "docs"
    pages += [page.name for page in sorted(folder.glob("*.md")) if page.name not in {"index.md", *pages}]
    entries = "\n".join(page.removesuffix(".md") for page in pages)
    source[0] = f"{text}\n\n```{{toctree}}\n:hidden:\n\n{entries}\n```\n"


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.connect("source-read", _with_contents)
