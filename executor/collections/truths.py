"""What is true of a scene's objects, for the sidecar that only evaluation opens."""

from typing import Any

from twin.scene_spec import SceneSpec


def objects_of(scene: SceneSpec) -> dict[str, dict[str, Any]]:
    """Name, classes and initial position [m] of all objects by their id in the scene."""
    return {
        str(each.id): {
            "name": each.model,
            "shape": each.shape,
            "colour": each.colour,
            "position": list(each.position),
            "yaw": each.yaw,
        }
        for each in scene.objects
    }
