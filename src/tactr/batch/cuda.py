"""The solver for graphics processors: a library of its own beside the kernel, where it was built."""

from __future__ import annotations

import ctypes
import warnings
from pathlib import Path

from tactr import _core

NOT_BUILT = (
    "this installation was built without GPU code; build it where nvcc is: "
    "pip install . -C cmake.define.TACTR_CUDA=ON"
)


def cuda_door() -> int | None:
    """Where the kernel finds the GPU's solver; None with a warning that says what is missing."""
    library = _library()
    trouble = NOT_BUILT if library is None else _trouble(library)
    if library is None or trouble:
        warnings.warn(f"device 'cuda': solving on the CPU instead: {trouble}", RuntimeWarning, stacklevel=3)
        return None
    return ctypes.cast(library.tactr_lanes_cuda, ctypes.c_void_p).value


def _library() -> ctypes.CDLL | None:
    home = Path(_core.__file__ or "").parent
    for path in sorted(home.glob("*tactr_cuda.*")):
        try:
            return ctypes.CDLL(str(path))
        except OSError:
            continue
    return None


def _trouble(library: ctypes.CDLL) -> str:
    """What the GPU's driver says; empty where there is a GPU."""
    library.tactr_cuda_trouble.restype = ctypes.c_char_p
    return library.tactr_cuda_trouble().decode()
