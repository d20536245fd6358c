"""The supervised baseline of tables 6.3 to 6.5: a linear support vector machine that sees the true classes."""

import warnings

import numpy as np
from numpy.typing import NDArray

from learning.concepts.demo_concepts import threadpools
from robots.pose import FloatArray

FOLDS = 4
COSTS = (0.1, 1.0, 10.0)
"""The C with the best V-measure is taken, to the baseline's advantage."""
SETTINGS = (
    f"StandardScaler and LinearSVC with the best C of {COSTS}, {FOLDS} folds, no demo (or group of demos that share a "
    "layout) in two folds"
)


def svm_predictions(
    values: FloatArray, classes: NDArray[np.str_], groups: NDArray[np.int64], seed: int = 0
) -> list[NDArray[np.str_]] | None:
    """Predicted class of each instance by a machine that has not seen its group, for every C, (n,) each.

    Args:
        values: (n, d).
        classes: True classes, (n,).
        groups: What must not be split between learning and asking, (n,).
        seed: Deals the groups out to folds.

    Returns:
        None where there are fewer groups than folds, or a single class.
    """
    from sklearn.exceptions import ConvergenceWarning
    from sklearn.model_selection import GroupKFold
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler
    from sklearn.svm import LinearSVC

    if len(np.unique(groups)) < FOLDS or len(np.unique(classes)) < 2:
        return None
    splits = list(GroupKFold(FOLDS, shuffle=True, random_state=seed).split(values, classes, groups))
    answers = []
    for cost in COSTS:
        machine = make_pipeline(StandardScaler(), LinearSVC(C=cost, dual=False, random_state=seed))
        answer = classes.copy()
        for learned, asked in splits:
            if len(np.unique(classes[learned])) < 2:
                answer[asked] = classes[learned][0]
                continue
            with warnings.catch_warnings(), threadpools().limit(limits=1):
                warnings.simplefilter("ignore", ConvergenceWarning)
                warnings.simplefilter("ignore", UserWarning)  # that there are few instances of each class
                machine.fit(values[learned], classes[learned])
            answer[asked] = machine.predict(values[asked])
        answers.append(answer)
    return answers
