"""What was understood of a sentence, and why it had better not be acted on, as far as single words tell."""

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from learning.concept_id import ACTION_SPACE, OBJECT_SPACES, Concept
from learning.grammar.innate import CENTRE, COLLECTIVE, CORNER, EDGE, EXTREMES, FURTHEST, IT, SIDES

if TYPE_CHECKING:
    from learning import Interpretation, Knowledge
    from learning.grammar.rcl import RclNode
    from learning.percept import Percept

SURE = 0.5
"""A word means a concept when Φ gives at least this."""
SURELY = 0.8
"""A word that means one concept in this share of all its uses is not passed over without a reason;"""
LOOKS_SURELY = 0.6
"""for words of looks, which are seldom said in vain, less is enough."""
ESTABLISHED = 3.0
"""Uses after which that share is trusted."""
FAR_FETCHED = 0.03
"""A word is not taken for what it meant in a smaller share of its uses,"""
OFTEN = 10.0
"""if it was used this often."""
LOOKS = OBJECT_SPACES[:2]
TELLING = frozenset((COLLECTIVE, CORNER, EDGE, CENTRE))
"""Kinds of element whose words say which one is meant; those for the board itself are left out at will."""
TELLING_SPACES = ("side", "count", "rank")


def heard(reading: "Interpretation") -> str:
    """Which words were understood as what, and which were never heard."""
    if reading.tree is None:
        return reading.explanation
    leaves = [node for node in reading.tree.nodes() if node.concept is not None]
    said = ", ".join(f"“{' '.join(reading.words[n.first - 1 : n.last])}” as {n.concept}" for n in leaves)
    return f"understood {said}"


def surely_means(word: str, knowledge: "Knowledge") -> Concept | None:
    """The concept that a word means in nearly all its uses, passing over among them; None if there is none."""
    row = _uses(word, knowledge)
    total = sum(row.values())
    if total < ESTABLISHED:
        return None
    for concept, count in row.items():
        if concept is not None and count >= (LOOKS_SURELY if concept.space in LOOKS else SURELY) * total:
            return concept
    return None


def passed_over(words: Sequence[str], tree: "RclNode | None", knowledge: "Knowledge") -> tuple[str, ...]:
    """Words that surely mean something and have no part in a reading: acting on it would do something else."""
    used: dict[int, Concept] = {}
    done: set[Concept] = set()
    within: set[int] = set()
    for node in tree.nodes() if tree else ():
        if node.concept is not None:
            used.update(dict.fromkeys(range(node.first - 1, node.last), node.concept))
            done.add(node.concept)
        elif node.label == "entity":
            within.update(range(node.first - 1, node.last))
    lost = []
    nowhere = not any(node.label == "spatial-relation" for node in tree.nodes()) if tree else False
    for position, word in enumerate(words):
        if position in used:
            continue
        if refers(word, knowledge) or (nowhere and _mostly(word, knowledge, ("relation", "side"))):
            lost.append(word)
            continue
        beside = [at for at in (position - 1, position + 1) if at in used and used[at].space in LOOKS]
        if any(_tells_more(word, words[at], used[at], knowledge) for at in beside):
            lost.append(word)
            continue
        concept = surely_means(word, knowledge)
        if concept is None:
            continue
        if concept.space in (used[at].space for at in beside):
            continue  # the less telling part of a name of two words, such as a shade
        telling = concept.space in (*LOOKS, *TELLING_SPACES) or concept in TELLING
        # No other thing is done in the middle of the name of a thing ("the red and blue tower").
        acting = concept.space == ACTION_SPACE and concept not in done and position not in within
        if telling or (acting and not _beside_action(words, position, used, knowledge)):
            lost.append(word)
    return tuple(dict.fromkeys(lost))


def _tells_more(word: str, other: str, means: Concept, knowledge: "Knowledge") -> bool:
    """Whether a word mostly says that another next to it does not mean its usual look: "light" blue is no blue.

    The rarer of two words in a name is the one that tells ("sky" of "sky blue").
    """
    row = _uses(word, knowledge)
    total = sum(row.values())
    if total < ESTABLISHED or total >= sum(_uses(other, knowledge).values()):
        return False
    looks = sum(count for each, count in row.items() if each is not None and each.space == means.space)
    return looks - row.get(means, 0.0) > SURE * total


def far_fetched(words: Sequence[str], tree: "RclNode | None", knowledge: "Knowledge") -> tuple[str, ...]:
    """Words that a reading takes for what they hardly ever meant: it fits the scene rather than the sentence."""
    found = []
    for node in tree.nodes() if tree else ():
        if node.concept is not None:
            said = words[node.first - 1 : node.last]
            names = (*said, " ".join(said))
            if max(_share(name, each, knowledge) for name in names for each in _made_of(node.concept)) < FAR_FETCHED:
                found.append(" ".join(said))
    return tuple(found)


