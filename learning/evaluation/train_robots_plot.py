"""Pictures of understanding commands: with more and more of them heard (thesis figure 6.19), and over ε (6.22)."""

from collections.abc import Sequence
from pathlib import Path

from learning.evaluation.train_robots import MILESTONES

Point = tuple[float, float]


def plot_learning(
    path: Path, curve: Sequence[Point], sensitivity: Sequence[Point] = (), others: Sequence[tuple[str, float]] = ()
) -> None:
    """Draw execution accuracy over the commands heard, and over ε where it was varied.

    Args:
        path: Picture to write.
        curve: Commands heard and accuracy, in rising order.
        sensitivity: ε and accuracy; empty leaves that drawing out.
        others: Names and accuracies of baselines.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.5 if sensitivity else 6.5, 4.3), layout="constrained")
    axes = figure.add_subplot(1, 2 if sensitivity else 1, 1)
    axes.plot([heard for heard, _ in curve], [share for _, share in curve], marker="o", markersize=3, label="ours")
    for number, (name, value) in enumerate(others):
        axes.axhline(value, color=f"C{number + 1}", linestyle=":", label=name)
    for percent in MILESTONES:
        axes.axhline(percent / 100, color="0.8", linewidth=0.8, zorder=0)
    if curve:
        axes.set_xscale("log", base=2)
    axes.set_xlabel("commands heard")
    axes.set_ylabel("execution accuracy on held-out commands")
    axes.set_ylim(0.0, 1.02)
    axes.legend(fontsize="small")
    axes.grid(alpha=0.3)
    if sensitivity:
        beside = figure.add_subplot(1, 2, 2)
        ordered = sorted(sensitivity)
        beside.plot([epsilon for epsilon, _ in ordered], [share for _, share in ordered], marker="o", markersize=3)
        beside.set_xscale("log")
        beside.set_xlabel("ε")
        beside.set_ylabel("execution accuracy")
        beside.set_ylim(0.0, 1.02)
        beside.grid(alpha=0.3)
    figure.savefig(path, dpi=130)
