"""One goal at a table carried out: played, looked at again, and once more another way if the grasp slipped."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from executor.actions.obstruction import around_grasps
from executor.actions.player import ActionPlayer, Played
from executor.actions.quantities import quantities_of
from executor.actions.things import corners_of, pose_of
from executor.errors import RefusalError
from executor.execution.answer import Answer
from executor.follow import wait
from executor.report import Outcome, answer_of, joined
from executor.tables.places import Spot, meets
from executor.tables.recovery import SAME, bring_home, come_to_rest
from executor.tables.table_view import TableView, alike
from learning.interpretation.interpretation import Goal
from learning.interpretation.table_interpreter import TableGoal
from robots.pose import FloatArray
from twin.grasp_poses import GraspPose

if TYPE_CHECKING:
    from learning import Knowledge
    from twin import World

REST = 0.7
"""Time [s] in which all comes to rest before the second look."""
DISTURBED = 0.03
"""Other things that moved further were disturbed [m]."""
NEAR_BY = 0.2
"""A thing that was moved along is so near to where it was [m]."""
ATTEMPTS = 2
"""How often a thing is reached for: what slipped is taken once more, with another grasp."""
SLIPPED, STUCK = ("dropped", "not gripped"), ("no carry",)
"""How the reasons begin of what is worth another try: with another grasp, or put down and taken anew, by any arm."""


@dataclass(frozen=True, slots=True)
class TableRun:
    """How a goal was carried out.

    Attributes:
        outcome: What the last look showed; None where the goal could not be begun.
        attempts: How often the thing was reached for.
        note: What happened on the way, or why nothing could be begun, in plain words; or nothing.
    """

    outcome: Outcome | None
    attempts: int
    note: str

    @property
    def answer(self) -> Answer:
        """How the command is answered."""
        return answer_of(self.outcome)


@dataclass(frozen=True, slots=True)
class _Attempt:
    """How an action was played, to which place, and with which grasps."""

    played: Played
    spot: Spot | None
    grasps: tuple[GraspPose, ...] = ()


@dataclass(frozen=True, slots=True)
class _Meant:
    """What the words say of where a thing goes, with the numbers of things it may go to, and where those were."""

    goal: TableGoal
    grounds: tuple[int, ...]
    view: TableView


class TableRunner:
    """Carries out goals in one world, seeing it through a camera.

    Args:
        world: The world.
        knowledge: What was learned: how actions are done.
        rng: Source of the planners' chance.
        look: Gives a look at the table as it is now.

    Attributes:
        on_start: Called with the thing's id in the world and the arm's name when an action begins.
        on_progress: Called with what begins, see `Doer`.
    """

    def __init__(
        self, world: "World", knowledge: "Knowledge", rng: np.random.Generator, look: Callable[[], TableView]
    ) -> None:
        self.world = world
        self.knowledge = knowledge
        self.on_start: Callable[[int, str], None] = lambda thing, arm: None
        self.on_progress: Callable[[object], None] = lambda step: None
        self._rng = rng
        self._look = look
        self._meant: _Meant | None = None

    def carry_out(
        self,
        goal: Goal,
        action: int,
        spots: tuple[Spot, ...],
        view: TableView,
        *,
        meant: TableGoal | None = None,
        sound: bool = True,
    ) -> TableRun:
        """Play an action until a look shows that the goal is reached, at most `ATTEMPTS` times.

        However it ends, the hands are left sound: they hold only what they should.

        Args:
            goal: What to reach.
            action: Number of its action.
            spots: Places for the thing, the best first; none where it goes nowhere.
            view: What was seen of the table as it stands.
            meant: What the words say of where the thing goes, in that view; None where it just goes to its place.
            sound: Whether the hands are sound now; else they are brought to rest first.
        """
        before, note = view, ""
        grounds = () if meant is None else tuple(view.numbers[each] for each in meant.grounds)
        self._meant = None if meant is None else _Meant(meant, grounds, view)
        slipped: tuple[GraspPose, ...] = ()
        outcome: Outcome | None = None
        if not sound:
            note = self._come_to_rest(view, self._held(view, goal))
            view = before = self._look()
        for attempt in range(1, ATTEMPTS + 1):
            thing = view.index_of(goal.object_id)
            real = None if thing is None else self._real(view, thing)
            if thing is None or real is None:
                return TableRun(outcome, attempt - 1, joined(note, "the thing that is meant was lost from sight"))
            begun = self.world.time
            done = self._play(action, goal, real, spots, slipped)
            if self.world.time == begun:  # nothing has moved
                again = "" if outcome is None else "a second try is not possible: "
                return TableRun(outcome, attempt - 1, joined(note, again + done.played.reason))
            if done.played.success:  # an arm that stays would hide what it did, and be in the other's way
                bring_home(self.world, self._rng)
            wait(self.world, REST, self.world.commanded_openings)
            now = self._look()
            outcome = self._judge(goal, thing, view, now, done.spot)
            if not done.played.success:
                outcome = replace(outcome, reached=False, doubt="", explanation=done.played.reason)
            if outcome.right:
                break
            keep = real if outcome.reached and goal.action.states[-1].holds else None
            note = joined(note, self._come_to_rest(now, keep))
            if attempt == ATTEMPTS or not _may_be_tried_again(done.played, outcome):
                break
            stuck = done.played.reason.startswith(STUCK)
            how = "it was taken anew" if stuck else "the grasp slipped, so it was tried once more, another way"
            note, slipped = joined(note, how), () if stuck else done.grasps
            view = self._look()
        if attempt > 1 and outcome is not None:
            first = before.index_of(goal.object_id)
            assert first is not None
            outcome = replace(outcome, disturbed=self._disturbed(first, before, self._look()))
        return TableRun(outcome, attempt, note)

    def around(self, thing: int, view: TableView) -> tuple[int, ...]:
        """Numbers of the things that keep every arm from a thing, the one to begin with first; none if nothing does.

        Args:
            thing: Index of the thing.
            view: What is seen of the table as it is.
        """
        real = self._real(view, thing)
        if real is None:
            return ()
        numbers = {self._real(view, index): number for index, number in enumerate(view.numbers) if index != view.held}
        met = around_grasps(self.world, real, self._rng)
        return tuple(numbers[each] for each in met) if all(each in numbers for each in met) else ()

    def _held(self, view: TableView, goal: Goal) -> int | None:
        """Id of what is in a hand, if it is what a goal is about."""
        thing = view.index_of(goal.object_id)
        real = None if thing is None else self._real(view, thing)
        held = {arm.held for arm in self.world.state().arms if arm.gripper_closed}
        return real if real in held else None

    def _come_to_rest(self, view: TableView, keep: int | None) -> str:
        """Bring the hands to rest among what is seen; what was done."""
        return come_to_rest(self.world, view.things, self._rng, keep)

    def _real(self, view: TableView, thing: int) -> int | None:
        """Id of the thing in the world: grasps are chosen by the models of things, which the twin knows."""
        where = view.things.location[thing]
        state = self.world.state()
        away = {each.id: float(np.linalg.norm(each.pose_object_in_world.position - where)) for each in state.objects}
        held = {arm.held for arm in state.arms if arm.gripper_closed and arm.held is not None}
        if thing == view.held and held:
            return min(held, key=lambda each: away[each])
        nearest = min(away, key=lambda each: away[each])
        return nearest if away[nearest] < SAME else None

    def _play(
        self, number: int, goal: Goal, real: int, spots: tuple[Spot, ...], slipped: tuple[GraspPose, ...]
    ) -> _Attempt:
        """Play the action with the first place that can be reached: from where the base stands, else from nearer."""
        quantities = quantities_of(goal.action, self.knowledge.spaces.actions.statistics(number))
        player = ActionPlayer(self.world, self._rng, lambda primitive: self.on_progress(primitive))
        failed: _Attempt | None = None
        for stays in (True, False) if self.world.robot.drive is not None else (True,):
            for spot in spots or (None,):
                there = None if spot is None else self._at_rest(real, spot)
                try:
                    played = player.play(
                        goal.action,
                        real,
                        there,
                        quantities,
                        lambda arm: self.on_start(real, arm),
                        stays=stays,
                        slipped=slipped,
                    )
                except RefusalError as refusal:
                    return _Attempt(Played(False, str(refusal)), spot)
                if played.success or played.started:
                    return _Attempt(played, spot, player.grasps)
                failed = failed or _Attempt(played, spot, player.grasps)
        assert failed is not None
        return failed

    def _at_rest(self, real: int, spot: Spot) -> FloatArray:
        """Where the centre comes to rest at a place, as high above its underside as it is now."""
        if spot.onto is not None:
            return spot.position  # half of its height as it was seen above the top of what bears it
        centre = pose_of(self.world.state(), real).position
        below = float(centre[2] - corners_of(self.world, real)[:, 2].min())
        return np.array([spot.position[0], spot.position[1], below])

    def _judge(self, goal: Goal, thing: int, before: TableView, now: TableView, spot: Spot | None) -> Outcome:
        """Compare two looks."""
        words: list[str] = []
        error: float | None = None
        doubt = ""
        track = self._again(thing, before, now, spot)
        if goal.action.states[-1].holds:
            reached = now.feels
            if reached:
                words.append("the hand feels it between the fingers")
            elif track is None:
                reached, doubt = True, "the hand does not feel it, and it is not seen where it was"
                words.append(doubt)
            else:
                words.append("the hand holds nothing")
        elif now.held is not None and goal.action.states[0].holds:
            reached = False
            words.append("it is still in the hand")
        elif spot is None:
            reached = True
            words.append("it was done")
        elif track is None:
            reached, doubt = True, "it cannot be seen any more"
            words.append(doubt)
        else:
            error = float(np.linalg.norm(now.things.location[track, :2] - spot.position[:2]))
            reached = error < SAME
            words.append(f"it rests {1000 * error:.0f} mm from the middle of its place")
            if reached and not self._is_as_meant(track, now):
                reached = False
                words.append("that is not where the words say")
        disturbed = self._disturbed(thing, before, now)
        if disturbed:
            words.append(f"{len(disturbed)} other thing{'s' if len(disturbed) > 1 else ''} moved as well")
        return Outcome(reached, error, disturbed, "; ".join(words), doubt)

    def _is_as_meant(self, track: int, now: TableView) -> bool:
        """Whether a thing is where the words say: in that part of the table, beside, or over what it shall be on."""
        meant = self._meant
        if meant is None:
            return True
        grounds = []
        for number in meant.grounds:
            index = now.index_of(number)
            seen, at = (meant.view, meant.view.index_of(number)) if index is None else (now, index)
            if at is not None:  # what the thing hides now is where it was
                grounds.append((seen.things.location[at], seen.things.extent[at]))
        place, extent = now.things.location[track], now.things.extent[track]
        spaces, resting = self.knowledge.spaces, self.knowledge.table_language.resting
        return meets(meant.goal, place, extent, grounds, spaces, resting)

    def _again(self, thing: int, before: TableView, now: TableView, spot: Spot | None) -> int | None:
        """Which of the things that are seen now is the one that was handled: like it, and where it should be."""
        where = before.things.location[thing] if spot is None else spot.position
        off = [
            float(np.linalg.norm(now.things.location[index, :2] - where[:2]))
            if alike(before, thing, now, index)
            else np.inf
            for index in range(len(now.things.location))
        ]
        best = int(np.argmin(off)) if off else 0
        return best if off and off[best] < NEAR_BY else None

    def _disturbed(self, thing: int, before: TableView, now: TableView) -> tuple[int, ...]:
        """Things that are not where they were, but somewhere near; what the arm hides now was not disturbed.

        Of what is seen smaller than before a part is hidden: its middle is off by half of that at most.
        """
        if not len(now.things.location):
            return ()
        places = before.things.location
        hidden = 0.5 * np.maximum(before.things.extent[None, :, 0] - now.things.extent[:, None, 0], 0.0)
        away = np.linalg.norm(now.things.location[:, None] - places[None], axis=2)
        moved = away > DISTURBED + hidden
        new = np.flatnonzero(moved.all(axis=1))
        return tuple(
            before.numbers[index]
            for index in range(len(places))
            if index != thing
            and moved[:, index].all()
            and any(away[other, index] < NEAR_BY and alike(before, index, now, int(other)) for other in new)
        )


def _may_be_tried_again(played: Played, outcome: Outcome) -> bool:
    """Whether it went wrong in a way that another grasp may cure."""
    if played.success:
        return not outcome.reached and not outcome.doubt
    return played.reason.startswith((*SLIPPED, *STUCK))
