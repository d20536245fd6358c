"""Parts of joined words come out of counts alone, in any language."""

from learning.grounding.joined_words import JoinedWords


def heard(*sentences: str, times: int = 5) -> JoinedWords:
    joined = JoinedWords()
    for sentence in sentences:
        for _ in range(times):
            joined.hear(tuple(sentence.split()))
    return joined


def test_an_ending_met_with_several_words_is_a_part() -> None:
    joined = heard("ضع", "انقل", "حرك")
    for word in ("ضعها", "انقلها", "حركها"):
        joined.hear((word,))
    assert joined.pieces("ضعها") == ("ضع", "ها")


def test_beginning_and_ending_come_off_together() -> None:
    joined = heard("take", "put", "move")
    for word in ("takezo", "putzo", "movezo", "watakezo", "waputzo", "wamovezo"):
        joined.hear((word,))
    assert joined.split(("waputzo", "box")) == (("wa", "put", "zo", "box"), (0, 0, 0, 1))


def test_two_stems_are_enough_where_they_are_met_in_several_forms() -> None:
    joined = heard("take", "put", "move", "see")
    for word in ("takezo", "putzo", "movezo", "waputzo", "waput", "watakezo", "xsee", "xput"):
        joined.hear((word,))
    assert joined.pieces("waputzo") == ("wa", "put", "zo")
    assert joined.pieces("xput") == ("xput",)


def test_two_words_that_look_alike_are_no_parts() -> None:
    joined = heard("in to into on onto side inside")
    assert joined.pieces("inside") == ("inside",)
    assert joined.pieces("into") == ("into",)


def test_swapped_letters_of_a_rare_word_are_put_right() -> None:
    joined = heard("take the yellow fork", "lift the left form")
    joined.hear(("yelolw",))
    assert joined.pieces("yelolw") == ("yellow",)
    assert joined.pieces("left") == ("left",)


def test_a_slip_in_a_joined_word_is_put_right() -> None:
    joined = heard("take", "put", "move")
    for word in ("takezo", "putzo", "movezo", "tkaezo"):
        joined.hear((word,))
    assert joined.pieces("tkaezo") == ("take", "zo")


def test_a_slip_that_comes_again_is_put_right_where_the_right_word_is_heard_far_more_often() -> None:
    joined = heard("take the pear from there", times=40)
    for _ in range(4):
        joined.hear(("paer",))
    for _ in range(5):
        joined.hear(("form",))
    assert joined.pieces("paer") == ("pear",)
    assert joined.pieces("form") == ("form",)


def test_an_ending_in_the_place_of_a_known_one_is_met_with_fewer_words() -> None:
    joined = heard("take", "put", "move", "see")
    for word in ("takezo", "putzo", "movezo", "takeq", "putq", "seex"):
        joined.hear((word,))
    assert joined.pieces("moveq") == ("move", "q")  # never heard, but take and put have both endings
    assert joined.pieces("putx") == ("putx",)  # x is met with one word alone


def test_a_word_heard_twice_is_enough_of_a_stem_for_a_known_ending() -> None:
    joined = heard("take", "put", "move")
    for word in ("takezo", "putzo", "movezo", "lower", "lower", "press", "presszo"):
        joined.hear((word,))
    assert joined.pieces("lowerzo") == ("lower", "zo")
    assert joined.pieces("presszo") == ("presszo",)


def test_what_a_part_is_in_is_told_of_words_that_are_taken_apart_alone() -> None:
    joined = heard("take", "put", "move")
    for word in ("takezo", "putzo", "movezo", "watakezo", "waputzo", "wamovezo"):
        joined.hear((word,))
    assert joined.larger("waputzo", "put") == ["waputzo", "wa put", "wa put zo", "put zo"]
    assert joined.larger("put", "put") == []
    assert {"wa put", "put zo", "wa put zo"} <= joined.compounds()
    assert not joined.compounds() & set(joined.counts)


def test_counts_survive_json() -> None:
    joined = heard("put it down")
    assert JoinedWords.from_json(joined.to_json()).to_json() == joined.to_json()
