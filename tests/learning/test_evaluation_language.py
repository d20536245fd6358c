"""Scores of grounding and grammar: exact values where they are known."""

import numpy as np
import pytest

from learning.errors import LearningError
from learning.evaluation.grammar_bounds import Chunker, bracket_f1, public_from, right_branching, supervised
from learning.evaluation.language_pairs import GoldPairs
from learning.evaluation.public_tree import PublicNode, subtree_f1
from learning.evaluation.supervised_grammar import SupervisedGrammar
from learning.evaluation.table_exam import grammar_exam
from learning.evaluation.table_gold import GoldSentence, gold_sentence
from learning.evaluation.tagger import Tagger, tagged
from learning.grounding.ngrams import words_of


def gold(text: str, action: str = "move") -> GoldSentence:
    entry = {"text": text, "language": "en", "annotator": "en_1", "template": f"{action}: plain", "mistakes": []}
    return gold_sentence(entry, action)


SENTENCES = [
    gold("move the red cube to the left of the bowl"),
    gold("move the blue apple to the right of the red bowl"),
    gold("pick up the blue cube", "pick up"),
    gold("pick up the red apple", "pick up"),
]


def test_pairs_are_right_between_head_and_phrase_and_wrong_elsewhere() -> None:
    pairs = GoldPairs(SENTENCES[:1])
    score = pairs.score({"direction": {("to the left of", "left"), ("the", "left")}, "colour": {("red", "blue")}})
    assert score["direction"].found == {("left", "left")}
    assert score["direction"].wrong == {("the", "left")}
    assert score["direction"].f1 == pytest.approx(2 / 3)  # one found, one wrong, none missed
    assert score["colour"].f1 == 0.0
    assert score["size"].f1 is None


def test_the_tagger_gives_back_what_it_was_taught() -> None:
    tagger = Tagger(tagged(each) for each in SENTENCES)
    found = tagger.pairs([words_of("pick up the red cube")])
    assert found["colour"] == {("red", "red")}
    assert found["shape"] == {("cube", "cube")}


def test_the_supervised_grammar_parses_what_it_was_taught() -> None:
    tongue = supervised(SENTENCES * 3)
    for sentence in SENTENCES:
        assert sentence.tree is not None
        tree = public_from(tongue.parse(sentence.words), sentence)
        assert subtree_f1(tree, sentence.tree) == 1.0, sentence.words


def test_the_boards_supervised_grammar_puts_elements_together() -> None:
    leaf = PublicNode
    tree = leaf(
        "event",
        None,
        None,
        (
            leaf("action", "take", (1, 1)),
            leaf("entity", None, None, (leaf("color", "red", (3, 3)), leaf("type", "cube", (4, 4)))),
        ),
    )
    grammar = SupervisedGrammar([tree])
    parsed = grammar.parse(
        [leaf("action", "move", (1, 1)), leaf("color", "blue", (2, 2)), leaf("type", "prism", (3, 3))]
    )
    assert parsed is not None
    assert [node.label for node in parsed.nodes()] == ["event", "action", "entity", "color", "type"]
    assert grammar.parse([]) is None


def test_brackets_are_scored_without_labels() -> None:
    tree = SENTENCES[2].tree
    assert tree is not None
    assert bracket_f1(right_branching(("a", "b")), tree) == 0.0
    chunks = Chunker([each.words for each in SENTENCES]).brackets(SENTENCES[2].words)
    assert chunks[1, len(SENTENCES[2].words)] == 1
    assert chunks.total() == len(SENTENCES[2].words) - 1


def test_too_few_demos_for_folds_are_an_error() -> None:
    with pytest.raises(LearningError, match="4 folds of 0 demos are not possible"):
        grammar_exam([], robot="baxter", seed=int(np.random.default_rng(0).integers(5)))
