"""What the thesis publishes on grounding and grammar (tables 6.7, 6.8, 6.9 and 6.11); its data are others."""

from collections.abc import Mapping

COLLECTION = {
    "baxter": "Leeds Robotic Commands",
    "mico_segway": "Extended Object Ordering",
    "three_dof": "Train Robots",
}
GROUNDING: Mapping[str, Mapping[str, tuple[float, float]]] = {
    "three_dof": {
        "colour": (0.92, 0.93),
        "shape": (0.88, 0.94),
        "location": (0.62, 0.80),
        "direction": (0.55, 0.89),
        "action": (0.82, 0.91),
    },
    "baxter": {
        "colour": (0.42, 0.84),
        "shape": (0.51, 0.81),
        "location": (0.34, 0.78),
        "direction": (0.56, 0.82),
        "distance": (0.55, 0.93),
        "action": (0.59, 0.91),
    },
    "mico_segway": {"colour": (0.81, 0.92), "shape": (0.86, 0.95), "action": (0.78, 0.96)},
}
"""Robot to feature space to F1 of the thesis's system and of its supervised HMM (table 6.7)."""
ARABIC: Mapping[str, tuple[float, float]] = {
    "colour": (0.78, 0.89),
    "shape": (0.84, 0.90),
    "location": (0.55, 0.70),
    "direction": (0.54, 0.81),
    "action": (0.80, 0.88),
}
"""The same of Train Robots translated to Arabic (table 6.8)."""
GRAMMAR: Mapping[str, tuple[float, float, float]] = {
    "three_dof": (0.32, 0.66, 0.75),
    "baxter": (0.28, 0.83, 0.88),
    "mico_segway": (0.42, 0.84, 0.90),
}
"""Robot to sub-trees parsed by the unsupervised system, the thesis's and the supervised one (table 6.9)."""
GRAMMAR_ARABIC = (0.31, 0.61, 0.70)
"""The same of Train Robots translated to Arabic (table 6.11)."""
