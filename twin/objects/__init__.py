"""The objects of the scenes, made by parameters.

- `object_model("green_mug")` gives an `ObjectModel` of the catalogues `tabletop` (51 objects for Baxter) and `ordering`
  (32 for the Mico), `board_model("sphere", "black")` a block of the board: its faces, convex parts, mass, inertia,
  friction, and the `Grasp`s by which two fingers can hold it.
- `CATALOGUES` names the objects; `look_of` tells an object's class and colour without building it.

Objects are built with trimesh when they are first asked for.
"""

from .catalogue import CATALOGUES, board_model, look_of, object_model
from .model import Grasp, ObjectModel, Part, VisualMesh
from .tables import COLOURS_RGB

__all__ = [
    "CATALOGUES",
    "COLOURS_RGB",
    "Grasp",
    "ObjectModel",
    "Part",
    "VisualMesh",
    "board_model",
    "look_of",
    "object_model",
]
