"""What an object is: how it looks, the convex parts of its body, its mass, its friction and where it can be held.

The object frame has its origin at the centre of the object's bounding box, z up in the pose in which it rests.
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray, Pose, read_only

Rgb = tuple[float, float, float]
IntArray = NDArray[np.int64]
PartKind = Literal["box", "sphere", "cylinder", "hull"]


@dataclass(frozen=True, slots=True, eq=False)
class Grasp:
    """One way of holding an object with two fingers, in the object frame.

    Attributes:
        centre: Midpoint between the two finger pads, (3,) [m].
        closing: Direction in which the fingers close, (3,) unit; its sign means nothing.
        approach: Direction in which the hand comes, (3,) unit, at a right angle to `closing`; from above it is -z.
        width: Distance between the two surfaces that the pads touch [m].
    """

    centre: FloatArray
    closing: FloatArray
    approach: FloatArray
    width: float

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        for name in ("centre", "closing", "approach"):
            object.__setattr__(self, name, read_only(getattr(self, name)))

    def placed(self, by: FloatArray, scale: float) -> "Grasp":
        """The same grasp of a thing that is moved by (3,) [m], then made larger about the origin."""
        return replace(self, centre=(self.centre + by) * scale, width=self.width * scale)

    @property
    def pads(self) -> FloatArray:
        """Points in the middle of the two touched surfaces, (2, 3) [m]."""
        half: FloatArray = self.closing * (self.width / 2)
        return np.array([self.centre - half, self.centre + half])


@dataclass(frozen=True, slots=True, eq=False)
class VisualMesh:
    """Faces of one colour, lit flat.

    Attributes:
        vertices: (n, 3) [m] in the object frame.
        faces: Vertex numbers, (m, 3), anticlockwise seen from outside.
        rgb: Surface colour, red green blue in 0..1.
    """

    vertices: FloatArray
    faces: IntArray
    rgb: Rgb

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        faces = np.array(self.faces, dtype=np.int64)
        faces.setflags(write=False)
        object.__setattr__(self, "vertices", read_only(self.vertices))
        object.__setattr__(self, "faces", faces)


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """One convex part of a body.

    Attributes:
        kind: A box, sphere or cylinder (around its z axis) is a true one to contact; a hull is that of its vertices.
        size: Half extents in the part's own frame, (3,) [m]; radius thrice for a sphere, radius twice and half of the
            length for a cylinder.
        pose: The part's frame, in its middle, in the object frame.
        vertices: Corners in the object frame, (n, 3) [m]; those of a round part stand just around it.
    """

    kind: PartKind
    size: FloatArray
    pose: Pose
    vertices: FloatArray

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        object.__setattr__(self, "size", read_only(self.size))
        object.__setattr__(self, "vertices", read_only(self.vertices))

    def placed(self, by: FloatArray, scale: float) -> "Part":
        """The same part, moved by (3,) [m], then made larger about the origin."""
        pose = Pose((self.pose.position + by) * scale, self.pose.orientation_xyzw)
        return replace(self, size=self.size * scale, pose=pose, vertices=(self.vertices + by) * scale)


@dataclass(frozen=True, slots=True, eq=False)
class ObjectModel:
    """An object, before it stands in a scene.

    Attributes:
        name: Its name in the catalogue, such as `green_mug`.
        shape: Its shape class, such as `mug`.
        colour: Its colour's name.
        rgb: That colour.
        visuals: What is drawn.
        parts: What is touched; several parts where the body is not convex.
        mass: [kg].
        centre_of_mass: In the object frame, (3,) [m].
        inertia: About the centre of mass, in the axes of the object frame, (3, 3) [kg m^2].
        lateral_friction: Coefficient of sliding friction.
        spinning_friction: Torque per normal force against turning on the spot [m].
        rolling_friction: Torque per normal force against rolling [m].
        half_extents: Half of the bounding box, (3,) [m]; a resting object's origin is `half_extents[2]` above what
            it stands on.
        grasps: Where it can be held, the steadiest first.
    """

    name: str
    shape: str
    colour: str
    rgb: Rgb
    visuals: tuple[VisualMesh, ...]
    parts: tuple[Part, ...]
    mass: float
    centre_of_mass: FloatArray
    inertia: FloatArray
    lateral_friction: float
    spinning_friction: float
    rolling_friction: float
    half_extents: FloatArray
    grasps: tuple[Grasp, ...]

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        for name in ("centre_of_mass", "inertia", "half_extents"):
            object.__setattr__(self, name, read_only(getattr(self, name)))
