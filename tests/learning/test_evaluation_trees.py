from pathlib import Path

import pytest

from learning.concept_id import REFERENCE, Concept
from learning.errors import ReleaseError
from learning.evaluation.annotation import load_annotations, tokens_of, word_tokens
from learning.evaluation.kinds import kinds_of, outside_vocabulary
from learning.evaluation.public_labels import public_tree
from learning.evaluation.public_tree import PublicNode, labelled_spans, same_tree, subtree_f1
from learning.grammar.rcl import RclNode
from learning.grounding.ngrams import words_of
from learning.train_robots import Release

PLAIN = (
    "(event: (action: move (token: 1)) (entity: (color: red (token: 3)) (type: cube (token: 4))) "
    "(destination: (spatial-relation: (relation: above (token: 5 7)) (entity: (type: cube (token: 9))))))"
)
SEQUENCE = (
    "(sequence: (event: (action: take (token: 1 2)) (entity: (id: 1) (color: red (token: 4)) (type: cube (token: 5)))) "
    "(event: (action: drop (token: 7)) (entity: (type: reference (token: 8)) (reference-id: 1)) "
    "(destination: (spatial-relation: (relation: above (token: 9)) (entity: (color: blue (token: 11)) "
    "(type: cube (token: 12)))))))"
)


def read(directory: Path, tree: str) -> PublicNode:
    (directory / "annotation.txt").write_bytes(f"7\trcl\t{tree}\r\n".encode())
    trees = load_annotations(directory)
    assert trees is not None
    return trees[7]


def our_sequence(*, colour: int = 0) -> RclNode:
    """Tree of "pick up the red cube, and put it on the blue cube": its comma is a token but no word."""

    def leaf(space: str, number: int, first: int, last: int | None = None) -> RclNode:
        return RclNode(space, Concept(space, number), first, last or first)

    return RclNode(
        "sequence",
        None,
        1,
        12,
        (
            RclNode(
                "event",
                None,
                1,
                5,
                (
                    leaf("action", 1, 1, 2),
                    RclNode("entity", None, 3, 5, (leaf("colour", colour, 4), leaf("shape", 0, 5))),
                ),
            ),
            RclNode(
                "event",
                None,
                7,
                12,
                (
                    leaf("action", 2, 7),
                    RclNode("entity", None, 8, 8, (RclNode("reference", REFERENCE, 8, 8),)),
                    RclNode(
                        "destination",
                        None,
                        9,
                        12,
                        (
                            RclNode(
                                "spatial-relation",
                                None,
                                9,
                                12,
                                (
                                    leaf("direction", 0, 9),
                                    RclNode("entity", None, 10, 12, (leaf("colour", 1, 11), leaf("shape", 0, 12))),
                                ),
                            ),
                        ),
                    ),
                ),
            ),
        ),
    )


NAMES = {
    Concept("action", 1): "take",
    Concept("action", 2): "drop",
    Concept("colour", 0): "red",
    Concept("colour", 1): "blue",
    Concept("shape", 0): "cube",
    Concept("direction", 0): "above",
}


def test_tokens_are_words_and_punctuation_marks() -> None:
    assert tokens_of("Don't move red-blue, 2 left.") == ("Don't", "move", "red", "-", "blue", ",", "2", "left", ".")
    assert word_tokens("Don't move red-blue, 2 left.") == (1, 2, 3, 5, 7, 8)


def test_a_tree_is_read_and_written_alike(tmp_path: Path) -> None:
    tree = read(tmp_path, SEQUENCE)
    assert str(tree) == SEQUENCE
    assert tree.label == "sequence"
    assert tree.values("action") == ["take", "drop"]
    assert tree.span() == (1, 12)
    assert tree.children[1].children[2].span() == (9, 12)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("7\trcl", "line 1: 2 columns where 3 were expected"),
        ("7\txml\t(event: )", "line 1: unknown kind of annotation 'xml'; allowed: rcl"),
        ("7\trcl\t(event: (action: move)", "line 1: the tree ends before its brackets are closed"),
        ("7\trcl\t(event: ) (action: move)", r"line 1: '\(' follows the end of the tree"),
        ("7\trcl\t(event (action: move))", "line 1: 'event' is not a label"),
        ("7\trcl\t(color: red blue)", "line 1: 'color' has two values, 'red' and 'blue'"),
        ("7\trcl\t(color: red (token: x))", "line 1: token number 'x' is not a number"),
        ("7\trcl\t(color: red (token: 3 2))", r"line 1: token \[3, 2\] is not one number or a rising pair"),
        ("7\trcl\t(event: )\r\n7\trcl\t(event: )", "line 2: command id 7 stands twice"),
    ],
)
def test_a_malformed_annotation_is_named(tmp_path: Path, line: str, message: str) -> None:
    (tmp_path / "annotation.txt").write_bytes(line.encode())
    with pytest.raises(ReleaseError, match=message):
        load_annotations(tmp_path)


def test_without_the_file_there_are_no_annotations(tmp_path: Path) -> None:
    assert load_annotations(tmp_path) is None


