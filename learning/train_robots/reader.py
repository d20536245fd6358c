"""Reading the text files of a release: lines, columns and numbers, with errors that name file, line and value."""

from collections.abc import Collection, Iterator
from pathlib import Path

from learning.errors import ReleaseError


def spelled(allowed: Collection[object]) -> str:
    """Write a set of allowed values: a range as `first..last`, others as a list."""
    if isinstance(allowed, range):
        return f"{allowed[0]}..{allowed[-1]}"
    return ", ".join(str(value) for value in allowed)


class Line:
    """One line of a release file with its place, for messages."""

    def __init__(self, path: Path, number: int, text: str) -> None:
        self.path = path
        self.number = number
        self.text = text

    def error(self, message: str) -> ReleaseError:
        """Make the error that names this line's file and number."""
        return ReleaseError(f"{self.path}, line {self.number}: {message}")

    def columns(self, count: int, names: str) -> list[str]:
        """Split at tabs into exactly `count` fields without surrounding blanks; else ReleaseError."""
        fields = [field.strip() for field in self.text.split("\t")]
        if len(fields) != count:
            raise self.error(f"{len(fields)} columns where {count} were expected (tab separated: {names})")
        return fields

    def integer(self, value: str, what: str, allowed: range | None = None) -> int:
        """Read a whole number, within `allowed` when given; else ReleaseError."""
        expected = "a whole number from 1" if allowed is None else f"a whole number in {spelled(allowed)}"
        if not (value.isascii() and value.isdigit()):
            raise self.error(f"{what} '{value}' is not a number; expected {expected}")
        number = int(value)
        if number < 1 if allowed is None else number not in allowed:
            raise self.error(f"{what} {number} is out of range; expected {expected}")
        return number

    def choice(self, value: str, what: str, allowed: Collection[str]) -> str:
        """Check that a code is one of `allowed`; else ReleaseError."""
        if value not in allowed:
            raise self.error(f"unknown {what} '{value}'; allowed: {spelled(allowed)}")
        return value


def read_lines(path: Path) -> Iterator[Line]:
    """Yield the lines of a UTF-8 file, blank ones too; CR LF and stray CR are dropped.

    Raises ReleaseError when the file is missing, unreadable or not UTF-8.
    """
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        raise ReleaseError(f"{path} is missing; a release has commands.txt and configuration.txt") from None
    except OSError as error:
        raise ReleaseError(f"{path} cannot be read: {error.strerror or error}") from None
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        number = data[: error.start].count(b"\n") + 1
        raise ReleaseError(f"{path}, line {number}: byte 0x{data[error.start]:02x} is not UTF-8 text") from None
    for number, line in enumerate(text.split("\n"), start=1):
        yield Line(path, number, line.replace("\r", "").strip())
