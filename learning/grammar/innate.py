"""Innate kinds of meaning: what can be said of a scene at all, and never which word says it.

A kind is a concept whose meaning is a measurement that the learner can make without having learned anything: a tower, a
corner, the left side, nearest, two, "the thing spoken of before". Colours, shapes and actions are learned concepts and
are not listed here. Which word stands for which kind is learned from before and after alone.
"""

from learning.concept_id import REFERENCE, Concept

SIDES = tuple(Concept("side", number) for number in range(4))
"""The four horizontal directions along the axes of the robot's base: +x, -x, +y, -y."""
SIDE_STEPS = ((1, 0), (-1, 0), (0, 1), (0, -1))
"""Steps along x and y of each of `SIDES`."""
LARGEST_COUNT = 4
COUNTS = tuple(Concept("count", number) for number in range(1, LARGEST_COUNT + 1))

COLLECTIVE = Concept("kind", 0)
"""Things that stand on one another and are spoken of as one."""
CORNER = Concept("kind", 1)
EDGE = Concept("kind", 2)
REGION = Concept("kind", 3)
"""One side of the workspace as a whole."""
CENTRE = Concept("kind", 4)
WHOLE = Concept("kind", 5)
"""The workspace itself: its surface."""
SELF = Concept("kind", 6)
"""The robot."""
UNIT = Concept("kind", 7)
"""What distances are counted in: the room that one object takes."""
GROUP = Concept("kind", 8)
"""Things that stand on one another, called by a word that resembles that for one of them."""
PLACES = (CORNER, EDGE, REGION, CENTRE, WHOLE, SELF)
COLLECTIVES = (COLLECTIVE, GROUP)
KINDS = (*COLLECTIVES, *PLACES, UNIT)

ABOVE = Concept("relation", 0)
WITHIN = Concept("relation", 1)
NEAREST = Concept("relation", 2)
BESIDE = Concept("relation", 3)
RELATIONS = (ABOVE, WITHIN, NEAREST, BESIDE)

NEAREST_ONE = Concept("rank", 0)
"""Nearest to the robot, or to what is moved."""
SINGLE = Concept("rank", 1)
"""Alone in its column."""
EXTREMES = tuple(Concept("rank", 2 + number) for number in range(4))
"""Furthest to each of `SIDES`."""
OTHER = Concept("rank", 6)
"""Not the one that was spoken of before; it rules nothing out that the scene does not."""
FURTHEST = Concept("rank", 7)
"""Of a side that is said beside it: furthest to that side."""
RANKS = (NEAREST_ONE, SINGLE, *EXTREMES, OTHER, FURTHEST)

IT = REFERENCE
"""The very thing that was spoken of before."""
ONE = Concept("reference", 2)
"""Another thing of the sort that was spoken of before."""
REFERENCES = (IT, ONE)

INNATE = frozenset((*SIDES, *COUNTS, *KINDS, *RELATIONS, *RANKS, *REFERENCES))
INNATE_SPACES = frozenset(concept.space for concept in INNATE)

_TOWARDS = ("+x", "-x", "+y", "-y")
MEASURED: dict[Concept, str] = {
    **{side: f"towards {axis}" for side, axis in zip(SIDES, _TOWARDS, strict=True)},
    **{count: f"{count.number} of them" for count in COUNTS},
    **{rank: f"furthest towards {axis}" for rank, axis in zip(EXTREMES, _TOWARDS, strict=True)},
    COLLECTIVE: "things standing on one another",
    GROUP: "the same, called by what they are",
    CORNER: "where two edges meet",
    EDGE: "outermost row",
    REGION: "one half of the workspace",
    CENTRE: "middle of the workspace",
    WHOLE: "surface of the workspace",
    SELF: "where the robot stands",
    UNIT: "room that one thing takes",
    ABOVE: "straight on it",
    WITHIN: "inside it",
    NEAREST: "nearest of all to it",
    BESIDE: "next to it on any side",
    NEAREST_ONE: "nearest to the robot or to what moves",
    SINGLE: "alone in its column",
    FURTHEST: "furthest to the side that is said",
    OTHER: "not the one spoken of before",
    IT: "what was spoken of before",
    ONE: "another of the sort spoken of before",
}
"""What each kind measures, for tables; never shown to the learner."""
