"""State graphs: a demo as a sequence of constant qualitative states of the whole scene (thesis 3.3.4, figure 3.10)."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from learning.concepts.concept_spaces import ConceptSpaces
from learning.concepts.feature_space import FEATURE_SPACES, NEAR
from learning.graphs.action_graphlet import ActionGraphlet
from learning.graphs.action_states import SHORTEST_STATE, action_of
from learning.graphs.camera_predicates import CameraPredicates
from learning.graphs.camera_states import Segmentation, segmented
from learning.graphs.graphlets import ConceptNumber, Graphlet, graphlets_of
from learning.graphs.smoothing import constant_runs, lasting, smoothed
from learning.percept import NO_CONCEPT
from learning.perception.observation import Observation
from learning.perception.tracks import MOVED, anchors, moved_object
from robots.pose import FloatArray

if TYPE_CHECKING:
    import networkx as nx

GRIPPER = -1
"""The gripper's index among the objects of a state."""
Pair = tuple[int, int]


@dataclass(frozen=True, slots=True)
class QualitativeState:
    """A constant qualitative configuration of the scene.

    Attributes:
        first_frame: Frame of the observation with which it begins.
        gripper_closed: The gripper's state node.
        objects: Object layer: the concepts of each object by index; the gripper (`GRIPPER`) has a location alone.
        relations: Relation layer: the concepts of each related pair (i, j), where i is as seen from j.
    """

    first_frame: int
    gripper_closed: bool
    objects: dict[int, tuple[ConceptNumber, ...]]
    relations: dict[Pair, tuple[ConceptNumber, ...]]


@dataclass(frozen=True, slots=True)
class StateGraph:
    """The extended spatio-temporal graph of one demo.

    Attributes:
        states: Each differs from the one before.
        action: Its action graphlet.
    """

    states: tuple[QualitativeState, ...]
    action: ActionGraphlet

    @classmethod
    def of(cls, observation: Observation, spaces: ConceptSpaces) -> "StateGraph":
        """Encode a demo. What rests is looked at over all frames at once; what moves, frame by frame.

        Raises:
            PerceptionError: Nothing was moved.
        """
        if observation.extent is not None:
            return cls._of_camera(segmented(observation, spaces), spaces)
        action = action_of(observation, spaces)
        moved = moved_object(observation)
        predicates = _Predicates(observation, spaces, moved)
        return cls(tuple(predicates.state(start) for start, _ in constant_runs(predicates.rows())), action)

    @classmethod
    def _of_camera(cls, segmentation: Segmentation, spaces: ConceptSpaces) -> "StateGraph":
        """Encode a demo that a camera saw, with any number of objects, some of them hidden now and then."""
        predicates = CameraPredicates(segmentation, spaces)
        states = []
        for start, _ in constant_runs(predicates.rows()):
            objects = predicates.objects(start)
            objects[GRIPPER] = (("location", int(predicates.location[start, predicates.number])),)
            relations = {
                (GRIPPER if i == predicates.number else i, j): concepts
                for (i, j), concepts in predicates.pairs(start).items()
            }
            states.append(QualitativeState(start, bool(predicates.closed[start]), objects, relations))
        return cls(tuple(states), segmentation.graphlet)

    def object_graphlets(self) -> frozenset[Graphlet]:
        """All object graphlets of all states: every combination of an object's properties (figure 3.12)."""
        layers = (concepts for state in self.states for concepts in state.objects.values())
        return frozenset().union(*(graphlets_of("object", concepts) for concepts in set(layers)))

    def relation_graphlets(self) -> frozenset[Graphlet]:
        """All relation graphlets of all states: every combination of a pair's relations (figure 3.13)."""
        layers = (concepts for state in self.states for concepts in state.relations.values())
        return frozenset().union(*(graphlets_of("relation", concepts) for concepts in set(layers)))

    def to_networkx(self) -> "nx.DiGraph[str]":
        """The graph as a DAG: states in sequence, each with its object layer and its relation layer."""
        import networkx as nx

        graph: nx.DiGraph[str] = nx.DiGraph()
        for index, state in enumerate(self.states):
            name = f"s{index}"
            graph.add_node(name, label="state")
            if index:
                graph.add_edge(f"s{index - 1}", name)
            for thing, concepts in state.objects.items():
                node = _add_node(graph, name, _object_name(thing), "gripper" if thing == GRIPPER else "object")
                graph.add_edge(name, node)
                _add_concepts(graph, node, concepts)
                if thing == GRIPPER:
                    grip = _add_node(graph, node, "grip", "closed" if state.gripper_closed else "open")
                    graph.add_edge(node, grip)
            for (first, second), concepts in state.relations.items():
                node = _add_node(graph, name, f"R{_object_name(first)},{_object_name(second)}", "relation")
                for thing in (first, second):
                    graph.add_edge(f"{name}.{_object_name(thing)}", node)
                _add_concepts(graph, node, concepts)
        return graph


