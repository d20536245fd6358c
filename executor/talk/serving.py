"""What `showtell serve` gives the page's server, so that the page talks."""

from dataclasses import replace
from pathlib import Path

from teleop.loop_process import LoopSettings
from teleop.server_files import PageFiles, folder_files


def talking(settings: LoopSettings, knowledge: Path) -> LoopSettings:
    """Settings of a control loop with which one can talk.

    Args:
        settings: Scene and folder.
        knowledge: File of what was learned; made with the first lesson if it does not exist.
    """
    options = {"knowledge": str(knowledge.absolute()), "seed": str(settings.seed)}
    return replace(settings, extension="executor.talk:make_talk", options=options)


def talk_files() -> PageFiles:
    """What the page loads for it."""
    return folder_files("executor.talk", "page")
