import json
from pathlib import Path

from teleop.demo_format import EVENTS, OUTCOMES, SCHEMAS, WHEN, log_time

DOCUMENT = Path(__file__).resolve().parents[2] / "docs" / "demo-format.md"


def test_every_topic_and_field_is_in_the_document() -> None:
    text = DOCUMENT.read_text(encoding="utf-8")
    rows = {line.split("|")[1].strip(): line for line in text.splitlines() if line.startswith("| `/")}
    for topic, (_, schema) in SCHEMAS.items():
        row = next(line for heads, line in rows.items() if f"`{topic}`" in heads)
        if topic.startswith("/prelude"):
            continue  # as the topics that they stand before
        for field in json.loads(schema)["required"]:
            assert field == "step" or f"`{field}`" in row, f"{topic} {field}"
    for word in (*EVENTS, *OUTCOMES, *WHEN):
        assert word in text


def test_log_times_are_exact_at_whole_seconds() -> None:
    assert [log_time(step, 240) for step in (0, 1, 240, 21600)] == [0, 4166666, 10**9, 90 * 10**9]
