"""The names of folds that are proposed: each has words in every language, wherever `translated` meets it."""

import math
from collections.abc import Iterator

from planner import load_garment
from planner.cloth.cloth_state import ClothState
from planner.geometry.isometry import Isometry
from planner.proposals.moves import flap_moves, inward_moves, roll_moves, slanted_moves, turned_over
from tests.builders import rectangle
from tests.page.catalogues import CATALOGUES, ENGLISH
from tests.page.scripts import STATIC

SHARES = (0.2, 0.25, 0.4, 0.6)
"""Sides of targets as shares of a garment's: with tucks, in thirds, and with one side in."""

NOUNS = {"half", "third", "side", "flap", "roll"}

SIDEWAYS = ClothState.spread_out(load_garment("t-shirt").pattern.moved(Isometry.rotation(math.pi / 2)))
"""Its sleeves are its top and bottom flaps."""


def spread_out() -> Iterator[ClothState]:
    yield ClothState.spread_out(rectangle(0.6, 0.4))
    yield SIDEWAYS
    for file in sorted((STATIC.parent / "garments").glob("*.json")):
        yield ClothState.spread_out(load_garment(file).pattern)


def proposed_names(cloth: ClothState) -> Iterator[str]:
    silhouette = cloth.silhouette
    x0, y0, x1, y1 = silhouette.bounds
    sides = [share * extent for share in SHARES for extent in (x1 - x0, y1 - y0)]
    for moves in (inward_moves(silhouette.bounds, sides), flap_moves(silhouette), slanted_moves(silhouette)):
        yield from (crease.name for move in moves for crease in move.creases)
    yield from (crease.name for _, move in roll_moves(silhouette.bounds) for crease in move.creases)
    yield from (fold.name for _, fold in turned_over(cloth, 0.127))


def test_folds_that_are_proposed_have_names_in_every_language() -> None:
    names = {name for cloth in spread_out() for name in proposed_names(cloth)}
    parts = {f"{part} {noun}" for part in ("left", "right", "bottom", "top") for noun in NOUNS}
    assert names == parts | {f"{name} back" for name in parts if name.endswith(" side")} | {"flap", "edge", "turn over"}
    keys = {str(text): key for key, text in ENGLISH.items() if key.startswith("name.")}
    assert names - set(keys) == set()
    for code, texts in CATALOGUES.items():
        said = {name: str(texts[keys[name]]) for name in names}
        assert code == "en" or all(said[name] != name for name in names), code
        assert len(set(said.values())) == len(names), code
