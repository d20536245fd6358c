"""Commands at a table that should be answered without a motion: ambiguous, impossible, or with an unknown word.

What is true of a scene makes the command; the sentences are those of the people who speak in demos.
"""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from executor.actions.reaching import reaches
from executor.actions.witness import WitnessedWorld
from executor.collections import leeds, ordering
from executor.collections.ordering_plans import ACTIONS as COUNTER_ACTIONS
from executor.collections.table_goals import FLAT, HOLLOW, LEVEL, SMALL
from executor.execution.answer import Answer
from executor.execution.evaluation.case import Suite
from executor.tables.commands import ACTIONS, Heard, TableCommand
from learning.grounding.ngrams import words_of
from teleop.annotators import Destination, OrderingFacts, Place, Relation, TableFacts, Thing, tell_ordering, tell_table
from twin import SceneSpec, World, WorldState
from twin.objects import CATALOGUES, look_of
from twin.scene_spec import ObjectSpec
from twin.tabletop_scene import standing

Made = tuple[SceneSpec, str, int] | None
"""A scene, what is said there, and the id of the thing that it is about."""
Maker = Callable[[np.random.Generator, str], Made]
PEOPLE = 5
"""People who are asked to say it, until one says it as it is meant."""
PLACES: tuple[Place, ...] = (("top", "left"), ("top", "right"), ("bottom", "left"), ("bottom", "right"))
BESIDE: tuple[Relation, ...] = ("left", "right", "front", "behind")
COUNTER_PLACES = ((0.48, 0.10), (0.48, -0.10))
"""Where two things stand on a counter [m],"""
ABOUT = 0.015
"""so near to there."""
SYLLABLES: Mapping[str, Sequence[str]] = {
    "en": ("bla", "dro", "fim", "gle", "kop", "mur", "nad", "pli", "sot", "vez"),
    "ar": ("بلا", "درو", "فيم", "جلي", "كوب", "مور", "ناد", "سوت", "فيز", "زخر"),
}
"""Of words that nobody says."""
SMALL_WORDS = frozenset(
    ("the", "of", "to", "in", "on", "and", "it", "please", "robot", "then", "up", "down", "side", "table", "top")
) | frozenset(("في", "على", "من", "إلى", "الى", "ثم", "فوق", "جانب", "الطاولة", "فضلك"))
"""Words without which a sentence says the same; one that nobody says may stand in their place unnoticed."""


def suite_command(
    robot: str, suite: Suite, number: int, rng: np.random.Generator, language: str, known: Heard
) -> TableCommand:
    """A command of a suite; its kinds follow each other.

    Args:
        robot: `baxter` or `mico_segway`.
        suite: Which suite.
        number: Number of the command in it.
        rng: Where chance comes from.
        language: Language of the sentence.
        known: Words of sentences that were heard before.
    """
    makers = MAKERS[robot][suite]
    kind = list(makers)[number % len(makers)]
    while True:
        made = makers[kind](rng, language)
        if made is not None:
            break
    scene, sentence, target = made
    if suite == "unknown-word":
        sentence = _with_strange_word(sentence, rng, language, known)
    thing = next((str(each.model) for each in scene.objects if each.id == target), "")
    expected = Answer(suite)
    return TableCommand(scene, sentence, kind, target, thing, answered_unmoved, expected)


def answered_unmoved(world: WitnessedWorld, before: WorldState) -> str:
    """What is wrong with a world in which nothing should have moved."""
    after = world.state()
    turned = float(np.abs(after.q - before.q).max())
    if after.time > before.time or turned > 0.0:
        return f"the arm moved: {after.time - before.time:.1f} s, up to {turned:.4f} rad"
    return ""


# Tabletops


def _tabletop(rng: np.random.Generator) -> tuple[SceneSpec, ObjectSpec]:
    """A scene, and one of its things."""
    name = str(rng.choice(leeds.OBJECTS))
    scene = leeds.scene_with(rng, name, int(rng.integers(2**31)))
    return scene, next(each for each in scene.objects if each.model == name)


