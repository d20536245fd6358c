"""Public labels and values of the innate kinds of meaning, by what they measure: where they stand in a public tree."""

from learning.concept_id import Concept
from learning.grammar.innate import (
    ABOVE,
    BESIDE,
    CENTRE,
    COLLECTIVE,
    CORNER,
    COUNTS,
    EDGE,
    EXTREMES,
    GROUP,
    IT,
    NEAREST,
    NEAREST_ONE,
    ONE,
    REGION,
    SELF,
    SIDES,
    SINGLE,
    UNIT,
    WHOLE,
    WITHIN,
)

Named = tuple[str, str]
"""Public label and value of a leaf."""

AS_WORD: dict[Concept, Named] = {
    COLLECTIVE: ("type", "stack"),
    GROUP: ("type", "cube-group"),
    CORNER: ("type", "corner"),
    EDGE: ("type", "edge"),
    REGION: ("type", "region"),
    CENTRE: ("indicator", "center"),
    WHOLE: ("type", "board"),
    SELF: ("type", "robot"),
    UNIT: ("type", "tile"),
    IT: ("type", "reference"),
    ONE: ("type", "type-reference"),
    NEAREST_ONE: ("indicator", "nearest"),
    SINGLE: ("indicator", "individual"),
    ABOVE: ("relation", "above"),
    WITHIN: ("relation", "within"),
    NEAREST: ("relation", "nearest"),
    BESIDE: ("relation", "adjacent"),
    **{concept: ("cardinal", str(concept.number)) for concept in COUNTS},
    **dict(zip(SIDES, (("indicator", side) for side in ("front", "back", "left", "right")), strict=True)),
    **dict(zip(EXTREMES, (("indicator", f"{s}most") for s in ("front", "back", "left", "right")), strict=True)),
}
"""What a word says of a thing."""
AS_RELATION: dict[Concept, str] = dict(zip(SIDES, ("front", "backward", "left", "right"), strict=True))
"""Where something lies from something else."""
AS_HEADING: dict[Concept, str] = dict(zip(SIDES, ("forward", "backward", "left", "right"), strict=True))
"""Which way something is shifted."""
