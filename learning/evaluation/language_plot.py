"""The learning curve of grounding as a picture (thesis figure 6.19)."""

from pathlib import Path

from learning.evaluation.language_pairs import SPACES
from learning.evaluation.language_report import LanguageReport


def plot_curve(report: LanguageReport, path: Path) -> None:
    """Draw F1 of each feature space over what was learned from.

    Args:
        report: With a curve.
        path: Picture to write.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 4.5), layout="constrained")
    axes = figure.add_subplot()
    learned = [number for number, _ in report.curve]
    for space in SPACES:
        values = [scores.get(space) for _, scores in report.curve]
        if any(value is not None for value in values):
            shown = [float("nan") if value is None else value for value in values]
            axes.plot(learned, shown, marker="o", markersize=3, label=space)
    axes.set_xlabel("learned from")
    axes.set_ylabel("F1 of grounding")
    axes.set_ylim(0.0, 1.02)
    axes.grid(alpha=0.3)
    axes.legend(ncols=3, fontsize="small")
    axes.set_title(f"Grounding, {report.robot}")
    figure.savefig(path, dpi=130)
