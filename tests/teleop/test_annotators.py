"""Annotators: what they say is true, and wrong only where they say so."""

import re

import numpy as np
import pytest

from teleop.annotators import (
    LANGUAGES,
    Destination,
    OrderingFacts,
    TableFacts,
    Thing,
    place_at,
    tell_ordering,
    tell_table,
)
from teleop.annotators.grammar import GRAMMARS, Arabic, English
from teleop.errors import TaskError
from twin.objects import CATALOGUES

THINGS = (
    Thing(0, "apple", "red", 0.5, 0.2),
    Thing(1, "bowl", "white", 0.8, 0.0),
    Thing(2, "apple", "green", 0.65, -0.2),
)


def _rng(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


def test_every_language_has_eight_people_who_know_every_word() -> None:
    for language, grammar in GRAMMARS.items():
        assert len(grammar.annotators) == 8
        assert len({each.name for each in grammar.annotators}) == 8
        for number, model in enumerate(CATALOGUES["ordering"]):
            for action in ("grasp", "lift", "hold", "lower", "drop", "press", "push"):
                assert tell_ordering(OrderingFacts.of_model(action, model), language, _rng(number)).text


def test_arabic_adjectives_agree_with_their_noun() -> None:
    grammar, plain = Arabic(), GRAMMARS["ar"].annotators[0]
    assert grammar.noun(plain, "apple", "red").text == "التفاحة الحمراء"
    assert grammar.noun(plain, "mug", "red").text == "الكوب الأحمر"
    assert grammar.noun(plain, "bottle", "white", "small").text == "الزجاجة البيضاء الصغيرة"
    assert grammar.noun(plain, "jar", "white", "small").text == "المرطبان الأبيض الصغير"
    bottle = grammar.noun(plain, "bottle", "white")
    assert grammar.command("اضغط على", bottle, "", "topic", "") == "الزجاجة البيضاء، اضغط عليها"
    assert grammar.located(bottle, "في وسط الطاولة").text == "الزجاجة البيضاء التي في وسط الطاولة"


def test_english_particles_go_behind_a_pronoun() -> None:
    grammar, plain = English(), GRAMMARS["en"].annotators[0]
    apple = grammar.noun(plain, "apple", "red")
    assert grammar.command("pick up", apple, "", "topic", "") == "the red apple, pick it up"
    assert grammar.command("move", apple, "in the top left corner", "plain", "") == (
        "move the red apple to the top left corner"
    )


def test_sentences_that_are_not_mistaken_name_the_right_colour_or_none() -> None:
    facts = TableFacts("move", THINGS[0], THINGS, Destination(relation="in", reference=1))
    told = [each for seed in range(60) for each in tell_table(facts, 5, "en", _rng(seed))]
    right = [each for each in told if not each.mistakes]
    assert 0.85 < len(right) / len(told) < 1.0  # a few percent are mistakes
    # Two apples: without a colour the red one could be the green one; that is rare.
    named = [each for each in right if re.search(r"\bred\b", each.text)]
    assert len(named) / len(right) > 0.9
    assert not any("green apple" in each.text for each in right)
    assert any(each.mistakes and each.mistakes[0].startswith("colour") for each in told)


def test_what_is_held_is_not_named_by_where_it_is() -> None:
    facts = TableFacts("put down", THINGS[0], THINGS, Destination(place=("top", "left")), held=True)
    for seed in range(40):
        for each in tell_table(facts, 8, "en", _rng(seed)):
            assert "that is" not in each.text


def test_each_sentence_has_its_own_author_and_the_same_seed_says_the_same() -> None:
    facts = TableFacts("pick up", THINGS[0], THINGS)
    for language in LANGUAGES:
        told = tell_table(facts, 5, language, _rng(4))
        assert len({each.annotator for each in told}) == 5
        assert told == tell_table(facts, 5, language, _rng(4))
        assert {each.language for each in told} == {language}


def test_parts_of_the_table() -> None:
    assert place_at(0.65, 0.0) == ("middle", "middle")
    assert place_at(0.8, 0.3) == ("top", "left")
    assert place_at(0.5, -0.3) == ("bottom", "right")


def test_unknown_languages_and_too_many_sentences_are_refused() -> None:
    facts = TableFacts("pick up", THINGS[0], THINGS)
    with pytest.raises(TaskError, match="nobody here speaks 'fr'; choose from en, ar"):
        tell_table(facts, 1, "fr", _rng(0))
    with pytest.raises(TaskError, match="9 sentences in 'en' need as many people, there are 8"):
        tell_table(facts, 9, "en", _rng(0))


def test_who_says_only_beside_what_a_thing_goes_says_no_side_of_it_and_is_known() -> None:
    facts = TableFacts("move", THINGS[2], THINGS, Destination(relation="left", reference=1))
    told = [each for seed in range(60) for each in tell_table(facts, 8, "en", _rng(seed)) if not each.mistakes]
    vague = [each for each in told if each.only_beside]
    assert 0 < len(vague) < 0.3 * len(told)
    assert all(re.search(r"\bleft\b", each.text) for each in told if not each.only_beside)
    assert not any(re.search(r"\bleft\b", each.text) for each in vague)
    place = TableFacts("move", THINGS[2], THINGS, Destination(place=("top", "left")))
    assert not any(each.only_beside for each in tell_table(place, 8, "en", _rng(1)))
