"""Named sets of feature spaces: which spaces a learner looks at.

A user's own space needs no change of what is here. Write its class, add it to a set under a name of your own, and
register that set before knowledge that uses it is loaded:

    class Texture(FeatureSpace):
        name = "texture"          # reads Observation.features["texture"], (F, N, 2)
        dimension = 2
        of_object = True
        grain, floor, resolution, correlation = 0.01, 0.02, 0.05, 0.3
        kinds = "learned"

    textured = register_space_set(TABLE.extended("textured", Texture))
    spaces = ConceptSpaces(textured)
"""

from dataclasses import dataclass

from learning.concepts.feature_space import FEATURE_SPACES, FeatureSpace
from learning.concepts.table_spaces import (
    Size,
    TableColour,
    TableDirection,
    TableDistance,
    TableLocation,
    TableShape,
    Weight,
)
from learning.errors import KnowledgeError


@dataclass(frozen=True, slots=True)
class SpaceSet:
    """Feature spaces under one name.

    Attributes:
        name: Name, kept with the knowledge.
        spaces: The spaces.
        frames: Frames of a demo whose values are clustered, spread evenly: what rests looks the same in all the others.
    """

    name: str
    spaces: tuple[type[FeatureSpace], ...]
    frames: int = 8

    def __post_init__(self) -> None:
        """Check that names differ.

        Raises:
            KnowledgeError: Two spaces have one name, or a space has the name of something else.
        """
        names = [space.name for space in self.spaces]
        for name in names:
            if names.count(name) > 1 or name in ("action", "reference"):
                raise KnowledgeError(
                    f"space set '{self.name}' cannot have a space '{name}': names must differ from each other and from "
                    "'action' and 'reference'"
                )

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the spaces."""
        return tuple(space.name for space in self.spaces)

    @property
    def properties(self) -> tuple[type[FeatureSpace], ...]:
        """Spaces of what one object is like, its place among them."""
        return tuple(space for space in self.spaces if not space.relation)

    @property
    def relations(self) -> tuple[type[FeatureSpace], ...]:
        """Spaces of how two things stand to each other."""
        return tuple(space for space in self.spaces if space.relation)

    def space(self, name: str) -> type[FeatureSpace]:
        """A space by its name.

        Raises:
            KnowledgeError: There is none; lists the names.
        """
        for space in self.spaces:
            if space.name == name:
                return space
        raise KnowledgeError(f"space set '{self.name}' has no space '{name}'; it has {', '.join(self.names)}")

    def extended(self, name: str, *more: type[FeatureSpace]) -> "SpaceSet":
        """A set under another name with more spaces, or with other spaces in the place of those of the same name."""
        new = {space.name: space for space in (*self.spaces, *more)}
        return SpaceSet(name, tuple(new.values()), self.frames)


BOARD = SpaceSet("board", tuple(FEATURE_SPACES.values()))
"""The fully observed board of the 3-DOF arm."""
TABLE = SpaceSet("table", (TableColour, TableShape, TableLocation, TableDirection, TableDistance), frames=16)
"""A table seen through a camera."""
COUNTER = TABLE.extended("counter", Size, Weight)
"""A table seen through a camera by a hand that feels weight."""

_KNOWN: dict[str, SpaceSet] = {known.name: known for known in (BOARD, TABLE, COUNTER)}


def register_space_set(new: SpaceSet) -> SpaceSet:
    """Make a set known by its name, so that knowledge that was learned with it can be loaded; returns it.

    Raises:
        KnowledgeError: Another set has that name.
    """
    if _KNOWN.setdefault(new.name, new) != new:
        raise KnowledgeError(f"a space set '{new.name}' with other spaces is known already; choose another name")
    return new


def find_space_set(name: str) -> SpaceSet:
    """A known set by its name.

    Raises:
        KnowledgeError: There is none; lists those known.
    """
    if name not in _KNOWN:
        raise KnowledgeError(
            f"space set '{name}' is not known; known are {', '.join(_KNOWN)}; register_space_set makes your own known"
        )
    return _KNOWN[name]
