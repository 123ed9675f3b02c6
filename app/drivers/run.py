"""A plan performed by a driver: the way to its first pose, then step by step, each confirmed, all of it recorded."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal

from app.drivers.driver import Clock, Driver, Joints, LostError, RealClock
from app.files.joint_motion import JointMotion
from app.files.slowed import slowed
from app.step_kinds import step_words
from planner.errors import UnsolvedPlanError
from planner.planning.way_to_step import WayToStep, require_beginning
from planner.robots.card import RobotCard
from planner.task.plan import Plan

THERE = 0.01
"""Joints this near to a pose are there (rad, m)."""

OFF = 0.1
"""Arms with a joint that is farther from where a motion begins or ends are lost (rad, m)."""


class Recording:
    """Messages in the order of their times, which count from its beginning.

    Each motion is a `JointTrajectory` for each controller on the topics of the exports, logged when it was sent; what
    was read are `JointState`s on ``/joint_states``.
    """

    def __init__(self, card: RobotCard, clock: Clock | None = None) -> None:
        """Begin a recording of a robot."""
        self._card, self._clock = card, clock or RealClock()
        self._start_s, self._kept = self._clock.now_s(), list[tuple[int, JointMotion | Joints]]()

    def sent(self, motion: JointMotion) -> None:
        """Keep a motion."""
        self._kept.append((self._now_ns(), motion))

    def read(self, joints: Joints) -> None:
        """Keep joints as they were read."""
        self._kept.append((self._now_ns(), dict(joints)))

    def mcap(self, about: dict[str, Any]) -> bytes:
        """Return all of it as a file; `about` says what it is of."""
        from app.files.ros_bag import JointMessages, RosMessage, RosMotion, mcap_of, message_types

        written, messages = JointMessages(message_types()), list[RosMessage]()
        for stamp_ns, kept in self._kept:
            if isinstance(kept, JointMotion):
                messages.extend(written.trajectories(kept, self._card, stamp_ns))
            else:
                messages.append(written.state(kept, stamp_ns))
        return mcap_of(RosMotion(tuple(messages), about))

    def _now_ns(self) -> int:
        return round((self._clock.now_s() - self._start_s) * 1e9)


@dataclass(frozen=True, slots=True)
class Leg:
    """A part of a run.

    Attributes:
        what: what it is, in a few words.
        duration_s: how long it takes (s).
        step: the plan's step; None: the way to the first of them.
    """

    what: str
    duration_s: float
    step: int | None = None


@dataclass(frozen=True, slots=True)
class Ended:
    """How a run ended.

    Attributes:
        how: whether all is done, someone stopped it, or the robot was lost.
        done: how many steps are done, counted from the plan's first; those before the run began count.
        why: why it ended early.
    """

    how: Literal["done", "stopped", "lost"]
    done: int
    why: str = ""


Confirm = Callable[[Leg], bool]
"""Returns whether to perform a part."""

Look = Callable[[Joints], int]
"""Returns the index of the next step for the joints as read; raises `LostError` if they match no step."""

Progress = Callable[[Leg, float], None]
"""Called with a part and the time since it began (s)."""


def run_plan(
    plan: Plan,
    card: RobotCard,
    driver: Driver,
    confirm: Confirm,
    progress: Progress,
    recording: Recording,
    from_step: int = 0,
    speed: float = 1.0,
    until_step: int | None = None,
    look: Look | None = None,
) -> Ended:
    """Perform a plan; stop the arms if anything ends it early, Ctrl-C (`KeyboardInterrupt`) included.

    Args:
        plan: a solved plan.
        card: its robot.
        driver: what moves the robot; it is connected here, and closed at the end.
        confirm: is asked before each part.
        progress: called with how far each part is.
        recording: keeps what is sent and read.
        from_step: the first step that is performed.
        speed: the share of the planned speed.
        until_step: the step before which the run is done; None: it goes on to the plan's end.

        look: finds the first step in place of `from_step`, before anything moves.

    Raises:
        UnsolvedPlanError: the plan is not solved.
        RequestError: there is no such step, or cloth is held as it begins.
        DriverError: the driver cannot be used.
    """
    run = _Run(slowed(plan, speed), card, driver, recording, speed)
    require_beginning(plan, from_step)
    done = from_step
    try:
        driver.connect()
        if look is not None:
            done = from_step = look(driver.read())
        if from_step == len(plan.steps) > 0:
            return Ended("done", done)
        way = WayToStep.of(plan, from_step)
        for leg, motion in run.legs(way, from_step, until_step):
            if not confirm(leg):
                return Ended("stopped", done, "not confirmed")
            run.perform(motion, partial(progress, leg))
            done = done if leg.step is None else leg.step + 1
    except KeyboardInterrupt:
        driver.stop()
        return Ended("stopped", done, "interrupted")
    except LostError as error:
        driver.stop()
        return Ended("lost", done, str(error))
    finally:
        driver.close()
    return Ended("done", done)


class _Run:
    """A plan and what performs it."""

    def __init__(self, plan: Plan, card: RobotCard, driver: Driver, recording: Recording, speed: float) -> None:
        if plan.trajectory is None:
            raise UnsolvedPlanError(plan.status)
        self._plan, self._path, self._card, self._speed = plan, plan.trajectory, card, speed
        self._driver, self._recording = driver, recording

    def legs(self, way: WayToStep, from_step: int, until_step: int | None) -> Iterator[tuple[Leg, JointMotion]]:
        """Yield the parts of the run, each when the one before is done."""
        here = self._read()
        if max(abs(here[name] - q) for name, q in zip(way.names, way.goal.tolist(), strict=True)) > THERE:
            found = way.way(here)
            if found is None:
                raise LostError("no way leads from where the joints are to the first pose; move the arms by hand")
            motion = JointMotion.along(way.names, found, self._speed)
            yield Leg("to the first pose", motion.duration_s), motion
        for number, step in enumerate(self._plan.steps[from_step:until_step], start=from_step):
            motion = JointMotion.of(self._path, step, self._card, self._plan.scene)
            words = step_words(step, self._plan.garment)
            yield Leg(f"{step.kind} {words}".strip(), motion.duration_s, number), motion

    def perform(self, motion: JointMotion, progress: Callable[[float], None]) -> None:
        """Have a motion performed; raise `LostError` unless the arms are where it begins, and then where it ends."""
        self._require_arms(motion.at(0.0), "begins")
        self._bring_fingers(motion.at(0.0))
        self._recording.sent(motion)

        def seen(t_s: float, joints: Joints) -> None:
            self._recording.read(joints)
            progress(t_s)

        self._driver.send(motion, seen)
        self._require_arms(motion.at(motion.duration_s), "ends")

    def _require_arms(self, pose: Joints, does: str) -> None:
        here, fingers = self._read(), self._fingers
        off = {name: abs(here[name] - q) for name, q in pose.items() if name in here and name not in fingers}
        worst = max(off, key=lambda name: off[name])
        if off[worst] > OFF:
            raise LostError(f"joint {worst!r} is {off[worst]:.2f} (rad, m) from where the motion {does}")

    def _bring_fingers(self, pose: Joints) -> None:
        here = self._read()
        if apart := {name: q for name, q in pose.items() if name in self._fingers and abs(here[name] - q) > THERE}:
            self._driver.grip(apart)

    @property
    def _fingers(self) -> frozenset[str]:
        return frozenset(arm.gripper.joint_name for arm in self._card.arms)

    def _read(self) -> Joints:
        found = self._driver.read()
        self._recording.read(found)
        return found
