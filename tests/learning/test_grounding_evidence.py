"""What counts bear out of a meaning: verbs that are also steps of other actions, and names of many kinds."""

from learning.concept_id import Concept
from learning.grounding.correlation import CorrelationMatrix
from learning.grounding.evidence import Evidence, any_like
from learning.grounding.grounding import Grounding

PICK, MOVE, PUT = (Concept("action", number) for number in range(3))
LEFT = Concept("direction", 0)


def heard(word: str, *actions: Concept, read_as: Concept | None = None) -> Evidence:
    """A language in which three actions are shown equally often, and a word was heard with these of them."""
    matrix, grounding = CorrelationMatrix(), Grounding()
    for shown in actions:
        matrix.observe((word,), (shown, any_like(shown)))
        grounding.add(word, read_as)
    for shown in (PICK, MOVE, PUT):
        for _ in range(60 - actions.count(shown)):
            matrix.observe(("the",), (shown, any_like(shown)))
    return Evidence(matrix, grounding, {})


def test_a_verb_that_is_also_a_step_of_another_action_may_say_what_it_mostly_goes_with() -> None:
    # "Raise the cup" is picking up, and "raise the cup and bring it there" is moving.
    evidence = heard("raise", *[PICK] * 21, *[MOVE] * 15)
    assert evidence.borne_out("raise", PICK)
    assert not evidence.borne_out("raise", MOVE)


def test_what_goes_with_an_action_as_chance_has_it_does_not_say_it() -> None:
    assert not heard("please", *[PICK] * 14, *[MOVE] * 12, *[PUT] * 10).borne_out("please", PICK)


def test_a_word_with_another_meaning_says_an_action_only_where_it_nearly_always_goes_with_it() -> None:
    assert not heard("left", *[PICK] * 21, *[MOVE] * 15, read_as=LEFT).borne_out("left", PICK)
    assert heard("left", *[PICK] * 30, *[MOVE] * 6, read_as=LEFT).borne_out("left", PICK)


def test_a_kind_that_has_one_name_is_what_the_name_means_however_many_kinds_that_names() -> None:
    """Perception may divide what people call by one word into many kinds, each seldom there when it is said."""
    kinds = [Concept("shape", number) for number in range(6)]
    matrix = CorrelationMatrix()
    for kind in kinds * 5:
        matrix.observe(("tub",), (kind, any_like(kind)))
    other = Concept("shape", 9)
    for _ in range(60):
        matrix.observe(("can",), (other, any_like(other)))
    for _ in range(8):  # the last of the kinds is called otherwise mostly
        matrix.observe(("can",), (kinds[-1], any_like(kinds[-1])))
    evidence = Evidence(matrix, Grounding(), {})
    assert all(evidence.borne_out("tub", kind) for kind in kinds[:-1])
    assert not evidence.borne_out("tub", kinds[-1])


def test_of_words_heard_with_a_direction_the_one_that_goes_with_it_most_surely_says_it() -> None:
    """ "In front of" is said of one direction, and "in" of corners and bowls, too."""
    front, behind = Concept("direction", 3), Concept("direction", 1)
    matrix = CorrelationMatrix()
    for _ in range(50):
        matrix.observe(("in", "front", "of"), (front, any_like(front)))
    for shown in [behind] * 34 + [front] * 2:
        matrix.observe(("in", "corner"), (shown, any_like(shown)))
    for _ in range(20):
        matrix.observe(("behind",), (behind, any_like(behind)))
    evidence = Evidence(matrix, Grounding(), {})
    assert evidence.outdone(("put", "it", "in", "front", "of", "the", "mug")) == {("in", front)}
    assert evidence.outdone(("behind", "in")) == {("in", behind)}


def test_what_was_heard_now_and_then_outdoes_nothing() -> None:
    left = Concept("direction", 0)
    matrix = CorrelationMatrix()
    for shown in [left] * 36 + [Concept("direction", 1)] * 4:
        matrix.observe(("left",), (shown, any_like(shown)))
    for _ in range(5):  # always with it, as chance has it
        matrix.observe(("kindly",), (left, any_like(left)))
    assert Evidence(matrix, Grounding(), {}).outdone(("kindly", "left")) == set()
