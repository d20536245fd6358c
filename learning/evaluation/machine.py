"""What a figure was measured on."""

import os
import platform


def machine() -> dict[str, str | int]:
    """Describe the machine without naming it: system, processor, cores and Python."""
    return {
        "system": platform.system(),
        "processor": platform.machine(),
        "cores": os.cpu_count() or 1,
        "python": platform.python_version(),
    }
