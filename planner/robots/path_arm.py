"""The protocol for what the searches for joint paths ask of an arm."""

from typing import Protocol

from planner.geometry.pose import BoolArray, FloatArray


class PathArm(Protocol):
    """An arm whose tool is to follow a path.

    Joints are in rad (m where they slide). Poses are of the tool, in the base frame (m), in arrays of positions, shape
    (n, 3), and rotations, shape (n, 3, 3). An arm that cannot take whole poses takes what it can of them.
    """

    @property
    def periods(self) -> FloatArray:
        """A whole turn for each joint that a chain of samples may wind up, 0 for the others (rad), shape (joints,)."""
        ...

    @property
    def stride(self) -> int:
        """Poses of a path, a centimetre apart, from one link of a chain to the next: fewer for a small arm."""
        ...

    def samples(
        self, positions: FloatArray, rotations: FloatArray, torso_m: float, floor_m: float
    ) -> tuple[FloatArray, FloatArray]:
        """Return samples of the joints that bring the tool to each pose.

        Args:
            positions: the poses' positions.
            rotations: the poses' rotations.
            torso_m: how far the lift is raised (m).
            floor_m: the height over which elbows should preferably stay, base frame (m).

        Returns:
            The joints, shape (n, m, joints), and the samples' costs, shape (n, m): infinite where there is no sample.
        """
        ...

    def along(
        self, positions: FloatArray, rotations: FloatArray, torso_m: float, guides: FloatArray
    ) -> tuple[FloatArray, BoolArray]:
        """Return the joints near to guides, shape (n, joints), that bring the tool to each pose, and if there are any.

        Joints that turn without end come unwound.
        """
        ...

    def unwound(self, chain: FloatArray) -> FloatArray:
        """Return a chain of samples, shape (n, joints), with the joints that have periods wound up; a new array."""
        ...

    def tool_places(self, joints: FloatArray, torso_m: float) -> FloatArray:
        """Return the tool's positions for rows of joints, shape (n, joints) -> (n, 3), m."""
        ...
