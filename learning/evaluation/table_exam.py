"""Grounding and grammar of tables, learned on all folds but one and asked on that one (thesis 6.4 and 6.5)."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from learning.concept_id import Concept
from learning.errors import LearningError
from learning.evaluation.concepts import ScoredDemo
from learning.evaluation.grammar_bounds import RELATION, Chunker, bracket_f1, public_from, right_branching, supervised
from learning.evaluation.language_pairs import GoldPairs, Pair, PairScore
from learning.evaluation.language_report import Failure, FoldScores, LanguageReport, Scores
from learning.evaluation.public_tree import subtree_f1
from learning.evaluation.table_gold import GoldSentence
from learning.evaluation.table_names import concept_values
from learning.evaluation.tagger import Tagger, tagged
from learning.grammar.rcl import RclNode
from learning.grammar.table_chart import element_of
from learning.grounding.table_language import TableLanguage
from learning.grounding.translation import translations
from learning.knowledge import Knowledge
from learning.learner import Learner

POINTS = 12
"""Points of a learning curve."""


@dataclass(frozen=True, slots=True)
class SpokenDemo:
    """A demo with all that is true of it and of what was said.

    Attributes:
        demo: Observation, truth and utterances.
        sentences: The sentences with their trees.
    """

    demo: ScoredDemo
    sentences: tuple[GoldSentence, ...]


def grounding_exam(
    demos: Sequence[SpokenDemo],
    *,
    robot: str,
    folds: int = 4,
    seed: int = 0,
    curve: bool = False,
    on_demo: Callable[[], None] = lambda: None,
) -> LanguageReport:
    """F1 of grounding over folds, and of the supervised tagger on the same folds.

    Args:
        demos: Demos in the order of learning.
        robot: Whose they are.
        folds: Number of folds; demo n is asked in fold n % folds.
        seed: Seed of learning.
        curve: Whether to learn from all demos once more for the learning curve.
        on_demo: Called after each demo that was learned from.

    Raises:
        LearningError: There are fewer demos than folds, or NLTK is not installed.
    """
    scores = []
    for learned, asked in _parts(demos, folds):
        knowledge = _learn(learned, seed, on_demo)
        scores.append(_grounding(knowledge, learned, asked))
    points = _curve(demos, seed, on_demo) if curve else ()
    return LanguageReport(robot, tuple(scores), points, seed, {"folds": folds, "demos": len(demos)})


def grammar_exam(
    demos: Sequence[SpokenDemo],
    *,
    robot: str,
    folds: int = 4,
    seed: int = 0,
    on_demo: Callable[[], None] = lambda: None,
) -> LanguageReport:
    """Sub-tree score over folds, and those of the bounds on the same folds; arguments as in `grounding_exam`.

    Raises:
        LearningError: There are fewer demos than folds.
    """
    scores = []
    for learned, asked in _parts(demos, folds):
        knowledge = _learn(learned, seed, on_demo)
        scores.append(_grammar(knowledge.table_language, learned, asked))
    return LanguageReport(robot, tuple(scores), (), seed, {"folds": folds, "demos": len(demos)})


def _parts(demos: Sequence[SpokenDemo], folds: int) -> list[tuple[list[SpokenDemo], list[SpokenDemo]]]:
    if not 2 <= folds <= len(demos):
        raise LearningError(f"{folds} folds of {len(demos)} demos are not possible; choose 2..{len(demos)}")
    return [
        (
            [demo for number, demo in enumerate(demos) if number % folds != fold],
            [demo for number, demo in enumerate(demos) if number % folds == fold],
        )
        for fold in range(folds)
    ]


def _learn(demos: Iterable[SpokenDemo], seed: int, on_demo: Callable[[], None]) -> Knowledge:
    learner = Learner(seed=seed)
    for each in demos:
        learner.study(each.demo.observation, each.demo.utterances)
        on_demo()
    learner.settle()
    return learner.knowledge


def _sentences(demos: Iterable[SpokenDemo]) -> list[GoldSentence]:
    return [sentence for demo in demos for sentence in demo.sentences]


def _languages(sentences: Iterable[GoldSentence]) -> list[str]:
    return sorted({sentence.language for sentence in sentences})


def _grounding(knowledge: Knowledge, learned: Sequence[SpokenDemo], asked: Sequence[SpokenDemo]) -> FoldScores:
    values = concept_values(knowledge, (each.demo for each in learned))
    taught, sentences = _sentences(learned), _sentences(asked)
    figures: dict[str, float | None] = {}
    baselines: dict[str, float | None] = {}
    failures: list[Failure] = []
    by_space: dict[str, list[PairScore]] = {}
    hmm_by_space: dict[str, list[PairScore]] = {}
    for language in _languages(sentences):
        mine = [each for each in sentences if each.language == language]
        gold = GoldPairs(mine)
        scores = gold.score(learned_pairs(knowledge.table_language, gold.ngrams, values))
        tagger = Tagger(tagged(each) for each in taught if each.language == language)
        bound = gold.score(tagger.pairs(each.words for each in mine))
        for space, score in scores.items():
            figures[f"f1.{space}.{language}"] = score.f1
            baselines[f"hmm.{space}.{language}"] = bound[space].f1
            by_space.setdefault(space, []).append(score)
            hmm_by_space.setdefault(space, []).append(bound[space])
            failures += _pair_failures(score, space, language)
    figures |= {f"f1.{space}": _pooled(rows) for space, rows in by_space.items()}
    baselines |= {f"hmm.{space}": _pooled(rows) for space, rows in hmm_by_space.items()}
    figures["translation.accuracy"], wrong = _translated(knowledge.table_language, GoldPairs([*taught, *sentences]))
    return FoldScores(figures, baselines, (*failures, *wrong))


def learned_pairs(
    language: TableLanguage, ngrams: Iterable[str], values: Mapping[Concept, str]
) -> dict[str, set[Pair]]:
    """Pairs that were learned of some n-grams, by feature space."""
    found: dict[str, set[Pair]] = {}
    for ngram in ngrams:
        for concept in language.meanings(ngram):
            value = values.get(concept)
            if value is not None:
                space = element_of(concept)
                found.setdefault(space, set()).add((ngram, value))
    return found


def _pooled(rows: Iterable[PairScore]) -> float | None:
    """F1 of the pairs of several languages together."""
    parts = list(rows)
    found = frozenset(pair for row in parts for pair in row.found)
    wrong = frozenset(pair for row in parts for pair in row.wrong)
    missed = frozenset(pair for row in parts for pair in row.missed)
    return PairScore(found, wrong, missed).f1


def _pair_failures(score: PairScore, space: str, language: str) -> list[Failure]:
    wrong = [Failure(f"{space}: wrong pair", ngram, language, f"means {value}") for ngram, value in sorted(score.wrong)]
    missed = [
        Failure(f"{space}: not learned", ngram, language, f"should mean {value}")
        for ngram, value in sorted(score.missed)
    ]
    return [*wrong, *missed]


def _translated(language: TableLanguage, gold: GoldPairs) -> tuple[float | None, list[Failure]]:
    """Share of translations both of whose words have a true value in common, and those that have none."""
    right, wrong = 0, []
    for each in translations(language):
        space = element_of(each.concept)
        if space not in gold.pairs:
            continue
        if gold.values(space, each.ngram) & gold.values(space, each.other):
            right += 1
        else:
            wrong.append(Failure("translation", each.ngram, each.script, f"is said to be '{each.other}'"))
    total = right + len(wrong)
    return (right / total if total else None), wrong


def _grammar(language: TableLanguage, learned: Sequence[SpokenDemo], asked: Sequence[SpokenDemo]) -> FoldScores:
    taught, sentences = _sentences(learned), _sentences(asked)
    ours: dict[str, list[float]] = {}
    bounds: dict[str, list[float]] = {}
    failures: list[Failure] = []
    for tag in _languages(sentences):
        known = [each for each in taught if each.language == tag]
        upper, chunker = supervised(known), Chunker(each.words for each in known)
        for sentence in sentences:
            if sentence.language != tag or sentence.tree is None:
                continue
            tree = language.parse(sentence.words)
            score = subtree_f1(public_from(tree, sentence), sentence.tree)
            bound = subtree_f1(public_from(upper.parse(sentence.words), sentence), sentence.tree)
            chunks = bracket_f1(chunker.brackets(sentence.words), sentence.tree)
            branches = bracket_f1(right_branching(sentence.words), sentence.tree)
            for name in ("subtree_score", f"subtree_score.{tag}"):
                ours.setdefault(name, []).append(score)
                for who, value in (("supervised", bound), ("unsupervised", chunks), ("right_branching", branches)):
                    bounds.setdefault(f"{who}.{name}", []).append(value)
            if score < 1.0:
                failures.append(_tree_failure(tree, sentence, score))
    rules = [len(row) for tongue in language.tongues.values() for row in tongue.grammar.rules.values()]
    figures: dict[str, float | None] = {name: sum(values) / len(values) for name, values in ours.items()}
    figures["rules"] = float(sum(rules))
    return FoldScores(figures, {name: sum(values) / len(values) for name, values in bounds.items()}, tuple(failures))


def _tree_failure(tree: RclNode | None, sentence: GoldSentence, score: float) -> Failure:
    text, gold = " ".join(sentence.words), str(sentence.tree)
    if tree is None:
        return Failure("not read", text, sentence.language, gold)
    ours = public_from(tree, sentence)
    have = [] if ours is None else [(node.label, node.tokens) for node in ours.nodes() if not node.children]
    true = {(RELATION.get(leaf.element, leaf.element), leaf.head) for leaf in sentence.leaves}
    lost = [label for label, head in true if (label, head) not in have]
    extra = [label for label, span in have if span is None or (label, span) not in true]
    cause = f"misses {', '.join(sorted(set(lost)))}" if lost else f"adds {', '.join(extra)}" if extra else "structure"
    return Failure(cause, text, sentence.language, f"{score:.2f}: {ours}")


def _curve(demos: Sequence[SpokenDemo], seed: int, on_demo: Callable[[], None]) -> tuple[tuple[int, Scores], ...]:
    """F1 against all sentences after more and more demos."""
    gold = GoldPairs(_sentences(demos))
    stops = {round((point + 1) * len(demos) / POINTS) for point in range(POINTS)}
    learner, points = Learner(seed=seed), []
    for number, each in enumerate(demos, start=1):
        learner.study(each.demo.observation, each.demo.utterances)
        on_demo()
        if number in stops:
            values = concept_values(learner.knowledge, (one.demo for one in demos[:number]))
            scores = gold.score(learned_pairs(learner.knowledge.table_language, gold.ngrams, values))
            points.append((number, {space: score.f1 for space, score in scores.items()}))
    return tuple(points)
