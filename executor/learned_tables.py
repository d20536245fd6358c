"""What was learned, as rows for tables: concepts with their words, actions, grammar rules, sizes.

A concept is shown by its own mean (a patch of its colour, a place, a direction), never by a name of ours: names are
what was learned.
"""

import colorsys
import json
import math
from typing import TYPE_CHECKING

from executor.table_words import meanings_of
from learning.concept_id import ACTION_SPACE, Concept
from learning.concepts.feature_space import Colour
from learning.concepts.table_spaces import LIGHTNESS_WEIGHT, PROPORTION_WEIGHT, TableColour
from learning.grammar.innate import INNATE, MEASURED

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.concepts.feature_space import FeatureSpace
    from robots.pose import FloatArray

LEAST_PROBABILITY = 0.4
"""An n-gram stands with a concept when Φ gives at least this."""
LEAST_SUPPORT = 1.5
"""And when it was validated at least this often: once may be chance."""
FPFH_BINS = 33
"""Bins of a shape's descriptor; what a mean has besides are the logarithms of its proportions."""
WORDS = 7
"""Most n-grams shown with one concept."""

Rgb = tuple[int, int, int]


def colour_of(mean: "FloatArray", space: "type[FeatureSpace]" = Colour) -> Rgb:
    """Colour of a colour concept's mean, as red, green, blue in 0..255.

    Args:
        mean: S cos 2πH, S sin 2πH, and L as the space weighs it, (3,).
        space: Feature space of the concept.
    """
    weight = LIGHTNESS_WEIGHT if issubclass(space, TableColour) else 1.0
    hue = math.atan2(mean[1], mean[0]) / (2 * math.pi) % 1.0
    saturation = min(1.0, math.hypot(mean[0], mean[1]))
    red, green, blue = colorsys.hls_to_rgb(hue, min(max(float(mean[2]) / weight, 0.0), 1.0), saturation)
    return round(255 * red), round(255 * green), round(255 * blue)


def described(space: str, mean: "FloatArray", kind: "type[FeatureSpace]" = Colour) -> str:
    """Describe a concept by its mean, in units; `kind` is the class of its feature space."""
    if space == "colour":
        return "#{:02x}{:02x}{:02x}".format(*colour_of(mean, kind))
    if space == "location":
        return f"at ({1000 * mean[0]:.0f}, {1000 * mean[1]:.0f}) mm"
    if space == "distance":
        return f"{1000 * mean[0]:.0f} mm"
    if space == "direction":
        azimuth, altitude = math.atan2(mean[1], mean[0]), math.atan2(mean[2], math.hypot(mean[0], mean[1]))
        if abs(altitude) > math.radians(75):
            return f"altitude {math.degrees(altitude):.0f}°"
        return f"azimuth {math.degrees(azimuth):.0f}°, altitude {math.degrees(altitude):.0f}°"
    if space == "shape":
        top = sorted(range(FPFH_BINS), key=lambda index: -float(mean[index]))[:3]
        told = "highest FPFH bins " + ", ".join(f"{index} ({mean[index]:.2f})" for index in top)
        if len(mean) > FPFH_BINS:
            width, height = (math.exp(float(value) / PROPORTION_WEIGHT) for value in mean[FPFH_BINS:])
            told += f"; width {width:.2f}, height {height:.2f} of the length"
        return told
    if space == "size":
        return f"{1000 * math.exp(mean[0]):.0f} mm, mean of its sides"
    if space == "weight":
        return f"{1000 * mean[0]:.0f} g"
    return ""


def words_of_concepts(knowledge: "Knowledge") -> dict[Concept, list[tuple[str, float, float]]]:
    """N-grams that mean each concept, with Φ and how often they were validated; the most frequent first.

    Those of the board's language, and of each language of tables.
    """
    grounding = knowledge.language.grounding
    found: dict[Concept, list[tuple[str, float, float]]] = {}
    for ngram in grounding.counts:
        for concept, probability in grounding.meanings(ngram).items():
            support = grounding.counts[ngram][concept]
            # Passed over more often than grounded: a function word.
            passed = grounding.total(ngram) - grounding.grounded(ngram)
            if probability >= LEAST_PROBABILITY and support >= LEAST_SUPPORT and support >= passed:
                found.setdefault(concept, []).append((ngram, probability, support))
    for tongue in knowledge.table_language.tongues.values():
        for concept, entries in meanings_of(tongue).items():
            found.setdefault(concept, []).extend(entries)
    for row in found.values():
        row.sort(key=lambda entry: -entry[2])
    return found


def function_words(knowledge: "Knowledge") -> list[str]:
    """Words that readings pass over, the most frequent first."""
    grounding = knowledge.language.grounding
    passed = {
        ngram: row[None]
        for ngram, row in grounding.counts.items()
        if " " not in ngram and row.get(None, 0.0) >= LEAST_SUPPORT and row[None] > grounding.grounded(ngram)
    }
    return sorted(passed, key=lambda word: -passed[word])


def concept_rows(knowledge: "Knowledge") -> list[tuple[Concept, str, int, list[tuple[str, float, float]]]]:
    """All concepts but actions: id, its mean or what it measures, demos it was seen in, and its words.

    Innate kinds of meaning stand in it only where words were learned for them.
    """
    words = words_of_concepts(knowledge)
    rows = []
    for space, mixture in knowledge.spaces.mixtures.items():
        for number, component in mixture.components.items():
            concept = Concept(space, number)
            told = described(space, component.mean, mixture.space)
            rows.append((concept, told, component.demos, words.get(concept, [])))
    rows += [(concept, MEASURED[concept], 0, words[concept]) for concept in sorted(INNATE) if concept in words]
    return rows


def action_rows(knowledge: "Knowledge") -> list[tuple[Concept, str, list[tuple[str, float, float]]]]:
    """All actions: id, states and words. O and C: gripper open and closed; the number is the object's place."""
    words = words_of_concepts(knowledge)
    return [
        (Concept(ACTION_SPACE, number), str(graphlet), words.get(Concept(ACTION_SPACE, number), []))
        for number, graphlet in knowledge.spaces.actions.numbered.items()
    ]


def rule_rows(knowledge: "Knowledge", most: int) -> list[tuple[str, str, float, float]]:
    """The most frequent rules between elements: left side, right side, probability, count."""
    grammar = knowledge.language.grammar
    rows = [
        (left, " ".join(right), grammar.probability(left, right), count)
        for left, row in grammar.rules.items()
        for right, count in row.items()
    ]
    return sorted(rows, key=lambda row: -row[3])[:most]


def part_sizes(knowledge: "Knowledge") -> dict[str, int]:
    """Size of each part of the knowledge file, without its layout [bytes]."""
    data = knowledge.to_json()
    sizes: dict[str, int] = {}
    for name, part in data.items():
        if name in ("concepts", "language"):
            sizes |= {f"{name}.{inner}": len(json.dumps(value)) for inner, value in part.items()}
        else:
            sizes[name] = len(json.dumps(part))
    return sizes


def spoken(entries: list[tuple[str, float, float]]) -> str:
    """N-grams with Φ in brackets."""
    shown = [f"{ngram} ({probability:.2f})" for ngram, probability, _ in entries[:WORDS]]
    more = len(entries) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more > 0 else "")
