"""Figures of many verdicts."""

from collections import Counter
from collections.abc import Iterable, Sequence
from statistics import median

from executor.execution.answer import Answer
from executor.execution.evaluation.verdict import Verdict


def figures_of(verdicts: Sequence[Verdict]) -> dict[str, float | int | None]:
    """Count what came of commands.

    Only commands whose outcome is known count for the rates; `false_success` is how many were reported done and are not
    as they should be, by the truth.
    """
    known = [each for each in verdicts if each.right is not None]
    times = [1000 * each.durations["to_motion"] for each in verdicts if "to_motion" in each.durations]
    answers = Counter(str(each.answer) for each in verdicts)
    return {
        "success_rate": sum(bool(each.right) for each in known) / len(known) if known else None,
        "false_success": sum(each.answer is Answer.DONE and not each.right for each in known),
        "uncertain": answers[Answer.UNCERTAIN],
        "commands": len(verdicts),
        "unscored": len(verdicts) - len(known),
        "moved": sum(each.moved for each in verdicts),
        "median_ms_to_motion": round(median(times), 1) if times else None,
        "most_ms_to_motion": round(max(times), 1) if times else None,
        **{f"answer.{kind}": answers[kind] for kind in Answer if answers[kind]},
    }


def causes_of(verdicts: Iterable[Verdict]) -> list[tuple[str, int]]:
    """Causes of failures with how often they came, the commonest first."""
    return Counter(each.cause for each in verdicts if each.right is False).most_common()


def kinds_of(verdicts: Iterable[Verdict]) -> list[tuple[str, int, int]]:
    """Kinds of commands with how many there were and how many came out right."""
    total: Counter[str] = Counter()
    right: Counter[str] = Counter()
    for each in verdicts:
        total[each.kind] += 1
        right[each.kind] += bool(each.right)
    return [(kind, total[kind], right[kind]) for kind in sorted(total)]