def _made_of(concept: Concept) -> tuple[Concept, ...]:
    """What the words for a concept may mean on their own: "left most" is a side and "furthest"."""
    if concept not in EXTREMES:
        return (concept,)
    return (concept, FURTHEST, SIDES[EXTREMES.index(concept)])


def _share(word: str, concept: Concept, knowledge: "Knowledge") -> float:
    """Share of the uses of a word in which it meant a concept; 1 where it was not used often.

    Of a word that is mostly passed over ("to") only the uses count in which it meant anything, if there are enough.
    """
    row = _uses(word, knowledge)
    total = sum(row.values())
    if " " in word and not row:
        return 0.0  # no word of its own, only some in a row
    if total < OFTEN:
        return 1.0
    meant = total - row.get(None, 0.0)
    return row.get(concept, 0.0) / (meant if meant >= OFTEN else total)


def _uses(word: str, knowledge: "Knowledge") -> Mapping[Concept | None, float]:
    """How often a word was used for what, and passed over."""
    found: Mapping[Concept | None, float] = knowledge.language.grounding.counts.get(word) or {}
    return found


def refers(word: str, knowledge: "Knowledge") -> bool:
    """Whether a word mostly stands for what was spoken of before."""
    row = _uses(word, knowledge)
    return row.get(IT, 0.0) >= SURE * max(sum(row.values()), ESTABLISHED)


def _mostly(word: str, knowledge: "Knowledge", spaces: Iterable[str]) -> bool:
    """Whether more than half of all uses of a word are of concepts of these spaces."""
    row = _uses(word, knowledge)
    total = sum(row.values())
    within = sum(count for concept, count in row.items() if concept is not None and concept.space in spaces)
    return total >= ESTABLISHED and within > SURE * total


def _beside_action(words: Sequence[str], position: int, used: Iterable[int], knowledge: "Knowledge") -> bool:
    """Whether a word stands in a row of words for actions of which one is used ("pick up")."""
    at = set(used)
    for step in (-1, 1):
        other = position + step
        while 0 <= other < len(words) and _acts(words[other], knowledge):
            if other in at:
                return True
            other += step
    return False


def _acts(word: str, knowledge: "Knowledge") -> bool:
    meanings = knowledge.language.grounding.meanings(word)
    return sum(p for concept, p in meanings.items() if concept.space == ACTION_SPACE) >= SURE


def action_words(words: Iterable[str], knowledge: "Knowledge") -> tuple[str, ...]:
    """The words that name actions."""
    return tuple(word for word in words if _acts(word, knowledge))


def hand_obstacle(words: tuple[str, ...], knowledge: "Knowledge", percept: "Percept") -> str:
    """Why the gripper, as it is, has no use for the actions that are named; or nothing."""
    table = knowledge.action_table()
    actions = {word: concept.number for word, concept in _meant(words, knowledge) if concept.space == ACTION_SPACE}
    if actions:
        starts_held = [table.starts_held[number] for number in actions.values()]
        if all(starts_held) and percept.held is None:
            return f"“{next(iter(actions))}” needs a block in the gripper, and the robot holds nothing"
        if not any(starts_held) and percept.held is not None:
            return f"the gripper holds a block already, which “{next(iter(actions))}” has no use for; put it down first"
    return ""


def absent(words: tuple[str, ...], knowledge: "Knowledge", percept: "Percept") -> tuple[str, ...]:
    """Words for looks that nothing in the scene has, alone or with the word for looks beside them."""
    looks = [(position, concept) for position, word in enumerate(words) if (concept := _look(word, knowledge))]
    for position, concept in looks:
        if not _having(percept, (concept,)):
            return (words[position],)
    for (at, one), (after, other) in zip(looks, looks[1:], strict=False):
        if after == at + 1 and one.space != other.space and not _having(percept, (one, other)):
            return (" ".join(words[at : after + 1]),)
    return ()


def buried(words: tuple[str, ...], knowledge: "Knowledge", percept: "Percept") -> tuple[str, ...]:
    """Words for looks that only blocks have that something else stands on."""
    looks = [(word, concept) for word in words if (concept := _look(word, knowledge))]
    fits = _having(percept, [concept for _, concept in looks]) if looks else []
    if fits and not any(percept.clear[index] for index in fits):
        return tuple(word for word, _ in looks)
    return ()


def _look(word: str, knowledge: "Knowledge") -> Concept | None:
    concept = surely_means(word, knowledge)
    return concept if concept is not None and concept.space in LOOKS else None


def _having(percept: "Percept", looks: Iterable[Concept]) -> list[int]:
    """Indices of the blocks that have all of these looks."""
    return [
        index
        for index in range(len(percept.object_ids))
        if all(percept.properties[concept.space][index] == concept.number for concept in looks)
    ]


def _meant(words: Iterable[str], knowledge: "Knowledge") -> Iterable[tuple[str, Concept]]:
    for word in words:
        for concept, probability in knowledge.language.grounding.meanings(word).items():
            if probability >= SURE:
                yield word, concept
