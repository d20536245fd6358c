"""Files that users write, checked by pydantic; one-line messages: file, key, value, what is allowed."""

import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from .errors import ShowtellError

Model = TypeVar("Model", bound=BaseModel)


def read_toml(path: Path, model: type[Model], error_type: type[ShowtellError]) -> Model:
    """Read a TOML file and check it against a model.

    Raises:
        ShowtellError: As `error_type`: the file cannot be read, is not TOML, or a value is wrong; names file and key.
    """
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise error_type(f"{path}: cannot be read: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise error_type(f"{path}: not valid TOML: {error}") from error
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise error_type(first_problem(error, str(path), model)) from error


def first_problem(error: ValidationError, source: str, model: type[BaseModel]) -> str:
    """Describe the first problem of a validation error in one line.

    Args:
        error: What pydantic raised.
        source: The file (or other source) that was read.
        model: The model that was validated; its field names are listed when a key is unknown.

    Returns:
        `source: key: problem`, with the value received and, where they can be listed, the allowed ones.
    """
    problem = error.errors(include_url=False)[0]
    key = key_name(problem["loc"]) or "file"
    if problem["type"] == "missing":
        return f"{source}: {key}: missing; add it"
    if problem["type"] == "extra_forbidden":
        return f"{source}: {key}: unknown key; allowed keys here are {', '.join(_keys_at(model, problem['loc'][:-1]))}"
    message = problem["msg"].removeprefix("Value error, ")
    if problem["type"] == "value_error" and isinstance(problem["input"], dict):
        # A whole table is wrong; its message says which values are.
        return f"{source}: {key}: {message}" if problem["loc"] else f"{source}: {message}"
    return f"{source}: {key}: {message}; got {_short(problem['input'])}"


def key_name(location: Sequence[str | int]) -> str:
    """Write a pydantic location as a TOML reader would: `objects[3].colour`."""
    name = ""
    for part in location:
        name += f"[{part}]" if isinstance(part, int) else f".{part}" if name else part
    return name


def _keys_at(model: type[BaseModel], location: Sequence[str | int]) -> list[str]:
    """Field names of the (sub-)model at a location."""
    for part in location:
        if isinstance(part, str) and part in model.model_fields:
            inner = _model_in(model.model_fields[part].annotation)
            if inner is not None:
                model = inner
    return list(model.model_fields)


def _model_in(annotation: Any) -> type[BaseModel] | None:
    """The first pydantic model inside an annotation such as `tuple[ObjectSpec, ...]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    for inner in get_args(annotation):
        if (found := _model_in(inner)) is not None:
            return found
    return None


def _short(value: object, limit: int = 80) -> str:
    """A value's repr, cut so that the message stays one line."""
    text = repr(value).replace("\n", " ")
    return text if len(text) <= limit else f"{text[:limit]}…"
