"""Descriptions: words about one thing in any order ("two red blocks", "top left corner"), and what they mean."""

from dataclasses import dataclass

from learning.concept_id import Concept
from learning.grammar.board_elements import BoardElements
from learning.grammar.innate import (
    CENTRE,
    COLLECTIVE,
    CORNER,
    EXTREMES,
    FURTHEST,
    GROUP,
    IT,
    NEAREST_ONE,
    ONE,
    PLACES,
    REGION,
    UNIT,
    WHOLE,
)

Description = frozenset[Concept]
MOST_COLOURS = 3
MOST_WORDS = 5


@dataclass(frozen=True, slots=True)
class Sense:
    """One thing that a description may denote.

    Attributes:
        elements: Elements that fit it, as a mask.
        nearest: Whether the nearest of them is meant, to what is not said.
        refers: Whether it is the thing that was spoken of before.
        feature: How the description was understood.
        idle: Whether a rank or side in it ("nearest", "left") rules nothing out.
    """

    elements: int
    nearest: bool
    refers: bool
    feature: str
    idle: bool = False


def fits(description: Description, more: Concept) -> bool:
    """Whether a word can be said of the thing besides what was said already."""
    if more in description or len(description) >= MOST_WORDS:
        return False
    if IT in description or (more == IT and description):
        return False
    space = more.space
    same = [concept for concept in description if concept.space == space]
    if space == "colour":
        return len(same) < MOST_COLOURS
    if space == "side":
        return not same or (len(same) == 1 and (same[0].number // 2) != (more.number // 2))
    if space in ("shape", "kind", "reference"):
        heads = [concept for concept in description if concept.space in ("shape", "kind", "reference")]
        if len(heads) == 1 and CENTRE in (*heads, more):
            return any(concept in (WHOLE, REGION) for concept in (*heads, more))
        if len(heads) == 1 and COLLECTIVE in (*heads, more):
            # What stands on one another, and what it is made of: "a stack of blocks".
            return any(concept == GROUP or concept.space == "shape" for concept in (*heads, more))
        return not heads and more != UNIT
    return not same


def senses(description: Description, scene: BoardElements) -> list[Sense]:
    """Everything that a description can denote in a scene."""
    by_space: dict[str, list[Concept]] = {}
    for concept in description:
        by_space.setdefault(concept.space, []).append(concept)
    colours = by_space.get("colour", [])
    sides = frozenset(concept.number for concept in by_space.get("side", ()))
    rank = by_space["rank"][0] if "rank" in by_space else None
    size = by_space["count"][0].number if "count" in by_space else None
    kinds = set(by_space.get("kind", ()))
    reference = by_space["reference"][0] if "reference" in by_space else None
    if reference == IT:
        return [Sense(scene.things & scene.blocks, False, True, "it")]
    places = kinds & set(PLACES)
    if rank == FURTHEST:
        if len(sides) != 1:
            return []
        if places:
            rank = None
        else:
            rank, sides = EXTREMES[next(iter(sides))], frozenset()
    if places or (sides and len(description) == len(sides)):
        if colours or size is not None or (rank is not None and rank != NEAREST_ONE):
            return []
        kind = CENTRE if CENTRE in places else next(iter(places), REGION)
        if kind == CENTRE and sides or len(sides) > (2 if kind == CORNER else 1):
            return []
        mask = scene.landmarks(kind, sides)
        how = "place" if places else "side alone"
        idle = rank is not None and not scene.open_to_choice(mask)
        return [Sense(mask, rank == NEAREST_ONE, False, how, idle)] if mask else []
    found: list[tuple[int, str]] = []
    shape = by_space["shape"][0] if "shape" in by_space else None
    if not kinds and len(colours) < 2 and size in (None, 1):
        mask = scene.blocks
        for concept in (*colours, *((shape,) if shape else ())):
            mask &= scene.looking(concept)
        how = "thing" if shape else "one" if reference == ONE else "colour alone" if colours and size is None else ""
        if how:
            found.append((mask, how))
    if kinds or len(colours) > 1 or (size is not None and size > 1):
        how = "collective" if kinds else "group" if shape or reference else "colours alone"
        if shape is None or any(scene.looking(shape) & scene.looking(c) for c in colours) or not colours:
            found.append((scene.collectives(frozenset(colours), size if size != 1 else None), how))
    elif shape is not None and colours:
        found.append((scene.collectives(frozenset(colours), size), "group unsaid"))
    results: list[Sense] = []
    for mask, how in found:
        if not mask:
            continue
        idle = (rank is not None or bool(sides)) and not scene.open_to_choice(mask)
        if sides:
            # "The left block": the one furthest to that side.
            if rank is not None or len(sides) > 1:
                continue
            (side,) = sides
            furthest = scene.ranked(EXTREMES[side], mask)
            results += [Sense(part, False, False, f"{how}, side", idle) for part in furthest]
        elif rank is None or rank == NEAREST_ONE:
            results.append(Sense(mask, rank == NEAREST_ONE, False, how, idle))
        else:
            results += [Sense(part, False, False, how, idle) for part in scene.ranked(rank, mask) if part]
    return results
