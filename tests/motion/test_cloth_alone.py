import numpy as np
import pytest

from planner import Scene, load_garment
from planner.folds.fold_sequence import FoldSequence
from planner.motion.cloth_surface import ClothAlone, ClothSurface, spread_cloth


def area_m2(cloth: ClothSurface) -> float:
    a, b, c = (cloth.vertices[cloth.triangles[:, corner]] for corner in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def test_a_garment_is_folded_by_nobody_from_spread_out_to_its_packet() -> None:
    garment, table = load_garment("t-shirt"), Scene().table
    alone = ClothAlone.of(FoldSequence.of(garment), table)
    start, done = alone.at(0.0)
    assert not done
    np.testing.assert_array_equal(start.vertices, spread_cloth(garment, table).vertices)
    count = len(garment.folds)
    standing, done = alone.at(1.5 / count)
    assert done == {0}
    assert standing.vertices[:, 2].max() > 0.05 > start.vertices[:, 2].max()
    packet, done = alone.at(1.0)
    assert done == set(range(count))
    assert packet.layers.max() + 1 == len(alone.sequence.final.layers)
    assert [area_m2(cloth) for cloth in (start, standing, packet)] == pytest.approx([garment.pattern.area] * 3)
