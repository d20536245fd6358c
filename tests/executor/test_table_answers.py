"""Answers at tables to words that are mistyped, never heard, or heard and not understood yet."""

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from executor import Executor
from executor.execution.answer import Answer
from executor.lexicon import entry_of
from executor.talk.said_words import words_of_report
from executor.word_kinds import WordKind
from learning import Knowledge
from learning.concept_id import Concept
from tests.executor.table_cases import CASES, knowledge_of
from twin import World


@pytest.fixture
def baxter(tmp_path: Path) -> Iterator[Executor]:
    with World.from_scene(CASES["baxter"].write(tmp_path)) as world:
        executor = Executor(world, Knowledge.load(knowledge_of("baxter")), np.random.default_rng(0))
        yield executor
        executor.doer.close()


def test_what_is_mistyped_in_either_language_is_taken_as_what_it_stands_for(baxter: Executor) -> None:
    plain = baxter.preview("pick up the orange apple")
    assert plain.answer is Answer.PLANNED and plain.spelling == ()
    for sentence, note in (
        ("pick up teh ornge appel", "I take “teh” as “the”; I take “ornge” as “orange”; I take “appel” as “apple”"),
        ("التقط التفااحة", "I take “التفااحة” as “التفاحة”"),  # a letter doubled
        ("التقط التفحة", "I take “التفحة” as “التفاحة”"),  # a letter dropped
    ):
        report = baxter.preview(sentence)
        assert report.answer is Answer.PLANNED, report.reason
        assert report.reason == f"{note}; {plain.reason}"
        assert words_of_report(report, baxter.knowledge)[-1].kind is WordKind.SHAPE
        assert report.goals[0].object_id == plain.goals[0].object_id
    assert baxter.world.time == 0.0


def test_a_word_that_is_like_no_other_is_named(baxter: Executor) -> None:
    report = baxter.preview("pick up the glorbin")
    assert report.answer is Answer.UNKNOWN_WORD and report.unknown == ("glorbin",) and report.spelling == ()
    assert report.reason == "I never heard “glorbin”; show me: record a demo and say it"


def test_a_word_that_was_heard_and_not_understood_is_told_from_one_that_was_never_heard(baxter: Executor) -> None:
    tongue = baxter.knowledge.table_language.tongues["LATIN"]
    for _ in range(3):
        tongue.joined.hear(("thingummy",))
    assert baxter.doer.knows("thingummy") and not baxter.doer.knows("glorbin")
    report = baxter.preview("pick up the thingummy")
    assert report.answer is Answer.UNKNOWN_WORD and report.unknown == ("thingummy",)
    assert report.reason == (
        "I heard “thingummy” 3 times and do not understand it yet; show me again: record a demo and say it"
    )
    assert words_of_report(report, baxter.knowledge)[-1].kind is WordKind.UNSURE
    assert entry_of(baxter.knowledge, "thingummy").heard == 3.0
    tongue.joined.hear(("whatsit",))
    assert "I heard “whatsit” once and" in baxter.preview("pick up the whatsit").reason
    assert "I never heard “glorbin”" in baxter.preview("pick up the glorbin and the whatsit").reason
    assert baxter.world.time == 0.0


def test_a_word_that_means_something_only_with_another_is_no_unknown_one(tmp_path: Path) -> None:
    knowledge = Knowledge.load(knowledge_of("mico_segway"))
    tongue = knowledge.table_language.tongues["ARABIC"]
    assert tongue.joined.counts["على"] > 0.0 and tongue.grounding.total("على") == 0.0  # only "press on" was read
    with World.from_scene(CASES["mico_segway"].write(tmp_path)) as world:
        executor = Executor(world, knowledge, np.random.default_rng(0))
        assert executor.preview("اضغط على الكرتونة").answer is Answer.PLANNED
        executor.doer.close()


@pytest.mark.parametrize("joint", [" and glorbin ", ", glorbin "])
def test_a_strange_word_may_join_two_steps_after_what_does_so(baxter: Executor, joint: str) -> None:
    report = baxter.preview(f"pick up the orange apple{joint}put it to the left of the blue cube")
    assert report.answer is Answer.PLANNED and report.reason == "these are the 2 steps"


def test_a_strange_word_before_what_joins_two_steps_is_never_dropped(baxter: Executor) -> None:
    """It may be the name of what is meant."""
    report = baxter.preview("pick up the orange glorbin and put it to the left of the blue cube")
    assert report.answer is Answer.UNKNOWN_WORD and report.unknown == ("glorbin",)


def test_a_name_is_not_taken_for_what_it_hardly_ever_meant(baxter: Executor) -> None:
    counts = baxter.knowledge.table_language.tongues["LATIN"].grounding.counts
    (apple,) = counts["apple"]
    counts["apple"] = defaultdict(float, {Concept("shape", 2): 60.0, apple: 1.0})
    report = baxter.preview("pick up the apple")
    assert report.answer is Answer.IMPOSSIBLE and report.reason == "nothing here is “apple”"


def test_a_word_that_mostly_means_nothing_may_be_heard_as_anything(baxter: Executor) -> None:
    counts = baxter.knowledge.table_language.tongues["LATIN"].grounding.counts
    (apple,) = counts["apple"]
    counts["apple"] = defaultdict(float, {None: 300.0, Concept("shape", 2): 40.0, apple: 1.0})
    assert "apple" not in baxter.preview("pick up the apple").reason
