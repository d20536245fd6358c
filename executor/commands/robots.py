"""`showtell robots`: which robots there are, with joints and limits."""

from typing import Annotated

import typer

from executor.commands.output import Json, Output, Seed


def robots(
    name: Annotated[str | None, typer.Argument(help="Robot, or the path of a folder with a robot.toml.")] = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """List the robots, or the joints and limits of one.

    Example: showtell robots three_dof
    """
    from robots import list_robots, load_robot

    del seed  # nothing here is random; every command takes one
    out = Output(as_json)
    names = list_robots() if name is None else (name,)
    models = [load_robot(each) for each in names]
    if name is None:
        listed = [(model.name, model.description, len(model.joint_names)) for model in models]
        out.table("Robots", ("name", "what it is", "driven joints"), listed)
        out.result({"robots": list(names)})
        return
    model = models[0]
    columns = ("joint", "lower [rad]", "upper [rad]", "velocity [rad/s]", "acceleration [rad/s²]", "jerk [rad/s³]")
    limits = (model.lower, model.upper, model.velocity, model.acceleration, model.jerk)
    rows = [(joint, *(f"{float(each[i]):g}" for each in limits)) for i, joint in enumerate(model.joint_names)]
    out.table(f"{model.name}: {model.description}", columns, rows)
    out.say(
        f"gripper: opens to {1000 * model.gripper.max_opening:g} mm, closes with {model.gripper.force:g} N a finger"
    )
    out.say(f"passive joints: {', '.join(each.joint for each in model.mimic) or 'none'}")
    out.result(
        {
            "name": model.name,
            "joints": list(model.joint_names),
            "lower": model.lower,
            "upper": model.upper,
            "velocity": model.velocity,
            "acceleration": model.acceleration,
            "jerk": model.jerk,
            "home": model.home,
            "max_opening": model.gripper.max_opening,
        }
    )


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(robots)
