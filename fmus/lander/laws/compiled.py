"""`jit`: one decorator for the hot laws, compiled by numba where numba is, plain Python where it is not.

The same file is both. No fastmath and no fused operations beyond what the processor's own rounding gives, so that the
two ways differ by the last bits of library functions (sin, exp) at most. Plain Python is asked for with
NUMBA_DISABLE_JIT=1 or LANDER_PLAIN_PYTHON=1; division by zero gives inf or nan when compiled (error_model "numpy").
"""

import contextlib
import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast, overload

Law = TypeVar("Law", bound=Callable[..., Any])


def wants_plain_python() -> bool:
    """True when the environment asks for laws that are not compiled."""
    return any(os.environ.get(name, "0") not in ("", "0") for name in ("LANDER_PLAIN_PYTHON", "NUMBA_DISABLE_JIT"))


try:
    if wants_plain_python():
        raise ImportError
    import numba
    from numba.core.registry import CPUDispatcher
    from numba.typed import List
except ImportError:
    COMPILED = False
else:
    COMPILED = True
    class InnerLaw(CPUDispatcher):  # type: ignore[misc]
        """A law without an entry from Python, where a call would end the process."""

        __slots__ = ()

        def __call__(self, *arguments: Any) -> Any:
            raise TypeError(f"{self.__name__} is for compiled laws alone; its py_func is plain Python")


Kept: Any = List if COMPILED else list
"""A list whose elements compiled code keeps as they are: what Python hands over is taken apart at every call."""


def forget_stale_code() -> None:
    """Delete the compiled code beside the sources if any law has changed since.

    numba renews a law's code when its own file changes, not when a law that it calls from another file does. An FMU's
    package lies in a folder named by its content, so that only a package under work needs this.
    """
    laws = Path(__file__).parent
    digest = hashlib.sha256()
    for file in sorted(laws.glob("*.py")):
        digest.update(file.name.encode() + file.read_bytes())
    stamp = laws / "__pycache__" / "laws.sha256"
    with contextlib.suppress(OSError):
        if stamp.exists() and stamp.read_text() == digest.hexdigest():
            return
        stamp.parent.mkdir(exist_ok=True)
        for code in laws.parent.rglob("*.nb[ci]"):
            code.unlink(missing_ok=True)
        stamp.write_text(digest.hexdigest())


if COMPILED and __name__ == "lander.laws.compiled":
    forget_stale_code()


@overload
def jit(law: Law) -> Law: ...
@overload
def jit(*, inline: bool = False, inner: bool = False) -> Callable[[Law], Law]: ...


def jit(law: Law | None = None, *, inline: bool = False, inner: bool = False) -> Any:
    """Compile a law (cached on disk between processes), or give it back as it is.

    `inline` pastes it into its callers: a call copies large tuples number by number, which took the twin a quarter of its time.
    `inner`: for compiled callers alone. An entry from Python takes every argument apart, a vehicle into hundreds of numbers, and is
    compiled with each law and again with each of its callers.
    """
    if law is None:
        return lambda it: jit_one(it, inline, inner)
    return jit_one(law, inline, inner)


def jit_one(law: Law, inline: bool, inner: bool) -> Law:
    """The law itself, or numba's dispatcher around it."""
    if not COMPILED:
        return law
    compiled = numba.njit(cache=True, error_model="numpy", forceinline=inline, no_cfunc_wrapper=True, no_cpython_wrapper=inner)(law)
    if inner:
        compiled.__class__ = InnerLaw
    return cast(Law, compiled)
