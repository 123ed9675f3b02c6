"""Calls of an object's method by what the object itself holds, without a reference cycle.

What is in a cycle stays until the garbage collector looks at old objects, which is rare: a search leaves some thousand
objects, and a server that plans while people draw would keep minutes' worth of them.
"""

from collections.abc import Callable
from typing import ParamSpec, TypeVar
from weakref import WeakMethod

P = ParamSpec("P")
T = TypeVar("T")


def weakly(method: Callable[P, T]) -> Callable[P, T]:
    """Return a function that calls a bound method while its object lives."""
    reference = WeakMethod(method)

    def call(*arguments: P.args, **options: P.kwargs) -> T:
        found = reference()
        assert found is not None, "the object has gone before those that it made"
        return found(*arguments, **options)

    return call
