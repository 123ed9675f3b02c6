"""SO-100 and SO-101 arms through LeRobot: the names and units of its datasets are those of its actions."""

from collections.abc import Mapping
from contextlib import suppress
from functools import partial
from typing import Any, Protocol

from app.distribution import missing
from app.drivers.driver import Clock, DriverError, Joints, LostError, RealClock, StreamedDriver
from app.files.lerobot_dataset import FPS
from app.files.lerobot_features import parts_of
from planner.robots.card import RobotCard


class Follower(Protocol):
    """The part of a LeRobot robot's interface that is used."""

    def connect(self) -> None:
        """Connect, and calibrate if the arm has not been calibrated."""
        ...

    def get_observation(self) -> Mapping[str, Any]:
        """Return its motors by ``NAME.pos``."""
        ...

    def send_action(self, action: dict[str, float]) -> Mapping[str, Any]:
        """Send its motors somewhere; return what was sent."""
        ...

    def disconnect(self) -> None:
        """Disconnect."""
        ...


class LerobotDriver(StreamedDriver):
    """A follower for each arm."""

    def __init__(self, card: RobotCard, followers: Mapping[str, Follower], clock: Clock | None = None) -> None:
        """Take the robot's card and the followers by the names of its arms.

        Raises:
            DriverError: the arms are not ones that LeRobot drives, or one of them has no follower.
        """
        super().__init__(FPS, clock or RealClock())
        self._parts = {part.source: part for part in parts_of(card)}
        if not all(part.name.endswith(".pos") for part in self._parts.values()):
            raise DriverError(f"lerobot drives SO-100 and SO-101 arms, and {card.title} has others")
        if missing := [arm.name for arm in card.arms if arm.name not in followers]:
            raise DriverError(f"--address: needs a port for {', '.join(missing)}, as in {missing[0]}=/dev/ttyACM0")
        self._followers = {arm.name: followers[arm.name] for arm in card.arms}
        # A follower knows its own motors only: "left_shoulder_pan.pos" is "shoulder_pan.pos" to it.
        self._motors = {
            name: (arm.name, self._parts[name].name.removeprefix(arm.gripper.joint_name.removesuffix("gripper")))
            for arm in card.arms
            for name in (*arm.joint_names, arm.gripper.joint_name)
        }

    def connect(self) -> None:
        """Connect all of them."""
        for name, follower in self._followers.items():
            try:
                follower.connect()
            except (OSError, RuntimeError) as error:
                raise DriverError(f"the arm {name!r} cannot be connected: {error}") from None

    def read(self) -> Joints:
        """Return the joints, from degrees and from 0 to 100."""
        seen = {name: self._asked(name, follower.get_observation) for name, follower in self._followers.items()}
        found = {}
        for joint, (arm, motor) in self._motors.items():
            part = self._parts[joint]
            found[joint] = float(seen[arm][motor]) / part.factor + part.zero
        return found

    def put(self, joints: Joints) -> None:
        """Send the joints in degrees, grippers from 0 to 100."""
        actions: dict[str, dict[str, float]] = {name: {} for name in self._followers}
        for joint, value in joints.items():
            if joint in self._motors:
                (arm, motor), part = self._motors[joint], self._parts[joint]
                actions[arm][motor] = (value - part.zero) * part.factor
        for name, action in actions.items():
            if action:
                self._asked(name, partial(self._followers[name].send_action, action))

    def stop(self) -> None:
        """Send each arm where it is."""
        for follower in self._followers.values():
            with suppress(OSError, RuntimeError):
                here = follower.get_observation().items()
                follower.send_action({name: float(value) for name, value in here if name.endswith(".pos")})

    def close(self) -> None:
        """Disconnect all of them; LeRobot lets their motors go."""
        for follower in self._followers.values():
            with suppress(OSError, RuntimeError):
                follower.disconnect()

    def _asked(self, name: str, ask: Any) -> Any:  # noqa: ANN401
        try:
            return ask()
        except (OSError, RuntimeError) as error:
            raise LostError(f"the arm {name!r} does not answer: {error}") from None


def so_followers(ports: Mapping[str, str]) -> dict[str, Follower]:
    """Return LeRobot's followers at serial ports, by the names of arms, which their calibrations have too.

    Raises:
        DriverError: LeRobot is not installed.
    """
    if (lacking := missing("lerobot")) is not None:
        raise DriverError(lacking.text)
    from lerobot.robots.so_follower import SO101Follower, SO101FollowerConfig

    return {
        name: SO101Follower(SO101FollowerConfig(port=port, id=name, use_degrees=True)) for name, port in ports.items()
    }
