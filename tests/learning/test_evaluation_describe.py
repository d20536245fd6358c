"""Checking sentences by the truth: ways to attach, what they denote among true blocks, and the figures that follow."""

from dataclasses import replace

import pytest

from learning.evaluation.describe_board import does_truly
from learning.evaluation.describe_report import EVENT, OBJECT, Described, DescribeReport
from learning.evaluation.describe_truth import SupervisedReader, TrueBoard
from learning.evaluation.public_tree import PublicNode
from learning.train_robots.layout import Block, Layout
from learning.train_robots.scene import Scene

Leaf = PublicNode
BLOCKS = (
    Block((2, 2, 0), "red", "cube"),
    Block((2, 2, 1), "blue", "cube"),
    Block((5, 5, 0), "red", "cube"),
    Block((5, 5, 1), "green", "prism"),
    Block((6, 1, 0), "blue", "cube"),
)


def node(label: str, *children: PublicNode) -> PublicNode:
    return PublicNode(label, None, None, children)


def layout(blocks: tuple[Block, ...] = BLOCKS) -> Layout:
    return Layout(1, 1, (0, 0, 7), False, blocks)


def annotated() -> list[tuple[str, PublicNode]]:
    """Take and move commands with their trees, enough for a tagger."""
    found = []
    for colour in ("red", "blue", "green"):
        for shape in ("cube", "prism"):
            thing = node("entity", Leaf("color", colour, (3, 3)), Leaf("type", shape, (4, 4)))
            ground = node("entity", Leaf("color", "red", (7, 7)), Leaf("type", "cube", (8, 8)))
            where = node("spatial-relation", Leaf("relation", "above", (5, 5)), ground)
            action = Leaf("action", "move", (1, 1))
            tree = node("event", action, thing, node("destination", where))
            found.append((f"move the {colour} {shape} on the red cube", tree))
            found.append((f"take the {colour} {shape}", node("event", Leaf("action", "take", (1, 1)), thing)))
    return found * 4


@pytest.fixture(scope="module")
def reader() -> SupervisedReader:
    return SupervisedReader(annotated())


def test_a_relation_may_be_of_the_thing_or_of_where_it_goes(reader: SupervisedReader) -> None:
    trees = reader.commands("move the blue cube on the red cube on the red cube")
    assert len(trees) == 2  # to the red cube on the red cube; or the blue one on the red one, to the red one
    assert [sum(child.label == "spatial-relation" for child in tree.children[1].children) for tree in trees] == [0, 1]
    assert len(reader.commands("take the blue cube on the red cube")) == 1


def test_a_phrase_denotes_what_is_truly_so(reader: SupervisedReader) -> None:
    board = TrueBoard(layout())
    (tree,) = reader.things("the blue cube on the red cube")
    assert board.thing(tree) == 1 << 1
    (tree,) = reader.things("the blue cube")
    assert board.thing(tree) == 1 << 1 | 1 << 4
    (tree,) = reader.things("the green cube")
    assert board.thing(tree) == 0


def test_a_command_is_true_when_every_way_to_read_it_does_what_was_shown(reader: SupervisedReader) -> None:
    after = list(BLOCKS)
    after[3] = replace(after[3], cell=(2, 2, 2))
    scene = Scene(1, layout(), layout(tuple(after)))
    assert scene.move is not None and scene.move.object_id == 3
    assert does_truly(scene, reader.commands("move the green prism on the blue cube on the red cube")) == (True, True)
    # Two blue cubes are free: it does not say which.
    assert does_truly(scene, reader.commands("move the green prism on the blue cube")) == (False, False)
    assert does_truly(scene, reader.commands("take the green prism")) == (False, False)
    assert does_truly(scene, []) == (False, False)


def test_what_was_not_said_counts_as_wrong() -> None:
    rows = (
        Described(EVENT, "en", "scene 1", "take it", True, True, True, "", "take"),
        Described(EVENT, "en", "scene 2", "", False, False, False, "no sentence", "move"),
        Described(OBJECT, "ar", "scene 1", "x", True, None, None, "", "free"),
    )
    figures = DescribeReport(rows).figures()
    assert figures["event.same"] == figures["event.described"] == 0.5
    assert figures["event.take.same"] == 1.0 and figures["event.move.same"] == 0.0
    assert figures["object.alone"] == 1.0 and figures["object.true"] is None
    assert figures["object.ar.count"] == 1.0
    assert DescribeReport(rows).causes() == [("no sentence", 1)]