def _changed(scene: SceneSpec, rng: np.random.Generator, number: int, model: str) -> SceneSpec | None:
    """The scene with another thing where one stood; None where it has no room."""
    old = next(each for each in scene.objects if each.id == number)
    x, y, _ = old.position
    new = standing(rng, number, model, (x, x), (y, y))
    try:
        objects = tuple(new if each.id == number else each for each in scene.objects)
        return SceneSpec.model_validate(scene.model_copy(update={"objects": objects}).model_dump())
    except ValueError:
        return None


def _said(
    scene: SceneSpec, target: Thing, goal: Destination | None, how: str, rng: np.random.Generator, language: str
) -> str | None:
    """What somebody says who names a thing by its colour and shape, or by its shape alone."""
    things = tuple(_thing(each) for each in scene.objects)
    seen = (*(each for each in things if each.id != target.id), target) if how == "colour and shape" else (target,)
    action = ACTIONS[0] if goal is None else ACTIONS[1]
    if goal is not None and goal.reference is not None and how == "shape":
        seen = (target, next(each for each in things if each.id == goal.reference))
    told = tell_table(TableFacts(action, target, seen, goal), PEOPLE, language, rng)
    right = (each for each in told if not each.mistakes and each.template.endswith(f", {how}"))
    return next((each.text for each in right), None)


def _thing(spec: ObjectSpec) -> Thing:
    return Thing(spec.id, spec.shape, spec.colour, spec.position[0], spec.position[1])


def _corner(rng: np.random.Generator) -> Destination:
    return Destination(place=PLACES[int(rng.integers(len(PLACES)))])


def _two_alike(rng: np.random.Generator, language: str) -> Made:
    """Two of the same kind and colour."""
    scene, target = _tabletop(rng)
    other = _one_of([each for each in scene.objects if each.id != target.id], rng)
    changed = _changed(scene, rng, other.id, str(target.model))
    if changed is None:
        return None
    goal = _corner(rng) if rng.random() < 0.5 else None
    text = _said(changed, _thing(target), goal, "colour and shape", rng, language)
    return None if text is None else (changed, text, target.id)


def _two_of_a_shape(rng: np.random.Generator, language: str) -> Made:
    """Two of the same kind, told by their kind alone."""
    scene, target = _tabletop(rng)
    alike = [name for name in leeds.OBJECTS if look_of(name)[0] == target.shape and name != target.model]
    other = _one_of([each for each in scene.objects if each.id != target.id], rng)
    changed = _changed(scene, rng, other.id, str(rng.choice(alike)))
    if changed is None or sum(each.shape == target.shape for each in changed.objects) != 2:
        return None
    text = _said(changed, _thing(target), None, "shape", rng, language)
    return None if text is None else (changed, text, target.id)


def _two_grounds(rng: np.random.Generator, language: str) -> Made:
    """Two things of the same kind and colour where something shall go."""
    scene, ground = _tabletop(rng)
    first, second = _two([each for each in scene.objects if each.id != ground.id], rng)
    changed = _changed(scene, rng, second.id, str(ground.model))
    if changed is None or any(
        (each.shape, each.colour) == (first.shape, first.colour) for each in changed.objects if each.id != first.id
    ):
        return None
    goal = Destination(relation=_relation(first, ground, rng), reference=ground.id)
    text = _said(changed, _thing(first), goal, "colour and shape", rng, language)
    return None if text is None else (changed, text, first.id)


def _not_there(rng: np.random.Generator, language: str) -> Made:
    """Nothing of that kind."""
    scene, _ = _tabletop(rng)
    absent = [name for name in leeds.OBJECTS if all(look_of(name)[0] != each.shape for each in scene.objects)]
    return _absent(scene, str(rng.choice(absent)), rng, language)


