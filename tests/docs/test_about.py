"""What the papers say about the project itself: how to cite it, what changed, where everything is."""

import re
import tomllib
from typing import Any

import yaml

from tests.docs.pages import REPOSITORY

PROJECT: dict[str, Any] = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
CITATION_KEYS = {
    *("abstract", "authors", "cff-version", "commit", "contact", "date-released", "doi", "identifiers", "keywords"),
    *("license", "license-url", "message", "preferred-citation", "references", "repository", "repository-artifact"),
    *("repository-code", "title", "type", "url", "version"),
}
"""All keys that schema 1.2.0 of the Citation File Format allows at the top; `cffconvert --validate` says the same."""


def test_the_citation_file_is_valid_and_up_to_date() -> None:
    cited = yaml.safe_load((REPOSITORY / "CITATION.cff").read_text(encoding="utf-8"))
    assert cited["cff-version"] == "1.2.0"
    assert set(cited) <= CITATION_KEYS
    assert {"cff-version", "message", "title", "authors"} <= set(cited)
    assert cited["type"] == "software"
    # An entity has a name, a person none but a family or given name or an alias.
    people = {"name", "family-names", "given-names", "alias", "affiliation", "orcid", "email", "website"}
    assert all(author and set(author) <= people for author in cited["authors"])
    assert [author["name"] for author in cited["authors"]] == [
        author["name"] for author in PROJECT["project"]["authors"]
    ]
    assert len(set(cited["keywords"])) == len(cited["keywords"]) > 0
    # YAML reads 0.1 as a number, and only texts are allowed.
    assert isinstance(cited["version"], str) and cited["version"] == PROJECT["project"]["version"]
    assert cited["license"] == PROJECT["project"]["license"]


def test_the_changelog_is_about_this_version() -> None:
    text = (REPOSITORY / "CHANGELOG.md").read_text(encoding="utf-8")
    versions = re.findall(r"^## (.+)$", text, flags=re.MULTILINE)
    assert versions and versions[0].split(" ")[0] == PROJECT["project"]["version"]
    assert all(re.fullmatch(r"\d+\.\d+\.\d+ - (unreleased|\d{4}-\d{2}-\d{2})", each) for each in versions)


def test_the_map_of_the_house_names_every_package() -> None:
    text = (REPOSITORY / "CONTRIBUTING.md").read_text(encoding="utf-8")
    packages = set(PROJECT["tool"]["setuptools"]["packages"])
    assert packages <= set(re.findall(r"`([a-z_.]+)`", text))
    rows = set(re.findall(r"^\| `([a-z_]+\.[a-z_.]+)` \|", text, flags=re.MULTILINE))
    assert rows <= packages
