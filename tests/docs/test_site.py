"""`make docs`: Sphinx reads every page without a warning."""

import subprocess
import sys
from pathlib import Path

from tests.docs.pages import PAGES, REPOSITORY, name_of


def test_the_site_is_built_without_a_warning(tmp_path: Path) -> None:
    site = tmp_path / "site"
    done = subprocess.run(
        [
            *(sys.executable, "-m", "sphinx", "-b", "html", "-c", "docs", "-d", str(tmp_path / "doctrees")),
            *("--fail-on-warning", "--keep-going", "-q", ".", str(site)),
        ],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    for page in PAGES:
        built = site / Path(name_of(page)).with_suffix(".html")
        assert built.is_file(), f"{name_of(page)} is not in the site"