def _of_another_colour(rng: np.random.Generator, language: str) -> Made:
    """Something of that kind, in another colour only."""
    scene, target = _tabletop(rng)
    shapes = [name for name in leeds.OBJECTS if look_of(name)[0] == target.shape]
    absent = [name for name in shapes if all(each.model != name for each in scene.objects)]
    return _absent(scene, str(rng.choice(absent)), rng, language) if absent else None


def _no_such_ground(rng: np.random.Generator, language: str) -> Made:
    """It shall go to a thing of which there is none of that kind."""
    scene, target = _tabletop(rng)
    absent = [name for name in leeds.OBJECTS if all(look_of(name)[0] != each.shape for each in scene.objects)]
    ground = Thing.of_model(len(scene.objects), str(rng.choice(absent)), 0.65, 0.0)
    spec = ObjectSpec.of_model(ground.id, str(rng.choice(absent)), (0.65, 0.0, 0.1), 0.0)
    ground = _thing(spec)
    goal = Destination(relation=_relation(target, spec, rng), reference=ground.id)
    things = (*(_thing(each) for each in scene.objects), ground)
    told = tell_table(TableFacts(ACTIONS[1], _thing(target), things, goal), PEOPLE, language, rng)
    right = (each for each in told if not each.mistakes and each.template.endswith(", colour and shape"))
    text = next((each.text for each in right), None)
    return None if text is None else (scene, text, target.id)


def _beyond_reach(rng: np.random.Generator, language: str) -> Made:
    """At the far edge of the table, where no posture of an arm brings its hand around it."""
    scene, target = _tabletop(rng)
    x, y = FAR_CORNERS[int(rng.integers(len(FAR_CORNERS)))]
    far = standing(rng, target.id, str(target.model), (x - ABOUT, x + ABOUT), (y - ABOUT, y + ABOUT))
    objects = tuple(far if each.id == target.id else each for each in scene.objects)
    changed = scene.model_copy(update={"objects": objects})
    with World(changed) as world:
        if any(reaches(world, arm, far.id) for arm in world.robot.arms):
            return None
    text = _said(changed, _thing(far), None, "colour and shape", rng, language)
    return None if text is None else (changed, text, target.id)


FAR_CORNERS = ((1.02, 0.56), (1.02, -0.56))
"""Hardly within the reach of Baxter's hands, and in sight of its camera [m]."""


def _absent(scene: SceneSpec, model: str, rng: np.random.Generator, language: str) -> Made:
    """Something is said about a thing that is not there."""
    ghost = Thing.of_model(len(scene.objects), model, 0.65, 0.0)
    goal = _corner(rng) if rng.random() < 0.5 else None
    text = _said(scene, ghost, goal, "colour and shape", rng, language)
    return None if text is None else (scene, text, ghost.id)


def _relation(moved: ObjectSpec, ground: ObjectSpec, rng: np.random.Generator) -> Relation:
    """A relation in which one thing can be to another."""
    fitting: list[Relation] = list(BESIDE)
    if ground.shape in HOLLOW and moved.shape in SMALL:
        fitting = ["in"]
    elif ground.shape in LEVEL and moved.shape in FLAT:
        fitting = ["on"]
    return fitting[int(rng.integers(len(fitting)))]


def _any_at_tabletop(rng: np.random.Generator, language: str) -> Made:
    """A command that could be carried out."""
    scene, target = _tabletop(rng)
    goal = _corner(rng) if rng.random() < 0.5 else None
    text = _said(scene, _thing(target), goal, "colour and shape", rng, language)
    return None if text is None else (scene, text, target.id)


# Counters


def _counter(names: Sequence[str], rng: np.random.Generator) -> SceneSpec:
    """One or two things on a counter, and the hand somewhere before them."""
    scene = ordering.scene_with(rng, names[0], int(rng.integers(2**31)))
    if len(names) == 1:
        return scene
    objects = [
        standing(rng, number, name, (x - ABOUT, x + ABOUT), (y - ABOUT, y + ABOUT))
        for number, (name, (x, y)) in enumerate(zip(names, COUNTER_PLACES, strict=True))
    ]
    return scene.model_copy(update={"objects": tuple(objects)})


