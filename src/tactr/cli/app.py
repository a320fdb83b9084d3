"""The commands; their modules are imported when they run, and their help is in help_text.py."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import App, Parameter

from tactr import __version__

DEFAULT_EXAMPLE = "two_tube_90"
DEFAULT_REPORT = "reproduction"


app = App(name="tactr", version=__version__, help_flags=[], default_parameter=Parameter(negative=()))

Assignments = Annotated[list[str], Parameter(consume_multiple=(1, None))]


@app.command
def solve(
    file: str = DEFAULT_EXAMPLE,
    /,
    *,
    tension: Assignments = [],  # noqa: B006
    rotation: Assignments = [],  # noqa: B006
    translation: Assignments = [],  # noqa: B006
    displacement: Assignments = [],  # noqa: B006
    force: Assignments = [],  # noqa: B006
    moment: Assignments = [],  # noqa: B006
    tolerance: str | None = None,
    json: bool = False,
    save: Path | None = None,
    plot: Path | None = None,
) -> int:
    """Compute the shape of a robot and report it."""
    from tactr.cli.solve import Request, run_solve

    return run_solve(
        Request(
            file,
            tension=tension,
            rotation=rotation,
            translation=translation,
            displacement=displacement,
            force=force,
            moment=moment,
            tolerance=tolerance,
            json=json,
            save=save,
            plot=plot,
        )
    )


@app.command
def drive(
    file: str,
    path: Path,
    /,
    *,
    tolerance: str | None = None,
    state: Path | None = None,
    save: Path | None = None,
    save_state: Path | None = None,
    plot: Path | None = None,
) -> int:
    """Follow a path of actuation with friction and backlash."""
    from tactr.cli.drive import Request, run_drive

    return run_drive(Request(file, path, tolerance, state, save, save_state, plot))


@app.command
def calibrate(
    file: str,
    data: Path,
    /,
    *,
    free: Assignments = [],  # noqa: B006
    common: Assignments = [],  # noqa: B006
    set: Assignments = [],  # noqa: B006
    bounds: Assignments = [],  # noqa: B006
    prior: Assignments = [],  # noqa: B006
    columns: Path | None = None,
    noise: str | None = None,
    loss: str = "linear",
    starts: int = 1,
    folds: str | None = None,
    history: bool = False,
    json: bool = False,
    save: Path | None = None,
    plot: Path | None = None,
) -> int:
    """Calibrate a robot from measured points."""
    from tactr.cli.calibrate import Request, run_calibrate

    return run_calibrate(
        Request(
            file,
            data,
            free=free,
            common=common,
            set=set,
            bounds=bounds,
            prior=prior,
            columns=columns,
            noise=noise,
            loss=loss,
            starts=starts,
            folds=folds,
            history=history,
            json=json,
            save=save,
            plot=plot,
        )
    )


@app.command
def check(files: list[str], /) -> int:
    """Check robot files without solving; every problem is listed with its line."""
    from tactr.cli.check import run_check

    return run_check(files)


@app.command
def sweep(
    file: Path,
    /,
    *,
    out: Path | None = None,
    threads: int | None = None,
    workers: int | None = None,
    cluster: str | None = None,
    voxel: str | None = None,
    colour: str = "z",
    json: bool = False,
    plot: Path | None = None,
) -> int:
    """Solve all configurations of a study, or look at the results."""
    from tactr.cli.sweep import Request, run_sweep

    return run_sweep(
        Request(
            file,
            out=out,
            threads=threads,
            workers=workers,
            cluster=cluster,
            voxel=voxel,
            colour=colour,
            json=json,
            plot=plot,
        )
    )


@app.command
def schema(kind: Literal["robot", "study"] = "robot", /) -> int:
    """Print the JSON Schema of robot or study files, with which editors complete and check them."""
    import json

    if kind == "study":
        from tactr.studies.layout import json_schema
    else:
        from tactr.io.layout import json_schema

    print(json.dumps(json_schema(), indent=2, ensure_ascii=False))
    return 0


@app.command
def view(file: str = DEFAULT_EXAMPLE, /, *, port: int | None = None, headless: bool = False) -> int:
    """Show a robot in the browser, where everything can be moved."""
    from tactr.cli.view import run_view

    return run_view(file, port=port, browser=not headless)


@app.command
def examples(name: str | None = None, /) -> int:
    """List the built-in example robots, or print one."""
    from tactr.cli.examples import run_examples

    return run_examples(name)


@app.command
def reproduce(*, out: Path = Path(DEFAULT_REPORT)) -> int:
    """Solve every experiment of the paper and write a report."""
    from tactr.cli.reproduce import run_reproduce

    return run_reproduce(out)
