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


def test_counts_survive_json() -> None:
    joined = heard("put it down")
    assert JoinedWords.from_json(joined.to_json()).to_json() == joined.to_json()
