"""Which learner made something: what an earlier one learned is not taken for what today's learns."""

import hashlib
from functools import cache
from pathlib import Path


@cache
def code_digest(folder: Path | None = None) -> str:
    """Digest of the source of the learner, 12 hexadecimal digits; another one after any change to it.

    Args:
        folder: Folder of the source; None takes this package.
    """
    root = Path(__file__).parent if folder is None else folder
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        content = path.read_bytes()
        digest.update(f"{path.relative_to(root).as_posix()}\0{len(content)}\0".encode())
        digest.update(content)
    return digest.hexdigest()[:12]