def _told_at_counter(model: str, rng: np.random.Generator, language: str) -> str | None:
    action = COUNTER_ACTIONS[int(rng.integers(len(COUNTER_ACTIONS)))]
    told = tell_ordering(OrderingFacts.of_model(action, model), language, rng)
    return None if told.mistakes else told.text


def _two_alike_at_counter(rng: np.random.Generator, language: str) -> Made:
    """Two of the same model."""
    name = str(rng.choice(ordering.OBJECTS))
    text = _told_at_counter(name, rng, language)
    return None if text is None else (_counter((name, name), rng), text, 0)


def _not_on_counter(rng: np.random.Generator, language: str) -> Made:
    """Of another kind and another colour than what is there."""
    here = [str(each) for each in rng.permutation(CATALOGUES["ordering"])[: int(rng.integers(1, 3))]]
    looks = [look_of(each) for each in here]
    absent = [
        name
        for name in ordering.OBJECTS
        if all(look_of(name)[0] != shape and look_of(name)[1] != colour for shape, colour in looks)
    ]
    text = _told_at_counter(str(rng.choice(absent)), rng, language)
    return None if text is None else (_counter(here, rng), text, -1)


def _of_another_colour_on_counter(rng: np.random.Generator, language: str) -> Made:
    """Of the same kind as what is there, in another colour."""
    here = str(rng.choice(ordering.OBJECTS))
    shape, colour = look_of(here)
    absent = [name for name in ordering.OBJECTS if look_of(name)[0] == shape and look_of(name)[1] != colour]
    text = _told_at_counter(str(rng.choice(absent)), rng, language)
    return None if text is None else (_counter((here,), rng), text, -1)


def _any_at_counter(rng: np.random.Generator, language: str) -> Made:
    """A command that could be carried out."""
    name = str(rng.choice(ordering.OBJECTS))
    text = _told_at_counter(name, rng, language)
    return None if text is None else (_counter((name,), rng), text, 0)


MAKERS: Mapping[str, Mapping[Suite, Mapping[str, Maker]]] = {
    "baxter": {
        "ambiguous": {"two alike": _two_alike, "two of a shape": _two_of_a_shape, "two grounds": _two_grounds},
        "impossible": {
            "not there": _not_there,
            "of another colour": _of_another_colour,
            "no such ground": _no_such_ground,
            "beyond reach": _beyond_reach,
        },
        "unknown-word": {"strange word": _any_at_tabletop},
    },
    "mico_segway": {
        "ambiguous": {"two alike": _two_alike_at_counter},
        "impossible": {"not there": _not_on_counter, "of another colour": _of_another_colour_on_counter},
        "unknown-word": {"strange word": _any_at_counter},
    },
}
"""Robot and suite to the kinds of commands."""


# Words


def _with_strange_word(sentence: str, rng: np.random.Generator, language: str, known: Heard) -> str:
    """The sentence with a word that nobody says in place of one that tells something."""
    words = sentence.split()
    telling = [at for at, word in enumerate(words) if not set(words_of(word)) & SMALL_WORDS]
    heard = {word for each in known for word in each} | set(words)
    strange = ""
    while not strange or strange in heard:
        strange = "".join(rng.choice(SYLLABLES[language], size=int(rng.integers(2, 4))))
    words[telling[int(rng.integers(len(telling)))]] = strange
    return " ".join(words)


def _one_of(things: Sequence[ObjectSpec], rng: np.random.Generator) -> ObjectSpec:
    return things[int(rng.integers(len(things)))]


def _two(things: Sequence[ObjectSpec], rng: np.random.Generator) -> tuple[ObjectSpec, ObjectSpec]:
    one, other = rng.permutation(len(things))[:2].tolist()
    return things[one], things[other]
