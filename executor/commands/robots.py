"""`showtell robots`: which robots there are, with joints and limits."""

import math
from pathlib import Path
from typing import Annotated

import typer

from executor.commands.output import Json, Output, Seed
from executor.errors import InputError


def robots(
    name: Annotated[str | None, typer.Argument(help="Robot, or the path of a folder with a robot.toml.")] = None,
    picture: Annotated[Path | None, typer.Option(help="Draw the robot into this file (.png, .jpg).")] = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """List the robots, or the joints and limits of one.

    Example: showtell robots baxter --picture baxter.png
    """
    from robots import list_robots, load_robot

    del seed  # nothing here is random; every command takes one
    out = Output(as_json)
    names = list_robots() if name is None else (name,)
    if picture is not None:
        if name is None:
            raise InputError(f"--picture draws one robot: name one of {', '.join(names)}")
        from executor.picture import check_suffix

        check_suffix(picture)
    models = [load_robot(each) for each in names]
    if name is None:
        listed = [(each.name, each.description, len(each.arms), len(each.joint_names)) for each in models]
        out.table("Robots", ("name", "what it is", "arms", "driven joints"), listed)
        out.result({"robots": list(names)})
        return
    model = models[0]
    columns = ("joint", "lower [rad]", "upper [rad]", "velocity [rad/s]", "acceleration [rad/s²]", "jerk [rad/s³]")
    limits = (model.lower, model.upper, model.velocity, model.acceleration, model.jerk)
    rows = [(joint, *(f"{float(each[i]):g}" for each in limits)) for i, joint in enumerate(model.joint_names)]
    out.table(f"{model.name}: {model.description}", columns, rows)
    for arm in model.arms.values():
        gripper = arm.gripper
        out.say(
            f"{arm.name}: tool frame {arm.tool_frame}; gripper holds {1000 * gripper.min_opening:.0f} to "
            f"{1000 * gripper.max_opening:.0f} mm, closes with {gripper.force:g} N or Nm a finger"
        )
    if model.drive is not None:
        out.say(f"wheels: {model.drive.speed:g} m/s, {model.drive.yaw_rate:g} rad/s, track {model.drive.track:g} m")
    out.say(f"cameras: {', '.join(model.cameras) or 'none'}")
    out.say(f"passive joints: {', '.join(each.joint for each in model.mimic) or 'none'}")
    if picture is not None:
        from PIL import Image

        from executor.files import written_whole
        from executor.portrait import portrait

        with written_whole(picture) as temporary:
            Image.fromarray(portrait(model)).save(temporary)
        out.say(f"picture: {picture}")
    arms = {
        arm.name: {
            "joints": list(arm.joint_names),
            "tool_frame": arm.tool_frame,
            "min_opening": arm.gripper.min_opening,
            "max_opening": arm.gripper.max_opening,
        }
        for arm in model.arms.values()
    }
    out.result(
        {
            "name": model.name,
            "joints": list(model.joint_names),
            "lower": [_number(each) for each in model.lower],
            "upper": [_number(each) for each in model.upper],
            "velocity": model.velocity,
            "acceleration": model.acceleration,
            "jerk": model.jerk,
            "home": model.home,
            "arms": arms,
            "cameras": list(model.cameras),
            "picture": picture,
        }
    )


def _number(value: float) -> float | None:
    """A limit; None where a joint turns for ever, because JSON has no infinity."""
    return float(value) if math.isfinite(value) else None


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(robots)
