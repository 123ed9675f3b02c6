"""A robot under ROS 2 through rosbridge: each motion is a FollowJointTrajectory goal for each controller.

The controllers are named as in the exports; where the joints are is read from /joint_states.
"""

import json
import queue
import threading
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np

from app.drivers.driver import FINGERS_S, DriverError, Joints, LostError, RealClock, Seen
from app.files.joint_motion import JointMotion, controller_name, controllers
from planner.robots.card import RobotCard

ADDRESS = "ws://localhost:9090"
"""Where rosbridge listens by default."""

_ACTION = "control_msgs/action/FollowJointTrajectory"
_WAIT_S = 5.0
"""How long an answer is waited for beyond the time that a motion takes (s)."""

_LOOK_S = 0.1
_SUCCEEDED = 4
"""The status of a goal that was reached."""


class RosbridgeDriver:
    """A robot whose controllers are asked over a websocket."""

    def __init__(self, card: RobotCard, address: str = ADDRESS) -> None:
        """Take the robot's card and the websocket's address.

        Raises:
            DriverError: the robot drives.
        """
        if not card.is_fixed:
            raise DriverError(f"ros2 sends no base anywhere, and that of {card.title} drives; export the plan instead")
        self._parts = {
            f"/{controller_name(name)}/follow_joint_trajectory": joints for name, joints in controllers(card)
        }
        self._address, self._clock = address, RealClock()
        self._socket: Any = None
        self._state: dict[str, float] = {}
        self._results: queue.Queue[Mapping[str, Any]] = queue.Queue()
        self._has_state, self._is_lost = threading.Event(), threading.Event()
        self._pending: dict[str, str] = {}
        self._count = 0

    def connect(self) -> None:
        """Connect, and wait for where all joints are."""
        from websockets.exceptions import WebSocketException
        from websockets.sync.client import connect

        try:
            self._socket = connect(self._address, open_timeout=_WAIT_S, max_size=None)
        except (OSError, TimeoutError, WebSocketException, ValueError) as error:
            raise DriverError(f"rosbridge is not at {self._address}: {error}") from None
        threading.Thread(target=self._listen, daemon=True).start()
        self._say({"op": "subscribe", "topic": "/joint_states", "type": "sensor_msgs/msg/JointState"})
        if not self._has_state.wait(_WAIT_S):
            missing = [name for joints in self._parts.values() for name in joints if name not in self._state]
            raise LostError(f"/joint_states has no {', '.join(missing)}")

    def read(self) -> Joints:
        """Return the joints as they came last."""
        if self._is_lost.is_set():
            raise LostError("the connection to rosbridge is lost")
        return dict(self._state)

    def send(self, motion: JointMotion, seen: Seen) -> None:
        """Send a goal to each controller of which the motion has the joints, and wait for all results."""
        while not self._results.empty():  # of goals that were stopped
            self._results.get_nowait()
        for action, joints in self._parts.items():
            if all(name in motion.names for name in joints):
                self._count += 1
                goal = f"pleat-{self._count}"
                self._pending[goal] = action
                args = {"trajectory": _trajectory(motion.of_joints(joints))}
                self._say(
                    {
                        "op": "send_action_goal",
                        "id": goal,
                        "action": action,
                        "action_type": _ACTION,
                        "args": args,
                        "feedback": True,
                    }
                )
        start_s = self._clock.now_s()
        while self._pending:
            t_s = self._clock.now_s() - start_s
            if t_s > motion.duration_s + _WAIT_S:
                raise LostError(f"no result of {', '.join(self._pending.values())}")
            with suppress(queue.Empty):
                self._take(self._results.get(timeout=_LOOK_S))
            seen(min(t_s, motion.duration_s), self.read())

    def grip(self, fingers: Joints) -> None:
        """Send the fingers somewhere, and wait until they are there."""
        names = tuple(fingers)
        here = self.read()
        positions = np.array([[here[name] for name in names], [fingers[name] for name in names]])
        none = np.zeros_like(positions)
        motion = JointMotion(names, np.array([0.0, FINGERS_S]), positions, none, none)
        self.send(motion, lambda _t_s, _joints: None)

    def stop(self) -> None:
        """Cancel all goals: their controllers hold where they are."""
        for goal, action in self._pending.items():
            with suppress(LostError):
                self._say({"op": "cancel_action_goal", "id": goal, "action": action})
        self._pending.clear()

    def close(self) -> None:
        """Disconnect."""
        if self._socket is not None:
            self._socket.close()

    def _take(self, result: Mapping[str, Any]) -> None:
        action = self._pending.pop(str(result.get("id")), None)
        if action is None:
            return
        values = result.get("values")
        answer = values if isinstance(values, dict) else {"error_string": values}
        if result.get("result") is not True or result.get("status") != _SUCCEEDED or answer.get("error_code", 0) != 0:
            why = answer.get("error_string") or f"status {result.get('status')}, error {answer.get('error_code')}"
            raise LostError(f"{action} refuses or fails: {why}")

    def _say(self, message: Mapping[str, Any]) -> None:
        from websockets.exceptions import ConnectionClosed

        try:
            self._socket.send(json.dumps(message))
        except (OSError, ConnectionClosed):
            raise LostError("the connection to rosbridge is lost") from None

    def _listen(self) -> None:
        from websockets.exceptions import ConnectionClosed

        wanted = {name for joints in self._parts.values() for name in joints}
        try:
            for text in self._socket:
                message = json.loads(text)
                if message.get("op") == "publish" and message.get("topic") == "/joint_states":
                    joints = message["msg"]
                    self._state = {**self._state, **dict(zip(joints["name"], joints["position"], strict=False))}
                    if wanted <= self._state.keys():
                        self._has_state.set()
                elif message.get("op") == "action_result":
                    self._results.put(message)
        except (OSError, ConnectionClosed, ValueError, KeyError, TypeError):
            pass
        self._is_lost.set()


def _trajectory(motion: JointMotion) -> dict[str, Any]:
    """Return a motion as a JointTrajectory in JSON: stamp 0, to begin at once."""
    orders = (motion.positions.tolist(), motion.velocities.tolist(), motion.accelerations.tolist())
    points = [
        {
            "positions": positions,
            "velocities": velocities,
            "accelerations": accelerations,
            "effort": [],
            "time_from_start": dict(zip(("sec", "nanosec"), divmod(round(t_s * 1e9), 1_000_000_000), strict=True)),
        }
        for t_s, positions, velocities, accelerations in zip(motion.times_s.tolist(), *orders, strict=True)
    ]
    header = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    return {"header": header, "joint_names": list(motion.names), "points": points}
