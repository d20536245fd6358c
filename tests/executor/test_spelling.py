"""Words that a person mistypes: taken as what they stand for, asked about, or left unknown."""

from itertools import product

import numpy as np
import pytest

from executor import Executor
from executor.execution.answer import Answer
from executor.execution.evaluation.suite_cases import SYLLABLES
from executor.execution.session import Session
from executor.execution.spelling import spellings_of
from executor.tables.suite_commands import SYLLABLES as TABLE_SYLLABLES
from executor.talk.said_words import words_of_report
from executor.word_kinds import WordKind
from learning import Knowledge
from learning.concept_id import Concept
from learning.grounding.ngrams import with_words
from learning.grounding.slips import distance
from learning.grounding.tongue import Tongue
from tests.executor.test_execution import PLAIN
from twin import World


@pytest.fixture
def own(knowledge_file: str) -> Knowledge:
    """Knowledge of one test alone."""
    return Knowledge.load(knowledge_file)


@pytest.mark.parametrize(
    ("word", "other", "slips"),
    [
        ("blu", "blue", 1),
        ("bllue", "blue", 1),
        ("blie", "blue", 1),
        ("bleu", "blue", 1),
        ("blue", "blue", 0),
        ("cube", "blue", None),
        ("التفاحة", "التفحة", 1),
        ("cyilndr", "cylinder", 2),
        ("cylinder", "c", None),
    ],
)
def test_slips_are_counted_both_ways(word: str, other: str, slips: int | None) -> None:
    assert distance(word, other, 2) == distance(other, word, 2) == slips


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("blu", "blue"),
        ("cubee", "cube"),
        ("prsim", "prism"),
        ("teh", "the"),
        ("yelow", "yellow"),
        ("mgenta", "magenta"),
        ("mmagennta", "magenta"),  # nine letters: two slips
        ("mgennta", None),  # seven letters: one slip only
        ("rd", None),  # too short
        ("rad", None),  # of three letters, two may only change places
        ("on2", None),  # digits are never guessed
        ("turquoise", None),
    ],
)
def test_a_word_is_taken_as_the_one_that_it_is_a_slip_for(typed: str, meant: str | None, own: Knowledge) -> None:
    assert [each.taken for each in spellings_of([typed], own)] == ([] if meant is None else [meant])


def test_of_several_words_each_meaning_is_offered_once_and_rare_ones_give_way(own: Knowledge) -> None:
    grounding = own.language.grounding
    grounding.add("glue", Concept("shape", 1), 20.0)
    grounding.add("clue's", Concept("shape", 1), 20.0)
    (asked,) = spellings_of(["clue"], own)
    assert asked.taken is None and asked.candidates == ("blue", "glue")
    grounding.add("flue", Concept("colour", own_number(own, "blue")), 30.0)  # means what another one means
    assert spellings_of(["clue"], own)[0].candidates == ("blue", "glue")
    grounding.add("glue", Concept("shape", 1), -18.0)
    assert spellings_of(["clue"], own)[0].taken == "blue"


def own_number(knowledge: Knowledge, word: str) -> int:
    return max(knowledge.language.grounding.meanings(word)).number


def test_words_that_nobody_says_are_like_no_other(own: Knowledge) -> None:
    made = ["".join(parts) for count in (2, 3) for parts in product(SYLLABLES, repeat=count)]
    assert spellings_of(made, own) == ()
    assert set(SYLLABLES) == set(TABLE_SYLLABLES["en"])


def test_a_mistyped_command_is_done_and_the_answer_says_how_it_was_taken(own: Knowledge) -> None:
    sentence = "Put teh red cueb on the blu cube, then take the white prsim!"
    with World.from_scene(PLAIN) as world:
        executor = Executor(world, own, np.random.default_rng(0))
        seen = executor.preview(sentence)
        assert world.time == 0.0
        done = executor.execute(sentence)
        assert world.state().held == 2
    notes = "I take “teh” as “the”; I take “cueb” as “cube”; I take “blu” as “blue”; I take “prsim” as “prism”"
    assert seen.answer is Answer.PLANNED and seen.reason == f"{notes}; these are the 2 steps"
    assert done.answer is Answer.DONE and done.reason == f"{notes}; 2 of 2 steps done"
    assert done.sentence == sentence
    assert {"word": "blu", "taken": "blue", "candidates": ["blue"]} in done.to_dict()["spelling"]  # type: ignore[operator]
    told = {word.text: word.kind for word in words_of_report(seen, own)}
    assert told["blu"] is WordKind.COLOUR and told["cueb"] is WordKind.SHAPE  # as it was typed


def test_what_may_be_several_words_is_asked_and_can_be_chosen(own: Knowledge) -> None:
    own.language.grounding.add("glue", Concept("shape", 1), 50.0)
    with World.from_scene(PLAIN) as world:
        session = Session(Executor(world, own, np.random.default_rng(0)))
        said = session.answer("take the clue cube")
        assert world.time == 0.0
        assert said is not None and said.splitlines() == [
            "unknown-word: I never heard “clue”: perhaps you mean “blue” or “glue”; if not, show me: record a demo and "
            "say it",
            "  1. blue",
            "  2. glue",
        ]
        assert session.answer("3") == "there is no choice 3; say 1 to 2"
        chosen = session.answer("1")
        assert chosen is not None and chosen.startswith("done")
        assert world.state().held == 1


def test_one_word_that_is_like_no_other_leaves_the_command_undone(own: Knowledge) -> None:
    with World.from_scene(PLAIN) as world:
        report = Executor(world, own).execute("take the blu zorch")
        assert world.time == 0.0
    assert report.answer is Answer.UNKNOWN_WORD and report.unknown == ("zorch",)
    assert report.reason == "I take “blu” as “blue”; I never heard “zorch”; show me: record a demo and say it"


def test_what_is_known_is_never_taken_as_another_word(own: Knowledge) -> None:
    white = Concept("colour", own_number(own, "white"))
    own.language.grounding.add("blu", white, 5.0)
    own.language.correlation.observe(["blu"], [white])
    with World.from_scene(PLAIN) as world:
        report = Executor(world, own).execute("take the blu prism", plan_only=True)
    assert report.answer is Answer.PLANNED and report.spelling == ()


def test_words_at_tables_are_looked_for_in_the_language_of_their_letters() -> None:
    known = Knowledge("table")
    for script, words in (("ARABIC", ("ارفع", "التفاحة", "الزرقاء")), ("LATIN", ("lift", "apple", "blue"))):
        tongue = known.table_language.tongues.setdefault(script, Tongue())
        for number, word in enumerate(words):
            tongue.joined.hear((word,) * 5)
            tongue.grounding.add(word, Concept("colour", number), 5.0)
    found = {each.word: each.taken for each in spellings_of(["التفااحة", "التفحة", "الزرقا", "aple", "الموزة"], known)}
    assert found == {"التفااحة": "التفاحة", "التفحة": "التفاحة", "الزرقا": "الزرقاء", "aple": "apple"}


def test_words_are_replaced_where_they_stand() -> None:
    assert with_words("Put teh cube on teh Tehran’s!", {"teh": "the"}) == "Put the cube on the Tehran's!"
