import re
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from executor.cli import app
from executor.knowledge_page import knowledge_page
from executor.knowledge_page.concept_charts import compass_rose, plan
from executor.knowledge_page.graphlet_drawing import draw_graphlet
from learning import Knowledge
from learning.concepts.gaussian import Gaussian
from learning.graphs.action_graphlet import ActionGraphlet


class _Balance(HTMLParser):
    """Counts how deep tags are nested and complains about one that is not closed in order."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in ("meta", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def _gaussian(mean: tuple[float, ...], spread: float = 0.05) -> Gaussian:
    return Gaussian(np.array(mean), spread**2 * np.eye(len(mean)), 10.0)


def test_every_concept_and_every_action_is_on_the_page(knowledge: Knowledge) -> None:
    page = knowledge_page(knowledge, "k.json")
    for space, mixture in knowledge.spaces.mixtures.items():
        for number in mixture.components:
            assert f"<b>{space}_{number}</b>" in page
    for number, graphlet in knowledge.spaces.actions.numbered.items():
        assert f"<b>action_{number}</b>" in page
        assert f'aria-label="action graphlet {graphlet}"' in page


def test_concepts_with_words_come_first_and_the_others_are_folded(knowledge: Knowledge) -> None:
    page = knowledge_page(knowledge, "k.json")
    section = page[page.index("<h2>location") : page.index("<h2>direction")]
    assert "<details><summary>64 that no word means</summary>" in section
    section = page[page.index("<h2>shape") : page.index("<h2>location")]
    unsaid = section.index("<details>") if "<details>" in section else len(section)
    assert section.index("cube") < unsaid and section.index("prism") < unsaid


def test_the_page_is_well_formed_and_loads_nothing(knowledge: Knowledge) -> None:
    page = knowledge_page(knowledge, "<b>&.json")
    parser = _Balance()
    parser.feed(page)
    assert parser.open == []
    assert "&lt;b&gt;&amp;.json" in page
    assert not re.search(r"https?://|<script|<link|@import|url\(", page)


def test_knowledge_of_nothing_has_a_page_too() -> None:
    page = knowledge_page(Knowledge(), "empty.json")
    assert "Nothing was learned of it." in page
    assert "actions: 0 graphlets" in page


@pytest.mark.parametrize(
    ("direction", "right", "down"),
    [((1, 0, 0), 150.0, 24.0), ((0, 1, 0), 24.0, 150.0), ((0, 0, 1), 150.0, 150.0), ((0, -1, 0), 276.0, 150.0)],
    ids=["away is up", "left is left", "above is in the middle", "right is right"],
)
def test_the_compass_rose_shows_the_table_as_the_robot_sees_it(
    direction: tuple[float, float, float], right: float, down: float
) -> None:
    assert f'<circle class="blob" cx="{right:.1f}" cy="{down:.1f}"' in compass_rose({3: _gaussian(direction)})


def test_what_points_downwards_is_drawn_hollow() -> None:
    assert 'class="hollow"' in compass_rose({0: _gaussian((0.0, 0.0, -1.0))})


def test_a_place_further_away_is_higher_on_the_plan_and_one_to_the_left_is_further_left() -> None:
    drawn = plan({0: _gaussian((0.5, 0.2), 0.01), 1: _gaussian((0.8, -0.2), 0.01)})
    marks = {
        number: (float(x), float(y))
        for x, y, number in re.findall(
            r'<text class="" x="([\d.]+)" y="([\d.]+)" text-anchor="middle">(\d)</text>', drawn
        )
    }
    assert marks["0"][0] < marks["1"][0]
    assert marks["0"][1] > marks["1"][1]


def test_what_changes_from_state_to_state_is_marked(actions: dict[str, ActionGraphlet]) -> None:
    graphlet = actions["take"]
    drawn = draw_graphlet(graphlet)
    changes = 3  # all of the first state is news
    for before, after in zip(graphlet.states, graphlet.states[1:], strict=False):
        changes += before.gripper_closed != after.gripper_closed
        changes += (before.object_location, before.raised) != (after.object_location, after.raised)
        changes += (before.touching, before.side) != (after.touching, after.side)
    assert drawn.count("leaf changed") == changes
    assert drawn.count(">gripper<") == len(graphlet.states)


def test_inspect_writes_the_page_and_refuses_a_folder_that_is_not_there(knowledge_file: str, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    result = CliRunner().invoke(app, ["inspect", knowledge_file, "--html", str(page)])
    assert result.exit_code == 0
    assert page.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    missing = CliRunner().invoke(app, ["inspect", knowledge_file, "--html", str(tmp_path / "none" / "page.html")])
    assert missing.exit_code == 2
