"""Arms of Universal Robots through ur-rtde, with Robotiq grippers on their wrists."""

import socket
from collections.abc import Mapping
from contextlib import suppress
from typing import Any, Protocol

from app.distribution import missing
from app.drivers.driver import Clock, DriverError, Joints, LostError, RealClock, StreamedDriver
from planner.robots.card import ArmCard, RobotCard

_RATE_HZ = 125.0
_LOOKAHEAD_S, _GAIN = 0.1, 300
_STOP_RAD_S2 = 5.0

_GRIPPER_PORT, _GRIPPER_WAIT_S = 63352, 2.0
_OPEN, _CLOSED = 0, 255
"""What a Robotiq gripper calls open and closed."""


class Arm(Protocol):
    """An arm with its gripper."""

    def joints(self) -> list[float]:
        """Return its six joints (rad)."""
        ...

    def servo(self, joints: list[float], tick_s: float) -> None:
        """Follow on to joints (rad) within a tick (s)."""
        ...

    def gripper(self) -> float:
        """Return how far its gripper is closed, 0 to 1."""
        ...

    def grip(self, closed: float) -> None:
        """Move the gripper to an opening, 0 to 1, without waiting for it."""
        ...

    def stop(self) -> None:
        """Stop."""
        ...

    def close(self) -> None:
        """Disconnect."""
        ...


class UrDriver(StreamedDriver):
    """A UR arm for each arm of the card."""

    def __init__(self, card: RobotCard, addresses: Mapping[str, str], clock: Clock | None = None) -> None:
        """Take the robot's card and the addresses of its arms by their names.

        Raises:
            DriverError: the arms are not UR's, or one has no address.
        """
        super().__init__(_RATE_HZ, clock or RealClock())
        if not all(
            arm.joint_names[0].endswith("shoulder_pan_joint") and len(arm.joint_names) == 6 for arm in card.arms
        ):
            raise DriverError(f"ur drives arms of Universal Robots, and {card.title} has others")
        if missing := [arm.name for arm in card.arms if arm.name not in addresses]:
            raise DriverError(f"--address: needs that of {', '.join(missing)}, as in {missing[0]}=192.168.0.2")
        self._cards, self._addresses = card.arms, addresses
        self._arms: dict[str, Arm] = {}
        self._sent: dict[str, float] = {}

    def connect(self) -> None:
        """Connect all arms and grippers."""
        for arm in self._cards:
            try:
                self._arms[arm.name] = connected(self._addresses[arm.name])
            except (OSError, RuntimeError) as error:
                raise DriverError(f"the arm {arm.name!r} cannot be connected: {error}") from None

    def read(self) -> Joints:
        """Return the joints."""
        found: dict[str, float] = {}
        for card in self._cards:
            arm = self._arms[card.name]
            try:
                found |= zip(card.joint_names, arm.joints(), strict=True)
                opened = (1.0 - arm.gripper()) * card.gripper.opening_max_m
            except (OSError, RuntimeError) as error:
                raise LostError(f"the arm {card.name!r} does not answer: {error}") from None
            found[card.gripper.joint_name] = card.gripper.angle(opened)
        return found

    def put(self, joints: Joints) -> None:
        """Stream the next joints to the arms; command a gripper only if its target has changed."""
        for card in self._cards:
            arm = self._arms[card.name]
            try:
                if card.joint_names[0] in joints:
                    arm.servo([joints[name] for name in card.joint_names], self._tick_s)
                name = card.gripper.joint_name
                if name in joints and self._sent.get(name) != joints[name]:
                    arm.grip(_closed_share(card, joints[name]))
                    self._sent[name] = joints[name]
            except (OSError, RuntimeError) as error:
                raise LostError(f"the arm {card.name!r} does not answer: {error}") from None

    def stop(self) -> None:
        """Stop the arms."""
        for arm in self._arms.values():
            with suppress(OSError, RuntimeError):
                arm.stop()

    def close(self) -> None:
        """Disconnect."""
        for arm in self._arms.values():
            with suppress(OSError, RuntimeError):
                arm.close()


def _closed_share(card: ArmCard, value: float) -> float:
    """Return how far a gripper is closed, 0 to 1, from the joint that drives it."""
    closed, opened = card.gripper.angle(0.0), card.gripper.angle(card.gripper.opening_max_m)
    return min(max((opened - value) / (opened - closed), 0.0), 1.0)


def connected(address: str) -> Arm:
    """Return the arm at an address; raises `DriverError` where ur-rtde is not installed."""
    if (lacking := missing("rtde_control")) is not None:
        raise DriverError(lacking.text)
    import rtde_control
    import rtde_receive

    return _UrArm(
        rtde_control.RTDEControlInterface(address),
        rtde_receive.RTDEReceiveInterface(address),
        socket.create_connection((address, _GRIPPER_PORT), _GRIPPER_WAIT_S),
    )


class _UrArm:
    """An arm as ur-rtde sees it, and the socket of its gripper's URCap."""

    def __init__(self, control: Any, receive: Any, gripper: socket.socket) -> None:  # noqa: ANN401
        self._control, self._receive, self._gripper = control, receive, gripper

    def joints(self) -> list[float]:
        if not self._receive.isConnected():
            raise RuntimeError("the connection is lost")
        if self._receive.isProtectiveStopped() or self._receive.isEmergencyStopped():
            raise RuntimeError("it is stopped for protection")
        return [float(q) for q in self._receive.getActualQ()]

    def servo(self, joints: list[float], tick_s: float) -> None:
        if not self._control.servoJ(joints, 0.0, 0.0, tick_s, _LOOKAHEAD_S, _GAIN):
            raise RuntimeError("it refuses the motion")

    def gripper(self) -> float:
        self._gripper.sendall(b"GET POS\n")
        answer = self._gripper.recv(64).decode("ascii", "replace").split()
        if len(answer) != 2 or answer[0] != "POS" or not answer[1].isdigit():
            raise RuntimeError(f"the gripper answers {' '.join(answer)!r}")
        return (int(answer[1]) - _OPEN) / (_CLOSED - _OPEN)

    def grip(self, closed: float) -> None:
        self._gripper.sendall(f"SET POS {round(_OPEN + closed * (_CLOSED - _OPEN))}\n".encode())
        self._gripper.recv(64)  # "ack"

    def stop(self) -> None:
        self._control.servoStop(_STOP_RAD_S2)

    def close(self) -> None:
        self._control.stopScript()
        self._control.disconnect()
        self._receive.disconnect()
        self._gripper.close()
