"""A stand-in for rosbridge before controllers of ros2_control, with the rules of `joint_trajectory_controller`.

A goal is refused as that controller refuses it: for the wrong joints, points whose times do not grow, numbers that are
missing, speeds at the end that are not 0, a stamp whose trajectory is past. It is aborted where the joints are not
where it begins, and where limits would be broken.
"""

import json
import threading
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

from websockets.exceptions import ConnectionClosed
from websockets.sync.server import Server, ServerConnection, serve

from planner.robots.card import RobotCard

START_TOLERANCE = 0.05
SPEED_OVER, LIMIT_OVER = 1.001, 1e-6


class JointTrajectoryControllers:
    """One for each arm and gripper of a robot; a context manager.

    Attributes:
        joints: where all joints are.
        limits: the lowest and highest value and the top speed of each joint.
        goals: the goals that were reached, as they came.
        refused: why goals were refused.
        cancelled: the ids of goals that were cancelled.
        holds: whether goals are accepted and never reached.
        drops: whether the connection is cut at the next goal.
    """

    def __init__(self, card: RobotCard) -> None:
        self.joints = {name: q for arm in card.arms for name, q in zip(arm.joint_names, arm.home, strict=True)}
        self.joints |= {arm.gripper.joint_name: arm.gripper.angle(0.0) for arm in card.arms}
        self._parts: dict[str, tuple[str, ...]] = {}
        self.limits: dict[str, tuple[float, float, float]] = {}
        for arm in card.arms:
            self._parts[f"/{arm.name}_arm_controller/follow_joint_trajectory"] = arm.joint_names
            self._parts[f"/{arm.name}_gripper_controller/follow_joint_trajectory"] = (arm.gripper.joint_name,)
            for name, (low, high), speed in zip(arm.joint_names, arm.limits, arm.speeds_rad_s, strict=True):
                self.limits[name] = (low, high, speed)
            ends = [arm.gripper.angle(opening) for opening in (0.0, arm.gripper.opening_max_m)]
            self.limits[arm.gripper.joint_name] = (min(ends), max(ends), arm.gripper.speed)
        self.goals: list[Mapping[str, Any]] = []
        self.refused: list[str] = []
        self.cancelled: list[str] = []
        self.holds = self.drops = False
        self.accepted = threading.Event()
        self._server: Server | None = None

    def __enter__(self) -> "JointTrajectoryControllers":
        self._server = serve(self._talk, "127.0.0.1", 0)
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        assert self._server is not None
        self._server.shutdown()

    @property
    def address(self) -> str:
        assert self._server is not None
        return f"ws://127.0.0.1:{self._server.socket.getsockname()[1]}"

    def _talk(self, socket: ServerConnection) -> None:
        try:
            for text in socket:
                message = json.loads(text)
                match message["op"]:
                    case "subscribe":
                        assert message["topic"] == "/joint_states"
                        self._tell(socket)
                    case "send_action_goal":
                        if self.drops:
                            socket.close()
                            return
                        self._goal(socket, message)
                    case "cancel_action_goal":
                        self.cancelled.append(message["id"])
        except ConnectionClosed:
            return

    def _tell(self, socket: ServerConnection) -> None:
        told = {"name": list(self.joints), "position": list(self.joints.values()), "velocity": [], "effort": []}
        socket.send(json.dumps({"op": "publish", "topic": "/joint_states", "msg": told}))

    def _goal(self, socket: ServerConnection, message: Mapping[str, Any]) -> None:
        trajectory = message["args"]["trajectory"]
        answer = {"op": "action_result", "id": message["id"], "action": message["action"]}
        if (why := self._why_invalid(message, trajectory)) is not None:
            self.refused.append(why)  # a goal that is rejected has no result: the bridge tells of an exception
            socket.send(json.dumps({**answer, "values": why, "status": 0, "result": False}))
        elif (why := self._why_aborted(trajectory)) is not None:
            self.refused.append(why)
            values: Mapping[str, Any] = {"error_code": -4, "error_string": why}
            socket.send(json.dumps({**answer, "values": values, "status": 6, "result": True}))
        elif self.holds:
            self.accepted.set()
        else:
            last = trajectory["points"][-1]["positions"]
            self.joints |= dict(zip(trajectory["joint_names"], last, strict=True))
            self.goals.append(message)
            self._tell(socket)
            values = {"error_code": 0, "error_string": ""}
            socket.send(json.dumps({**answer, "values": values, "status": 4, "result": True}))

    def _why_invalid(self, message: Mapping[str, Any], trajectory: Mapping[str, Any]) -> str | None:
        names, points = trajectory["joint_names"], trajectory["points"]
        if message["action_type"] != "control_msgs/action/FollowJointTrajectory":
            return "another action"
        if sorted(names) != sorted(self._parts[message["action"]]):
            return "joints are not those of the controller"
        if trajectory["header"]["stamp"] != {"sec": 0, "nanosec": 0}:
            return "the trajectory is in the past"
        if not points:
            return "there are no points"
        times = [point["time_from_start"]["sec"] + 1e-9 * point["time_from_start"]["nanosec"] for point in points]
        if any(later <= sooner for sooner, later in pairwise(times)):
            return "times do not grow"
        for point in points:
            if any(len(point[key]) != len(names) for key in ("positions", "velocities", "accelerations")):
                return "numbers are missing"
            if point["effort"]:
                return "efforts are not allowed"
        if any(speed != 0.0 for speed in points[-1]["velocities"]):
            return "the speed at the end is not 0"
        return None

    def _why_aborted(self, trajectory: Mapping[str, Any]) -> str | None:
        points = trajectory["points"]
        for column, name in enumerate(trajectory["joint_names"]):
            if abs(points[0]["positions"][column] - self.joints[name]) > START_TOLERANCE:
                return f"{name} is not at the start"
            low, high, speed = self.limits[name]
            for point in points:
                if not low - LIMIT_OVER <= point["positions"][column] <= high + LIMIT_OVER:
                    return f"{name} would leave its limits"
                if abs(point["velocities"][column]) > SPEED_OVER * speed:
                    return f"{name} is too fast"
        return None
