"""Compile functions to machine code with Numba, kept on disk (`planner.kernel_cache`) and run without Python's lock.

Numba compiles a function once for each literal number that another kernel passes it, besides once for any number. That
costs a quarter of all compiling and gains nothing, so here a literal counts as a number.
"""

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar, cast

from numba import njit, types

_FAST = {"error_model": "numpy", "fastmath": {"contract", "nsz", "arcp"}}
"""Options for arithmetic that may be rearranged within rounding, and divides by zero without an error."""


Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(**options: Any) -> Callable[[Function], Function]:  # noqa: ANN401
    """Return a decorator that compiles a function when it is first called, with further options of `numba.njit`."""

    def compiled_with(function: Function) -> Function:
        found: Any = njit(cache=True, nogil=True, **options)(function)
        if not hasattr(found, "get_call_template"):  # Numba is told not to compile (NUMBA_DISABLE_JIT)
            return function
        exact, number = found.get_call_template, cast(Any, types.unliteral)

        @wraps(exact)
        def general(arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:  # noqa: ANN401
            return exact(tuple(map(number, arguments)), {name: number(value) for name, value in named.items()})

        found.get_call_template = general
        return cast(Function, found)

    return compiled_with


kernel = compiled()
fast_kernel = compiled(**_FAST)
inlined = compiled(inline="always")
fast_inlined = compiled(inline="always", **_FAST)
