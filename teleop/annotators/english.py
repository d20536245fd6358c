"""English words and the eight who speak it."""

from .annotator import Annotator
from .facts import Place

_USUAL = (
    "cube", "cylinder", "apple", "pear", "banana", "fork", "spoon", "knife", "bowl", "mug", "marker", "stapler", "tape",
    "cup", "bottle", "can", "jar", "carton", "tub",
)  # fmt: skip
SHAPES: dict[str, str] = {name: name for name in _USUAL}
COLOURS: dict[str, str] = {
    name: name for name in ("red", "blue", "yellow", "purple", "green", "orange", "brown", "gray", "black", "white")
}
RELATIONS: dict[str, str] = {
    "left": "to the left of",
    "right": "to the right of",
    "front": "in front of",
    "behind": "behind",
    "in": "into",
    "on": "on top of",
    "beside": "next to",
}
ANYTHING = "object"


def at_place(place: Place, far: bool, middle: str) -> str:
    """Where a part of the table is, such as `in the top left corner`.

    Args:
        place: The part.
        far: Whether to say far and near for top and bottom.
        middle: The word for the middle.
    """
    row = {"top": "far" if far else "top", "bottom": "near" if far else "bottom", "middle": middle}[place[0]]
    if place == ("middle", "middle"):
        return f"in the {middle} of the table"
    if place[1] == "middle":
        return f"on the {row} side of the table"
    if place[0] == "middle":
        return f"on the {place[1]} side of the table"
    return f"in the {row} {place[1]} corner"


ANNOTATORS: tuple[Annotator, ...] = (
    Annotator(
        "en_1",
        {
            "pick up": ("pick up",), "put down": ("put down", "place"), "move": ("move", "place"),
            "grasp": ("grasp",), "lift": ("lift",), "hold": ("hold",), "lower": ("lower",),
            "drop": ("drop",), "press": ("press",), "push": ("push",),
        },
        orders=("plain",),
        brief=0.05,
    ),
    Annotator(
        "en_2",
        {
            "pick up": ("pick up", "grab"), "put down": ("put",), "move": ("put", "move"),
            "grasp": ("grab", "grasp"), "lift": ("lift", "lift up"), "hold": ("hold",), "lower": ("lower",),
            "drop": ("drop",), "press": ("press",), "push": ("push",),
        },
        nouns={"mug": "cup", "cube": "block"},
        relations={"on": "on", "in": "in", "left": "left of", "right": "right of"},
        orders=("plain", "two steps"),
        brief=0.4,
    ),
    Annotator(
        "en_3",
        {
            "pick up": ("take", "pick up"), "put down": ("place",), "move": ("move", "shift"),
            "grasp": ("grasp",), "lift": ("raise", "lift"), "hold": ("hold",), "lower": ("lower",),
            "drop": ("release", "drop"), "press": ("press",), "push": ("push",),
        },
        colours={"gray": "grey"},
        orders=("plain",),
        polite=("please", 0.6),
        located=0.2,
    ),
    Annotator(
        "en_4",
        {
            "pick up": ("lift", "pick up"), "put down": ("put down", "drop"), "move": ("move",),
            "grasp": ("grasp",), "lift": ("lift",), "hold": ("hold",), "lower": ("lower",),
            "drop": ("drop",), "press": ("press down on", "press"), "push": ("push",),
        },
        relations={"in": "inside", "beside": "near"},
        orders=("plain", "topic"),
        beside=0.3,
    ),
    Annotator(
        "en_5",
        {
            "pick up": ("grab", "pick up"), "put down": ("place", "put"), "move": ("place", "put"),
            "grasp": ("grab",), "lift": ("lift",), "hold": ("hold",), "lower": ("lower",),
            "drop": ("drop",), "press": ("press",), "push": ("push",),
        },
        nouns={"cube": "block", "marker": "pen"},
        colours={"purple": "violet", "gray": "grey"},
        relations={"on": "over"},
        orders=("plain", "destination first"),
        located=0.15,
    ),
    Annotator(
        "en_6",
        {
            "pick up": ("pick up", "raise"), "put down": ("put down", "set down"), "move": ("move", "bring"),
            "grasp": ("grasp",), "lift": ("lift", "raise"), "hold": ("hold",), "lower": ("lower",),
            "drop": ("drop",), "press": ("press",), "push": ("push",),
        },
        orders=("two steps", "plain"),
        brief=0.3,
    ),
    Annotator(
        "en_7",
        {
            "pick up": ("pick up",), "put down": ("place", "put down"), "move": ("move", "put"),
            "grasp": ("grasp",), "lift": ("lift",), "hold": ("hold",), "lower": ("lower",),
            "drop": ("drop",), "press": ("press",), "push": ("push",),
        },
        orders=("plain",),
        polite=("robot", 0.4),
        sized=0.5,
        brief=0.1,
    ),
    Annotator(
        "en_8",
        {
            "pick up": ("take", "grab"), "put down": ("drop", "put"), "move": ("move", "shift"),
            "grasp": ("grasp", "grab"), "lift": ("lift",), "hold": ("hold",), "lower": ("lower",),
            "drop": ("drop",), "press": ("press",), "push": ("push",),
        },
        nouns={"carton": "box"},
        relations={"on": "onto", "left": "on the left of", "right": "on the right of", "beside": "close to"},
        orders=("plain", "topic"),
        beside=0.2,
        wrong=0.07,
    ),
)  # fmt: skip
FAR = frozenset(("en_3", "en_6"))
"""Who says far and near for top and bottom."""
MIDDLE = {"en_2": "middle", "en_4": "middle", "en_6": "middle", "en_8": "middle"}
"""Who says middle for the centre."""
