"""From an observation to the learner's symbols: predicates of the scene, and the action that was shown."""

import numpy as np
from numpy.typing import NDArray

from learning.concepts.concept_spaces import ConceptSpaces
from learning.concepts.feature_space import FEATURE_SPACES, NEAR, PROPERTIES, RELATIONS
from learning.graphs.action_states import shown_action, touches
from learning.percept import NO_CONCEPT, Percept, ShownAction
from learning.perception.observation import Observation
from learning.perception.placements import clear_objects, column_of, landing_places
from learning.perception.tracks import anchors, at_start
from robots.pose import FloatArray

KNOWN_PLACE = 5.0
"""A placement further than this Mahalanobis distance from every location concept is at no known place."""


def perceive(
    observation: Observation, spaces: ConceptSpaces, *, learn_action: bool = True
) -> tuple[Percept, ShownAction]:
    """Perceive a demo: the scene before the action, and the action.

    Args:
        observation: The demo's tracks.
        spaces: Concepts, already updated with this demo. An action graphlet that matches none is added to
            `spaces.actions` (thesis 3.4.2), the only thing that is changed.
        learn_action: False leaves `spaces` as it is; an unknown action then has the number `NO_CONCEPT`.

    Raises:
        PerceptionError: Nothing was moved.
    """
    graphlet, measures, moved = shown_action(observation, spaces)
    if learn_action:
        action = spaces.actions.match_or_add(graphlet, measures)
    else:
        found = spaces.actions.find(graphlet, measures)
        action = NO_CONCEPT if found is None else found
    percept = percept_of(observation, spaces)
    _, last = anchors(observation)
    return percept, ShownAction(
        action=action,
        parts=spaces.actions.parts_of(graphlet),
        moved=moved,
        placement=None if graphlet.states[-1].holds else column_of(last[moved]),
        final_location=last[moved],
    )


def percept_of(observation: Observation, spaces: ConceptSpaces) -> Percept:
    """Predicates of the scene as it is before anything moves (thesis 3.3.4, visual world encoding).

    Measurements are averaged over the frames in which an object has not yet moved, its looks over all frames.

    Args:
        observation: Tracks of a demo, or of a world that stands still.
        spaces: Concepts learned so far.
    """
    still = at_start(observation)[:, :, None]
    location = np.sum(observation.location * still, axis=0) / np.sum(still, axis=0)
    # Averaged as embedded values: the mean of two reds on either side of the hue's wrap is red.
    looks = {
        name: FEATURE_SPACES[name].embed(values).mean(axis=0)
        for name, values in (("colour", observation.colour), ("shape", observation.shape))
    }
    looks["location"] = FEATURE_SPACES["location"].embed(location)
    held = _held(observation, spaces)
    places, support = landing_places(location, held)
    place, off = spaces.mixtures["location"].classify_with_distance(FEATURE_SPACES["location"].embed(places))
    return Percept(
        object_ids=observation.object_ids,
        location=location,
        properties={name: spaces.mixtures[name].classify(looks[name]) for name in PROPERTIES},
        relations=_relations(location, location, spaces, itself=True),
        placements=places,
        placement_properties={"location": np.where(off < KNOWN_PLACE, place, NO_CONCEPT)},
        placement_relations=_relations(places, location, spaces, itself=False),
        support=support,
        clear=clear_objects(location, held),
        held=held,
    )


def _relations(
    things: FloatArray, seen_from: FloatArray, spaces: ConceptSpaces, *, itself: bool
) -> dict[str, NDArray[np.int64]]:
    """Direction and distance concepts of near pairs, each (n, N); [i, j] is thing i as seen from object j."""
    offset = things[:, None] - seen_from[None]
    near = np.linalg.norm(offset, axis=2) < NEAR
    if itself:
        np.fill_diagonal(near, False)
    relations = {}
    for name in RELATIONS:
        numbers = np.full(near.shape, NO_CONCEPT, dtype=np.int64)
        if np.any(near) and spaces.mixtures[name].components:
            numbers[near] = spaces.predicates(name, offset[near])
        relations[name] = numbers
    return relations


def _held(observation: Observation, spaces: ConceptSpaces) -> int | None:
    """Index of the object that the closed gripper is at in the first frame, or None."""
    if not observation.gripper_closed[0] or len(observation.object_ids) == 0:
        return None
    offset = np.linalg.norm(observation.location[0] - observation.gripper_location[0], axis=1)
    nearest = int(np.argmin(offset))
    return nearest if touches(observation, spaces)[0, nearest] else None
