"""Parsing: our Viterbi CKY beside NLTK's `ViterbiParser`, with the same learned grammar and the same sentences."""

import math
import time
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from executor.bench.report import BenchReport
from executor.errors import InputError
from executor.release_student import study_release
from learning.grammar.viterbi import ViterbiGrammar
from learning.grounding.ngrams import words_of
from learning.knowledge import Knowledge
from learning.learner import Learner
from learning.saying.speaker import Speaker
from learning.train_robots import Release

SCENES = 64
"""Scenes of our own making that are learned from where no knowledge is given."""
SAME = 1e-9
"""Log probabilities of one tree differ by no more than this, relatively: sums are added up in another order."""
ROUNDS = 20
"""How often we parse the sentences: once takes too little time to measure."""


def run(
    seed: int,
    count: int,
    knowledge: Path | None = None,
    release: Path | None = None,
    on_done: Callable[[], None] = lambda: None,
) -> BenchReport:
    """Parse sentences with both.

    Args:
        seed: Seed of learning, and of the choice of sentences.
        count: Sentences, of those that the grammar has all words of.
        knowledge: Knowledge whose grammar is used; without it one is learned from scenes of our own making.
        release: Release whose commands are parsed; those that were learned from without it.
        on_done: Called after each sentence.

    Raises:
        InputError: None of the sentences has only words of the grammar, or no sentences were given.
        KnowledgeError: The knowledge does not say how a language is spoken.
    """
    rng = np.random.default_rng(seed)
    if knowledge is None:
        learned, said = _learned(release, rng, seed)
    elif release is None:
        raise InputError("--knowledge needs sentences to parse: give --train-robots with the folder of a release")
    else:
        learned, said = Knowledge.load(knowledge), _sentences(release)
    grammar = Speaker(learned).word_grammar()
    covered = [words for words in said if grammar.covers(words)]
    if not covered:
        raise InputError("no sentence has only words of the learned grammar; give other knowledge or another release")
    chosen = [covered[int(index)] for index in rng.permutation(len(covered))[:count]]
    return _compare(grammar, chosen, len(said), len(covered), on_done)


def _compare(
    grammar: ViterbiGrammar, sentences: Sequence[tuple[str, ...]], said: int, covered: int, on_done: Callable[[], None]
) -> BenchReport:
    theirs = _nltk_parser(grammar)
    grammar.parse(sentences[0])  # compiles, or loads what was compiled
    begun = time.process_time()
    for _ in range(ROUNDS):
        for words in sentences:
            grammar.parse(words)
    ours_s = (time.process_time() - begun) / ROUNDS
    theirs_s, same = 0.0, 0
    for words in sentences:
        begun = time.process_time()
        tree = next(iter(theirs.parse(list(words))), None)
        theirs_s += time.process_time() - begun
        mine = grammar.parse(words)
        if tree is None or mine is None:
            same += tree is None and mine is None
        else:
            same += math.isclose(math.log(tree.prob()), mine[0], rel_tol=SAME)
        on_done()
    number = len(sentences)
    parsed = sum(grammar.parse(words) is not None for words in sentences)
    lengths = [len(words) for words in sentences]
    return BenchReport(
        figures={
            "sentences": float(number),
            "parsed": parsed / number,
            "same_probability": same / number,
            "ms": 1000 * ours_s / number,
            "ratio_vs_nltk": theirs_s / ours_s,
        },
        baselines={"nltk.ms": 1000 * theirs_s / number},
        settings={
            "grammar": f"{len(grammar.productions)} productions, learned; the same for both",
            "sentences": f"{number} of {covered} with known words of {said}; {min(lengths)} to {max(lengths)} words",
            "nltk": "nltk.ViterbiParser, its best tree",
            "time": "processor time of one process; ours is the mean of several rounds",
        },
        notes=() if same == number else (f"{number - same} sentences got another best probability",),
    )


def _nltk_parser(grammar: ViterbiGrammar) -> Any:
    """NLTK's parser with the same productions."""
    nltk = import_module("nltk.grammar")
    parsers = import_module("nltk.parse.viterbi")
    productions = [
        nltk.ProbabilisticProduction(
            nltk.Nonterminal(rule.left),
            [part if rule.lexical else nltk.Nonterminal(part) for part in rule.right],
            prob=rule.probability,
        )
        for rule in grammar.productions
    ]
    return parsers.ViterbiParser(nltk.PCFG(nltk.Nonterminal(grammar.start), productions))


def _learned(release: Path | None, rng: np.random.Generator, seed: int) -> tuple[Knowledge, list[tuple[str, ...]]]:
    """Learn from a release, of our own making where none is given; and its sentences."""
    from learning.train_robots.synthetic import write_synthetic_release

    with TemporaryDirectory() as folder:
        where = release or Path(folder)
        if release is None:
            write_synthetic_release(where, rng, scenes=SCENES)
        given = Release.load(where)
        learner = Learner(seed=seed)
        study_release(learner, given.one_block_scenes(), given.commands, rng)
        learner.settle()
        return learner.knowledge, _sentences(where)


def _sentences(release: Path) -> list[tuple[str, ...]]:
    return [words_of(command.sentence) for command in Release.load(release).commands]
