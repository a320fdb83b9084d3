"""Runs a command and turns errors into messages and exit codes."""

from __future__ import annotations

import os
import sys

from cyclopts import CycloptsError

from tactr.cli.app import app
from tactr.errors import TactrError


def run(tokens: list[str]) -> int:
    """Run the command line `tokens`; messages go to stderr. Returns the exit code."""
    # Small matrices gain nothing from threads, and starting them takes a good part of NumPy's import time.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        code = app(tokens, exit_on_error=False, print_error=False, result_action="return_value")
        sys.stdout.flush()
        return code if isinstance(code, int) else 0
    except (CycloptsError, TactrError) as error:
        return _fail(str(error))
    except BrokenPipeError:  # the reader, such as `head`, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except KeyboardInterrupt:
        return _fail("interrupted", 130)


def _fail(message: str, code: int = 2) -> int:
    print(f"tactr: {message}" if "\n" not in message else f"tactr:\n{message}", file=sys.stderr)
    return code