def test_spans_leave_out_what_is_not_aligned(tmp_path: Path) -> None:
    spans = labelled_spans(read(tmp_path, SEQUENCE))
    assert spans["entity", 4, 5] == 1
    assert spans["sequence", 1, 12] == 1
    assert not any(label in ("id", "reference-id") for label, _, _ in spans)
    assert spans.total() == 16


def test_subtree_f1_counts_common_nodes(tmp_path: Path) -> None:
    tree = read(tmp_path, PLAIN)
    assert subtree_f1(tree, tree) == 1.0
    assert subtree_f1(None, tree) == 0.0
    event = PublicNode("event", children=tree.children[:2])
    # of its 5 nodes 4 are among the 10 of the whole tree: the event ends earlier
    assert subtree_f1(event, tree) == pytest.approx(2 * 4 / (5 + 10))


def test_our_tree_with_public_labels_equals_the_annotated_one(tmp_path: Path) -> None:
    sentence = "pick up the red cube, and put it on the blue cube"
    shifted = SEQUENCE
    for token in (12, 11, 9, 8, 7):  # the comma is token 6
        shifted = shifted.replace(f"(token: {token})", f"(token: {token + 1})")
    annotated = read(tmp_path, shifted)
    tree = public_tree(our_sequence(), NAMES, word_tokens(sentence))
    assert same_tree(tree, annotated)
    assert subtree_f1(tree, annotated) == 1.0
    assert str(tree) == str(annotated)


def test_a_wrong_concept_is_not_exact_but_its_nodes_count(tmp_path: Path) -> None:
    annotated = read(tmp_path, SEQUENCE)
    tree = public_tree(our_sequence(colour=1), NAMES, tuple(range(1, 13)))
    assert not same_tree(tree, annotated)
    assert subtree_f1(tree, annotated) == 1.0
    unnamed = public_tree(our_sequence(colour=9), NAMES, tuple(range(1, 13)))
    assert unnamed.values("color") == ["?", "blue"]
    assert not same_tree(None, annotated)


def test_children_stand_in_the_order_of_the_release() -> None:
    words = RclNode(
        "entity",
        None,
        1,
        2,
        (RclNode("shape", Concept("shape", 0), 1, 1), RclNode("colour", Concept("colour", 0), 2, 2)),
    )
    assert str(public_tree(words, NAMES, (1, 2))) == "(entity: (color: red (token: 2)) (type: cube (token: 1)))"


@pytest.mark.parametrize(
    ("tree", "kinds", "outside"),
    [
        (PLAIN, ("single move", "plain"), ()),
        (SEQUENCE, ("take then drop", "it", "plain"), ()),
        (
            "(event: (action: take (token: 1)) (entity: (indicator: nearest (token: 2)) (color: red (token: 3)) "
            "(color: blue (token: 4)) (type: stack (token: 5))))",
            ("single take", "group", "nearest block", "stack", "superlative"),
            ("indicator nearest", "several colours of one thing", "type stack"),
        ),
        (
            "(event: (action: move (token: 1)) (entity: (type: cube (token: 2))) (destination: (spatial-relation: "
            "(measure: (entity: (cardinal: 2 (token: 3)) (type: tile (token: 4)))) (relation: left (token: 5)))))",
            ("single move", "beside, left, right, front", "count", "displacement"),
            ("cardinal", "measure", "type tile"),
        ),
        (
            "(event: (action: drop (token: 1)) (entity: (type: cube (token: 2))) (destination: (spatial-relation: "
            "(relation: within (token: 3)) (entity: (indicator: left (token: 4)) (indicator: back (token: 5)) "
            "(type: corner (token: 6))))))",
            ("single drop", "corner"),
            (),
        ),
    ],
)
def test_kinds_and_vocabulary(tmp_path: Path, tree: str, kinds: tuple[str, ...], outside: tuple[str, ...]) -> None:
    annotated = read(tmp_path, tree)
    assert kinds_of(annotated) == kinds
    assert outside_vocabulary(annotated) == outside


def test_the_real_annotations_fit_the_sentences(real_release_directory: Path) -> None:
    trees = load_annotations(real_release_directory)
    assert trees is not None
    assert len(trees) == 2500
    raw = (real_release_directory / "annotation.txt").read_text().splitlines()
    assert [str(trees[int(line.split("\t")[0])]) for line in raw] == [line.split("\t")[2] for line in raw]
    for command in Release.load(real_release_directory).commands:
        span = trees[command.id].span()
        assert span is not None
        assert span[1] <= len(tokens_of(command.sentence))
        assert len(word_tokens(command.sentence)) == len(words_of(command.sentence))
    forms = [kinds_of(tree)[0] for tree in trees.values()]
    counts = {form: forms.count(form) for form in set(forms)}
    assert counts == {"take then drop": 837, "single move": 1010, "single take": 384, "single drop": 269}
    assert sum(not outside_vocabulary(tree) for tree in trees.values()) == 1549
