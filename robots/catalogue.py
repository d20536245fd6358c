"""Finding robots: by the name of a folder that comes with Showtell, or by path."""

from pathlib import Path
from typing import TYPE_CHECKING

from .errors import RobotError

if TYPE_CHECKING:
    from .model import RobotModel

_HERE = Path(__file__).parent


def list_robots() -> tuple[str, ...]:
    """Names of the robots that come with Showtell, sorted."""
    return tuple(sorted(path.parent.name for path in _HERE.glob("*/robot.toml")))


def load_robot(name_or_path: str | Path, *, finger_mounting: float | None = None) -> "RobotModel":
    """Load a robot.

    Args:
        name_or_path: One of `list_robots()`, or the path of a folder with a `robot.toml` (or of that file).
        finger_mounting: How far outwards on its carriage each sliding finger is mounted [m], as the screws of Baxter's
            grippers allow: every millimetre makes the gap 2 mm wider, closed and open. None takes the file's
            `mounting`.

    Raises:
        RobotError: There is no such robot, its files are wrong, or its fingers cannot be mounted so; names file, key
            and what is allowed.
    """
    from .model import RobotModel  # imports Pinocchio, which the command line's help must not wait for

    if str(name_or_path) in list_robots():
        return RobotModel(_HERE / str(name_or_path), finger_mounting=finger_mounting)
    path = Path(name_or_path)
    folder = path.parent if path.name == "robot.toml" else path
    if not (folder / "robot.toml").is_file():
        raise RobotError(
            f"robot {str(name_or_path)!r} is unknown: use one of {', '.join(list_robots())}, "
            "or the path of a folder that holds a robot.toml"
        )
    return RobotModel(folder, finger_mounting=finger_mounting)
