"""Grounding and grammar of the board's real commands, over folds by group (thesis 6.4 and 6.5)."""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from learning.errors import LearningError
from learning.evaluation.annotation import annotations_of, tokens_of, word_tokens
from learning.evaluation.answers import Answer, Learn
from learning.evaluation.examination import examine_fold
from learning.evaluation.fold_workers import in_folds
from learning.evaluation.folds import Fold, make_folds
from learning.evaluation.grammar_bounds import Chunker, bracket_f1, right_branching
from learning.evaluation.language_pairs import SPACES, Pair, PairScore
from learning.evaluation.language_report import Failure, FoldScores, LanguageReport
from learning.evaluation.public_labels import public_tree
from learning.evaluation.public_tree import PublicNode, Span, subtree_f1
from learning.evaluation.supervised_grammar import SupervisedGrammar
from learning.evaluation.tagger import LEAST_SHARE, NOTHING, Tagger
from learning.train_robots.release import Release

PLACES = ("corner", "edge", "region", "board")
"""Types of an entity that are parts of the board and no things."""


@dataclass(frozen=True, slots=True)
class Tagged:
    """A leaf of a tree: where, and what it says.

    Attributes:
        space: Feature space, as the thesis has them.
        value: Public value.
        span: First and last token, from 1.
        label: Public label.
    """

    space: str
    value: str
    span: Span
    label: str


def board_exam(
    release: Release,
    learn: Learn,
    *,
    folds: int = 4,
    seed: int = 0,
    jobs: int = 1,
    on_fold: Callable[[], None] = lambda: None,
) -> LanguageReport:
    """Learn on all folds but one and ask that one; scores of grounding, of grammar and of their bounds.

    Args:
        release: Commands, scenes and annotation.
        learn: Makes a student from scenes and commands.
        folds: Number of folds, by group.
        seed: Seed of the report.
        jobs: Processes; with more than one `learn` must be picklable.
        on_fold: Called after each fold.

    Raises:
        LearningError: There is no annotation, or so many folds are not possible.
    """
    trees = annotations_of(release)
    if trees is None:
        raise LearningError(f"{release.directory}: without annotation.txt there is nothing to compare words with")
    scores = []
    parts = make_folds(release, folds, "groups", np.random.default_rng(seed))
    for fold, examined in in_folds(partial(examine_fold, learn, release, False), parts, jobs):
        answers, names = examined.answers, examined.names
        ours = {
            answer.command.id: public_tree(answer.tree, names, word_tokens(answer.command.sentence))
            for answer in answers
            if answer.tree is not None
        }
        scores.append(_scored(fold, answers, ours, trees))
        on_fold()
    return LanguageReport("three_dof", tuple(scores), (), seed, {"folds": folds, "split": "groups"})


def leaves_of(tree: PublicNode | None) -> list[Tagged]:
    """Aligned leaves of a tree that a feature space is about, from left to right."""
    found = []
    for node in tree.nodes() if tree is not None else ():
        space = _space(node)
        if space is not None and node.value is not None and node.tokens is not None:
            found.append(Tagged(space, node.value, node.tokens, node.label))
    return sorted(found, key=lambda leaf: leaf.span)


def _space(node: PublicNode) -> str | None:
    if node.label == "type":
        if node.value in PLACES:
            return "location"
        return None if "reference" in str(node.value) or node.value in ("tile", "robot") else "shape"
    return {"color": "colour", "action": "action", "relation": "direction", "indicator": "location"}.get(node.label)