class _Predicates:
    """Concept numbers of every object and pair in every frame of a demo."""

    def __init__(self, observation: Observation, spaces: ConceptSpaces, moved: int) -> None:
        self.number = len(observation.object_ids)
        self.closed = lasting(observation.gripper_closed, SHORTEST_STATE)
        frames = len(observation.times)
        first, last = anchors(observation)
        track = observation.location.copy()
        still = np.linalg.norm(last - first, axis=1) <= MOVED
        still[moved] = False
        track[:, still] = observation.location[:, still].mean(axis=0)  # what rests is averaged over all frames
        track[:, ~still] = smoothed(observation.location[:, ~still])
        gripper = smoothed(observation.gripper_location)
        everything = np.concatenate([track, gripper[:, None]], axis=1)  # the gripper comes last
        self.location = _lasting_columns(spaces.predicates("location", everything))
        self.looks = {
            name: spaces.mixtures[name].classify(FEATURE_SPACES[name].embed(values).mean(axis=0))
            for name, values in (("colour", observation.colour), ("shape", observation.shape))
        }
        self.direction = np.full((frames, self.number + 1, self.number), NO_CONCEPT, dtype=np.int64)
        self.distance = self.direction.copy()
        offset = everything[:, :, None] - track[:, None]
        self._relate(offset, moved, still, spaces)

    def _relate(self, offset: FloatArray, moved: int, still: NDArray[np.bool_], spaces: ConceptSpaces) -> None:
        """Fill in the relations of near pairs, and the distance of the gripper from what it manipulates."""
        near = np.linalg.norm(offset, axis=3) < NEAR
        near[:, np.arange(self.number), np.arange(self.number)] = False
        near[:, self.number] = False
        near[:, self.number, moved] = True
        resting = np.append(still, False)
        constant = resting[:, None] & still[None, :]
        for numbers, name in ((self.direction, "direction"), (self.distance, "distance")):
            # Pairs at rest are the same in all frames: classify them once.
            once = np.where(near[0], 1, 0).astype(bool) & constant
            if np.any(once):
                numbers[:, once] = spaces.predicates(name, offset[0][once])
            varying = near & ~constant
            if np.any(varying):
                numbers[varying] = spaces.predicates(name, offset[varying])
        self.direction, self.distance = _lasting_columns(self.direction), _lasting_columns(self.distance)

    def rows(self) -> NDArray[np.int64]:
        """One row a frame with all that may change, (F, m)."""
        frames = len(self.closed)
        parts = (self.closed, self.location, self.direction, self.distance)
        return np.concatenate([np.asarray(part, dtype=np.int64).reshape(frames, -1) for part in parts], axis=1)

    def state(self, frame: int) -> QualitativeState:
        """The qualitative state that holds in a frame."""
        objects: dict[int, tuple[ConceptNumber, ...]] = {
            index: (
                *((name, int(numbers[index])) for name, numbers in self.looks.items()),
                ("location", int(self.location[frame, index])),
            )
            for index in range(self.number)
        }
        objects[GRIPPER] = (("location", int(self.location[frame, self.number])),)
        relations: dict[Pair, tuple[ConceptNumber, ...]] = {}
        for i, j in np.argwhere(self.distance[frame] != NO_CONCEPT):
            pair = (GRIPPER if i == self.number else int(i), int(j))
            relations[pair] = (
                ("direction", int(self.direction[frame, i, j])),
                ("distance", int(self.distance[frame, i, j])),
            )
        return QualitativeState(frame, bool(self.closed[frame]), objects, relations)


def _lasting_columns(numbers: NDArray[np.int64]) -> NDArray[np.int64]:
    """`lasting` for every column of (F, ...) that changes at all."""
    flat = numbers.reshape(len(numbers), -1).copy()
    for column in np.flatnonzero(np.any(flat != flat[0], axis=0)):
        flat[:, column] = lasting(flat[:, column], SHORTEST_STATE)
    return flat.reshape(numbers.shape)


def _object_name(index: int) -> str:
    return "g" if index == GRIPPER else f"o{index}"


def _add_node(graph: "nx.DiGraph[str]", parent: str, name: str, label: str) -> str:
    """Add the node `parent.name` and return its name."""
    node = f"{parent}.{name}"
    graph.add_node(node, label=label)
    return node


def _add_concepts(graph: "nx.DiGraph[str]", parent: str, concepts: tuple[ConceptNumber, ...]) -> None:
    """Hang a feature node for each concept on a node."""
    for space, number in concepts:
        graph.add_edge(parent, _add_node(graph, parent, space, f"{space}_{number}"))
