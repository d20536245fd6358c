"""The best tree: exact probabilities of a small grammar, and the same as NLTK finds with random ones."""

import math
from importlib import import_module

import numpy as np
import pytest

from learning.errors import LearningError
from learning.grammar.viterbi import Bracket, Production, ViterbiGrammar

RULES = (
    Production("S", ("V", "N"), 0.7),
    Production("S", ("V", "N", "P"), 0.3),
    Production("N", ("N", "P"), 0.2),
    Production("N", ("n",), 0.8),
    Production("P", ("p", "N"), 1.0),
    Production("V", ("take",), 1.0, lexical=True),
    Production("n", ("cube",), 0.9, lexical=True),
    Production("n", ("big", "cube"), 0.1, lexical=True),
    Production("p", ("on",), 1.0, lexical=True),
)


@pytest.fixture(scope="module")
def grammar() -> ViterbiGrammar:
    return ViterbiGrammar(RULES, "S")


def spans(tree: Bracket) -> list[tuple[str, int, int]]:
    return [(tree.label, tree.first, tree.after), *(each for child in tree.children for each in spans(child))]


def test_of_two_ways_to_attach_a_phrase_the_likelier_is_taken(grammar: ViterbiGrammar) -> None:
    found = grammar.parse(("take", "cube", "on", "cube"))
    assert found is not None
    noun = 0.8 * 0.9
    # 0.3 to the verb beats 0.7 · 0.2 to the noun.
    assert found[0] == pytest.approx(math.log(0.3 * noun * noun))
    assert spans(found[1]) == [
        ("S", 0, 4), ("V", 0, 1), ("N", 1, 2), ("n", 1, 2), ("P", 2, 4), ("p", 2, 3), ("N", 3, 4), ("n", 3, 4)
    ]  # fmt: skip


def test_words_that_belong_together_are_one_leaf(grammar: ViterbiGrammar) -> None:
    found = grammar.parse(("take", "big", "cube"))
    assert found is not None
    assert found[0] == pytest.approx(math.log(0.7 * 0.8 * 0.1))
    assert spans(found[1])[-1] == ("n", 1, 3)


def test_what_the_grammar_does_not_know_has_no_tree(grammar: ViterbiGrammar) -> None:
    assert grammar.parse(()) is None
    assert grammar.parse(("take", "zebra")) is None
    assert grammar.parse(("cube", "take")) is None
    assert not grammar.covers(("take", "zebra"))


def test_a_rule_without_probability_is_refused() -> None:
    with pytest.raises(LearningError, match="empty or has no probability"):
        ViterbiGrammar([Production("S", ("A",), 0.0)], "S")


@pytest.mark.parametrize("seed", range(6))
def test_nltk_finds_the_same_probability(seed: int) -> None:
    rng = np.random.default_rng(seed)
    symbols, words = ["S", "A", "B", "C"], ["u", "v", "w"]
    productions = []
    for left in symbols:
        # Unary rules go down the list only, so that no chain comes back to where it began.
        below = symbols[symbols.index(left) + 1 :]
        rights = [tuple(rng.choice(symbols, size=int(size))) for size in rng.integers(2, 5, size=3)]
        rights += [(each,) for each in below[:1]]
        chances = rng.dirichlet(np.ones(len(set(rights)) + len(words)))
        for right, chance in zip(dict.fromkeys(rights), chances, strict=False):
            productions.append(Production(left, tuple(map(str, right)), float(chance)))
        for word, chance in zip(words, chances[-len(words) :], strict=True):
            productions.append(Production(left, (word,), float(chance), lexical=True))
    ours = ViterbiGrammar(productions, "S")
    nltk = import_module("nltk")
    rules = [
        nltk.ProbabilisticProduction(
            nltk.Nonterminal(rule.left),
            [part if rule.lexical else nltk.Nonterminal(part) for part in rule.right],
            prob=rule.probability,
        )
        for rule in productions
    ]
    theirs = nltk.ViterbiParser(nltk.PCFG(nltk.Nonterminal("S"), rules))
    for length in (1, 3, 5):
        sentence = [str(word) for word in rng.choice(words, size=length)]
        tree = next(iter(theirs.parse(sentence)), None)
        found = ours.parse(sentence)
        assert (tree is None) == (found is None)
        if tree is not None and found is not None:
            assert found[0] == pytest.approx(math.log(tree.prob()), rel=1e-9)  # sums in another order
