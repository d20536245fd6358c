"""What is known of an object at one frame."""

from dataclasses import dataclass

from learning.perception.segments import Piece
from learning.perception.table import TableView
from robots.pose import FloatArray


@dataclass(frozen=True, slots=True)
class Sighting:
    """What is known of an object at one frame.

    Attributes:
        id: Its number.
        centre: Where its middle is believed to be, (3,) [m].
        extent: Length, width, height as last seen whole, (3,) [m].
        visible: Whether it was seen in this frame.
        held: Whether it is believed to be in the hand.
        colour: Red, green, blue of 255, (3,); None where too little of it was seen.
        exposure: Part of it that nothing hides, 0 .. 1.
        piece: Its pixels, where any were seen.
        whole: Whether they are all that can be seen of it from there.
        view: The table from where the camera was.
        yaw: Direction of its length in the world, 0 .. π [rad].
    """

    id: int
    centre: FloatArray
    extent: FloatArray
    visible: bool
    held: bool
    colour: FloatArray | None
    exposure: float
    piece: Piece | None
    whole: bool
    view: TableView | None
    yaw: float = 0.0
