"""What was understood of a sentence, and why it had better not be acted on, in plain words that name the words."""

from typing import TYPE_CHECKING

from learning.concept_id import ACTION_SPACE, OBJECT_SPACES, Concept

if TYPE_CHECKING:
    from learning import Interpretation, Knowledge
    from learning.percept import Percept

SURE = 0.5
"""A word means a concept when Φ gives at least this."""


def heard(reading: "Interpretation") -> str:
    """Which words were understood as what, and which were never heard."""
    if reading.tree is None:
        return reading.explanation
    leaves = [node for node in reading.tree.nodes() if node.concept is not None]
    said = ", ".join(f"“{' '.join(reading.words[n.first - 1 : n.last])}” as {n.concept}" for n in leaves)
    parts = [f"understood {said}"]
    if reading.unknown:
        parts.append(f"never heard {_quoted(reading.unknown)}")
    return "; ".join(parts)


def doubt(reading: "Interpretation", knowledge: "Knowledge", percept: "Percept") -> str:
    """Why a sentence is not acted on, or nothing when it can be."""
    if not reading.understood:
        return _obstacle(reading.words, knowledge, percept)
    if reading.unheeded:
        obstacle = _obstacle(reading.words, knowledge, percept)
        if obstacle:
            return obstacle
        return f"nothing here is {_quoted(reading.unheeded)}, so I do nothing"
    strange = _strange_name(reading)
    if strange:
        return f"“{strange}” was never heard and may say which block is meant, so I do nothing"
    several = len(reading.object_candidates)
    if several > 1:
        nodes = reading.tree.nodes() if reading.tree else ()
        entity = next((node for node in nodes if node.label == "entity"), None)
        said = f"“{' '.join(reading.words[entity.first - 1 : entity.last])}”" if entity else "the words"
        return f"{several} objects fit {said}; say which one"
    return ""


def _strange_name(reading: "Interpretation") -> str:
    """A word that was never heard where the name of a thing ends without any word for its kind (`the green sphere`)."""
    for node in reading.tree.nodes() if reading.tree else ():
        kinds = {leaf.concept.space for leaf in node.nodes() if leaf.concept is not None}
        if node.label == "entity" and kinds and kinds <= {"colour", "location"} and node.last < len(reading.words):
            after = reading.words[node.last]  # words count from 1, so this is the next one
            if after in reading.unknown:
                return after
    return ""


def _obstacle(words: tuple[str, ...], knowledge: "Knowledge", percept: "Percept") -> str:
    """What stands in the way of a sentence that has no reading here, as far as single words tell; or nothing."""
    means: dict[str, Concept] = {}
    for word in words:
        for concept, probability in knowledge.language.grounding.meanings(word).items():
            if probability >= SURE:
                means[word] = concept
    table = knowledge.action_table()
    actions = {word: concept.number for word, concept in means.items() if concept.space == ACTION_SPACE}
    if actions:
        starts_held = [table.starts_held[number] for number in actions.values()]
        if all(starts_held) and percept.held is None:
            return f"“{next(iter(actions))}” needs a block in the gripper, and the robot holds nothing"
        if not any(starts_held) and percept.held is not None:
            return f"the gripper holds a block already, which “{next(iter(actions))}” has no use for; put it down first"
    looks = {word: concept for word, concept in means.items() if concept.space in OBJECT_SPACES[:2]}
    if looks:
        fits = [
            index
            for index in range(len(percept.object_ids))
            if all(percept.properties[concept.space][index] == concept.number for concept in looks.values())
        ]
        if fits and not any(percept.clear[index] for index in fits):
            return f"another block stands on what is {_quoted(tuple(looks))}; move that one first"
    return ""


def _quoted(words: tuple[str, ...]) -> str:
    return ", ".join(f"“{word}”" for word in words)