def _scored(
    fold: Fold, answers: Sequence[Answer], ours: Mapping[int, PublicNode], trees: Mapping[int, PublicNode]
) -> FoldScores:
    taught = [(_tokens(each.sentence), trees[each.id]) for each in fold.learned if each.id in trees]
    tagger = Tagger(_tags(tokens, tree) for tokens, tree in taught)
    grammar, chunker = SupervisedGrammar(tree for _, tree in taught), Chunker(tokens for tokens, _ in taught)
    uses: dict[str, defaultdict[str, Counter[str]]] = {}
    figures: dict[str, list[float]] = {}
    failures: list[Failure] = []
    for answer in answers:
        command = answer.command
        gold = trees.get(command.id)
        if gold is None:
            continue
        tokens = _tokens(command.sentence)
        tagged = _tagged_leaves(tagger.tags(tokens))
        leaves = leaves_of(gold)
        _count(uses, "gold", tokens, leaves, leaves)
        _count(uses, "ours", tokens, leaves_of(ours.get(command.id)), leaves)
        _count(uses, "hmm", tokens, [each for each in tagged if each.space in SPACES], leaves)
        parsed = grammar.parse([PublicNode(each.label, each.value, each.span) for each in tagged])
        score = subtree_f1(ours.get(command.id), gold)
        for name, value in (
            ("subtree_score", score),
            ("supervised.subtree_score", subtree_f1(parsed, gold)),
            ("unsupervised.subtree_score", bracket_f1(chunker.brackets(tokens), gold)),
            ("right_branching.subtree_score", bracket_f1(right_branching(tokens), gold)),
        ):
            figures.setdefault(name, []).append(value)
        if score < 1.0:
            cause = "tree: not understood" if command.id not in ours else "tree: differs"
            failures.append(Failure(cause, command.sentence, "en", f"{score:.2f}, command {command.id}"))
    means = {name: sum(values) / len(values) for name, values in figures.items()}
    mine: dict[str, float | None] = {"subtree_score": means.pop("subtree_score", None)}
    bounds: dict[str, float | None] = dict(means)
    for space in ("colour", "shape", "location", "direction", "action"):
        gold_pairs = _pairs(uses.get("gold", {}), space, 0.0)
        for who, before, target in (("ours", "f1", mine), ("hmm", "hmm", bounds)):
            pairs = _pairs(uses.get(who, {}), space, LEAST_SHARE)
            result = PairScore(
                frozenset(pairs & gold_pairs), frozenset(pairs - gold_pairs), frozenset(gold_pairs - pairs)
            )
            target[f"{before}.{space}"] = result.f1
            target[f"{before}_by_use.{space}"] = _by_use(uses.get(who, {}), uses.get("gold", {}), space)
            if who == "ours":
                failures += [Failure(f"{space}: wrong pair", n, "en", f"means {v}") for n, v in sorted(result.wrong)]
                failures += [
                    Failure(f"{space}: not learned", n, "en", f"should mean {v}") for n, v in sorted(result.missed)
                ]
    return FoldScores(mine, bounds, tuple(failures))


def _tokens(sentence: str) -> tuple[str, ...]:
    return tuple(token.lower() for token in tokens_of(sentence))


def _ngram(tokens: Sequence[str], span: Span) -> str:
    return " ".join(tokens[span[0] - 1 : span[1]])


def _tags(tokens: Sequence[str], tree: PublicNode) -> list[tuple[str, str]]:
    """Tokens with the label and value of the leaf that they are aligned to."""
    tags = [NOTHING] * len(tokens)
    for node in tree.nodes():
        if node.tokens is not None and node.value is not None:
            for at in range(node.tokens[0] - 1, min(node.tokens[1], len(tokens))):
                tags[at] = f"{node.label}:{node.value}"
    return list(zip(tokens, tags, strict=True))


def _tagged_leaves(tags: Sequence[str]) -> list[Tagged]:
    """Leaves that tags give: neighbours with one tag are one leaf."""
    found, at = [], 0
    while at < len(tags):
        after = at + 1
        while after < len(tags) and tags[after] == tags[at]:
            after += 1
        if tags[at] != NOTHING:
            label, _, value = tags[at].partition(":")
            space = _space(PublicNode(label, value)) or ""
            found.append(Tagged(space, value, (at + 1, after), label))
        at = after
    return found


def _count(
    uses: dict[str, defaultdict[str, Counter[str]]],
    who: str,
    tokens: Sequence[str],
    leaves: Iterable[Tagged],
    gold: Sequence[Tagged],
) -> None:
    """Count what n-grams are said to mean; one that overlaps a true leaf of its space is that leaf's n-gram."""
    rows = uses.setdefault(who, defaultdict(Counter))
    for leaf in leaves:
        span = next(
            (
                each.span
                for each in gold
                if each.space == leaf.space and each.span[0] <= leaf.span[1] and leaf.span[0] <= each.span[1]
            ),
            leaf.span,
        )
        rows[_ngram(tokens, span)][f"{leaf.space}:{leaf.value}"] += 1


def _by_use(rows: Mapping[str, Counter[str]], gold: Mapping[str, Counter[str]], space: str) -> float | None:
    """F1 of the pairs of a feature space, each counted as often as it is used; None where the space is not used.

    The set of pairs weighs a slip in one command as much as a word of a thousand; this does not.
    """
    ours, wanted = (
        Counter(
            {
                (ngram, tag): count
                for ngram, row in table.items()
                for tag, count in row.items()
                if tag.startswith(f"{space}:")
            }
        )
        for table in (rows, gold)
    )
    total = ours.total() + wanted.total()
    return 2.0 * (ours & wanted).total() / total if total else None


def _pairs(rows: Mapping[str, Counter[str]], space: str, least: float) -> set[Pair]:
    """Pairs of a feature space that at least a share `least` of an n-gram's uses give."""
    found: set[Pair] = set()
    for ngram, row in rows.items():
        for tag, count in row.items():
            of, _, value = tag.partition(":")
            if of == space and count >= least * row.total():
                found.add((ngram, value))
    return found
