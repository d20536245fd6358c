"""Validation errors become one line."""

import pytest
from pydantic import BaseModel, ConfigDict, ValidationError

from robots.validation import first_problem, key_name


class Part(BaseModel):
    model_config = ConfigDict(extra="forbid")
    size: float


class Whole(BaseModel):
    model_config = ConfigDict(extra="forbid")
    parts: tuple[Part, ...] = ()


def problem(data: object) -> str:
    with pytest.raises(ValidationError, match="validation error") as caught:
        Whole.model_validate(data)
    return first_problem(caught.value, "file.toml", Whole)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"parts": [{}]}, "file.toml: parts[0].size: missing; add it"),
        ({"parts": [{"size": 1, "age": 2}]}, "file.toml: parts[0].age: unknown key; allowed keys here are size"),
        ({"pieces": 1}, "file.toml: pieces: unknown key; allowed keys here are parts"),
        (
            {"parts": [{"size": 1}, {"size": "x\ny"}]},
            "file.toml: parts[1].size: Input should be a valid number, unable to parse string as a number; got 'x\\ny'",
        ),
    ],
)
def test_the_first_problem_names_key_value_and_choices(data: object, message: str) -> None:
    assert problem(data) == message


def test_long_values_are_cut() -> None:
    assert problem({"parts": [{"size": "x" * 1000}]}).endswith("…")


def test_keys_read_like_toml() -> None:
    assert key_name(("objects", 3, "colour")) == "objects[3].colour"
    assert key_name(()) == ""
