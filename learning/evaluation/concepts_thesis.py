"""The thesis's figures of tables 6.1 to 6.5, by robot, on its own data."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ThesisRow:
    """One column of tables 6.3 to 6.5.

    Attributes:
        v_measure: The thesis's own V-measure.
        svm: Its SVM's.
        concepts: Concepts that it found (text of 6.3.1).
        classes: True concepts (table 6.2).
    """

    v_measure: float
    svm: float
    concepts: int
    classes: int


@dataclass(frozen=True, slots=True)
class ThesisTable:
    """What the thesis has of one collection.

    Attributes:
        table: Number of its table.
        collection: Name of its collection.
        clips: Video clips (table 6.1).
        frames: Frames.
        commands: Sentences.
        words: Unique words.
        objects: Mean number of objects in a clip.
        rows: Feature space to its figures.
    """

    table: str
    collection: str
    clips: int
    frames: int
    commands: int
    words: int
    objects: float
    rows: dict[str, ThesisRow]


THESIS = {
    "three_dof": ThesisTable(
        "6.3",
        "Extended Train-Robots",
        1000,
        30_000,
        4850,
        277,
        24.8,
        {
            "colour": ThesisRow(0.69, 0.77, 9, 9),
            "shape": ThesisRow(0.70, 0.79, 5, 4),
            "location": ThesisRow(0.51, 0.57, 8, 4),
            "direction": ThesisRow(0.57, 0.91, 13, 5),
            "action": ThesisRow(0.69, 0.89, 5, 3),
        },
    ),
    "baxter": ThesisTable(
        "6.4",
        "Leeds Robotic Commands",
        204,
        17_373,
        1024,
        87,
        5.3,
        {
            "colour": ThesisRow(0.62, 0.82, 16, 10),
            "shape": ThesisRow(0.57, 0.62, 25, 13),
            "location": ThesisRow(0.83, 0.96, 6, 6),
            "distance": ThesisRow(0.88, 0.89, 4, 6),
            "direction": ThesisRow(0.93, 0.90, 6, 5),
            "action": ThesisRow(0.65, 0.71, 7, 3),
        },
    ),
    "mico_segway": ThesisTable(
        "6.5",
        "Extended Object Ordering",
        1120,
        145_573,
        1120,
        31,
        1.0,
        {
            "colour": ThesisRow(0.67, 0.88, 7, 7),
            "shape": ThesisRow(0.44, 0.47, 10, 6),
            "action": ThesisRow(0.96, 0.93, 7, 7),
        },
    ),
}
"""By robot of the twin's collection that stands for it."""
