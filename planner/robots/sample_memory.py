"""A memory of the samples of joints at tool poses: searches ask for the same poses again and again."""

from collections import OrderedDict
from collections.abc import Callable
from threading import Lock

import numpy as np

from planner.geometry.pose import FloatArray

_POSES_KEPT = 4096
"""Poses whose samples are kept, those asked last: some ten MB."""

_Key = tuple[bytes, bytes, float]
_Samples = tuple[FloatArray, FloatArray]

Sampled = Callable[[FloatArray, FloatArray, float], _Samples]
"""The samples at poses: from points (k, 3), rotations (k, 3, 3) and the floor, joints (k, m, n) and costs (k, m).

A pose's samples do not depend on the other poses; its costs are infinite after its last sample.
"""


class SampleMemory:
    """The samples of the poses asked last. May be shared between threads."""

    def __init__(self, sampled: Sampled) -> None:
        """Take what samples poses, and start with nothing known."""
        self._sampled = sampled
        self._known: OrderedDict[_Key, _Samples] = OrderedDict()
        self._lock = Lock()

    def forget(self) -> None:
        """Drop all samples, so that benchmarks measure their computation."""
        with self._lock:
            self._known.clear()

    def samples(self, points: FloatArray, rotations: FloatArray, floor: float) -> _Samples:
        """Return what the sampling function does, which is asked only for the poses that are not known."""
        keys = [(point.tobytes(), rotation.tobytes(), floor) for point, rotation in zip(points, rotations, strict=True)]
        with self._lock:
            found = {key: self._known[key] for key in keys if key in self._known}
        new = {key: number for number, key in enumerate(keys) if key not in found}
        if new:
            numbers = list(new.values())
            joints, costs = self._sampled(points[numbers], rotations[numbers], floor)
            taken = np.isfinite(costs).sum(axis=1)
            own = zip(new, joints, costs, taken, strict=True)
            found |= {key: (some[:count].copy(), each[:count].copy()) for key, some, each, count in own}
        self._keep(found)
        return _together([found[key] for key in keys])

    def _keep(self, found: dict[_Key, _Samples]) -> None:
        with self._lock:
            self._known |= found
            for key in found:
                self._known.move_to_end(key)
            while len(self._known) > _POSES_KEPT:
                self._known.popitem(last=False)


def _together(each: list[_Samples]) -> _Samples:
    most = max([1, *(len(costs) for _, costs in each)])
    joints, costs = np.zeros((len(each), most, each[0][0].shape[1])), np.full((len(each), most), np.inf)
    for number, (some, own) in enumerate(each):
        joints[number, : len(own)], costs[number, : len(own)] = some, own
    return joints, costs
