"""Licences of what is installed."""

from email.message import Message
from importlib.metadata import Distribution
from types import SimpleNamespace
from typing import cast

import pytest

from tests.licences import REASONS, is_known, unexplained


def package(name: str, field: str = "", value: str = "") -> Distribution:
    """Return a package with this metadata."""
    metadata = Message()
    metadata["Name"] = name
    if field:
        metadata[field] = value
    return cast(Distribution, SimpleNamespace(metadata=metadata, version="1"))


@pytest.mark.parametrize(
    ("licence", "known"),
    [("MIT", True), ("GPL-3.0-only OR MIT", True), ("MIT AND GPL-3.0-only", False), ("", False), ("Secret", False)],
)
def test_a_licence_is_known_if_all_that_it_asks_is(licence: str, known: bool) -> None:
    assert is_known(licence) is known


def test_a_package_of_an_unknown_licence_needs_a_reason() -> None:
    packages = [package("good", "License-Expression", "MIT"), package("bad", "License", "Secret")]
    assert unexplained([*packages, package(next(iter(REASONS)))]) == ["bad"]
