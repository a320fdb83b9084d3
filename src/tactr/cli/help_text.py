"""What --help prints, ready made: building it from the commands takes longer than seeing it should."""

HELP = """\
tactr: the shape of tendon-actuated concentric tube robots

Usage: tactr COMMAND [ARGUMENTS]

  solve [FILE]       compute the shape of a robot and report it
  drive FILE PATH.csv
                     follow a path of actuation with friction and backlash
  view [FILE]        show a robot in the browser, where everything can be moved
  calibrate FILE DATA.csv
                     find a robot's numbers from measured points
  sweep STUDY.yaml   solve many configurations into a store, on all cores or a cluster
  check FILE...      check robot and study files without solving
  schema [study]     print the JSON Schema of robot or study files, for editors
  examples [NAME]    list the built-in example robots, or print one
  reproduce          solve every experiment of the paper and write a report

  COMMAND --help     all options of a command
  --version          the version of tactr

FILE is a robot file (.yaml, .toml) or the name of a built-in example; without it, solve and view take
two_tube_90.

  tactr solve --tension outer=3 inner=2 --plot shape.png
  tactr solve my_robot.yaml --rotation inner="90 deg" --save shape.nc
  tactr view my_robot.yaml
  tactr examples two_tube_90 > my_robot.yaml

Exit codes: 0 done; 2 something is wrong with the input, or no equilibrium was found (the message says which
and what to do).
"""

SOLVE = """\
tactr solve: compute the shape of a robot and report it

Usage: tactr solve [FILE] [OPTIONS]

  FILE                     a robot file (.yaml, .toml) or the name of a built-in example; default two_tube_90

  --tension NAME=VALUE...  tensions of tendons: outer=3 inner="2.5 N" (a bare number is in newtons)
  --rotation NAME=VALUE... rotations of tubes at their proximal ends, with unit: inner="90 deg"
  --translation NAME=VALUE...
                           positions of their proximal ends, with unit, at most 0: inner="-20 mm"
  --displacement NAME=VALUE...
                           what the motors of tendons pull instead of tensions, with unit: left="2 mm"
                           Each may also be given without names: one value for every tendon or tube, in order.
  --force TUBE="x, y, z"... forces at the tips of tubes, in world axes, beside the file's loads:
                           inner="0.1 N, 0, 0" (a bare number is in newtons)
  --moment TUBE="x, y, z"... moments there: inner="0, 5 N mm, 0" (a bare number is in N m)
  --tolerance LENGTH       largest discretisation error at the tip, with unit; default "1 um"

  --json                   print the result as JSON instead of a report
  --save FILE.nc           write the whole shape to a netCDF file
  --plot FILE.png          draw the shape (.png, .pdf, .svg)

Exit code 2: something is wrong with the input, or no equilibrium was found.
"""

DRIVE = """\
tactr drive: follow a path of actuation with friction and backlash

Usage: tactr drive FILE PATH.csv [OPTIONS]

  FILE                   a robot file (.yaml, .toml) or the name of a built-in example
  PATH.csv               a row for every point; columns "tension.outer [N]", "displacement.left [mm]",
                         "rotation.inner [deg]", "translation.inner [mm]"; linear in between. What has no
                         column stays as the robot has it

  --state FILE.json      what the robot remembers at the start; default: at rest
  --tolerance LENGTH     largest discretisation error at the tip, with unit; default "1 um"

  --save FILE.nc         write tips, shapes, tensions and states to a netCDF file
  --save-state FILE.json write what the robot remembers at the end, for --state
  --plot FILE.png        draw the loop and what friction changes (.png, .pdf, .svg)

Exit code 2: something is wrong with the input, or a point was not reached; those before it are written.
Model and assumptions: docs/friction.md, docs/tube_friction.md.
"""

CALIBRATE = """\
tactr calibrate: find a robot's numbers from measured tips or shapes, and say how well the data tell them

Usage: tactr calibrate FILE DATA.csv --free PATH... [OPTIONS]

  FILE                     a robot file (.yaml, .toml) or the name of a built-in example
  DATA.csv                 a row for each pose; columns such as "displacement.left [mm]", "tension.outer [N]",
                           "rotation.inner [deg]", "tip.x [mm]" (and y, z), "at 120 mm.x [mm]", "group"

  --free PATH...           what is free: tubes.outer.E "tendons.*.compliance" tendons.left.zero (what its
                           motor has pulled at a reading of 0) marker.z (from the tip) sensor.x sensor.rx
                           (the robot in the sensor's axes, and its turn); * stands for any name, one number
                           for each
  --common PATH...         the same, one number for all that fit
  --set PATH=VALUE...      where a number starts, free or not: marker.z="8 mm"
  --bounds PATH="LOW, HIGH"...
                           bounds of a free number, with unit: tubes.outer.E="40 GPa, 80 GPa"
  --prior PATH="MEAN, DEVIATION"...
                           what is known of it beforehand
  --columns FILE.yaml      for files with other columns: a mapping such as  tip.x: marker_x [mm]
  --noise LENGTH           standard deviation of a measured coordinate; default: from the residuals
  --loss NAME              linear (least squares), or huber, soft_l1, cauchy for data with outliers
  --starts N               starts of the search, for problems that are not convex; default 1
  --folds N                predict each of N blocks of rows from the others, or "group": each group
  --history                rows are one path in time, from rest, with friction and backlash: to find
                           tendons.left.friction, tendons.left.play

  --json                   print the result as JSON instead of a report
  --save FILE.yaml         write the calibrated robot
  --plot FILE.png          draw the residuals (.png, .pdf, .svg)

Without --free and --common the robot is judged as it is. Exit code 2: something is wrong with the input.
"""

VIEW = """\
tactr view: show a robot in the browser, where everything can be moved

Usage: tactr view [FILE] [OPTIONS]

  FILE           a robot file (.yaml, .toml) or the name of a built-in example; default two_tube_90;
                 or results of tactr sweep (.zarr): the robot amid the cloud of its tips

  --port NUMBER  where to serve the page; default: the first free port from 8080 on
  --headless     do not open a browser: only say where the page is

The page is served on this machine only (127.0.0.1) and asks no other for anything. Closing it ends the
command, as does Ctrl-C. Needs the extra view: pip install 'tactr[view]'
"""

CHECK = """\
tactr check: check robot and study files without solving; every problem is listed with its line

Usage: tactr check FILES...

  FILES   robot or study files (.yaml, .toml), or names of built-in examples

What a file marks as assumed is listed too. Exit code 2: a file cannot be used.
"""

SWEEP = """\
tactr sweep: solve all configurations of a study into a store, or look at the results

Usage: tactr sweep STUDY.yaml [OPTIONS]
       tactr sweep RESULTS.zarr [OPTIONS]

  STUDY.yaml        a study file: a robot, what varies, how it is sampled (docs/sweep.md; tactr schema study)
  RESULTS.zarr      results that are there: only the summary

  --out FILE.zarr   where the results go; default: the study file's name, here. Results of the same study that
                    are there are gone on with: a run that was stopped, at any moment, loses nothing
  --threads N       threads of this process; default: as many as there are cores
  --workers N       or processes on this machine (extra: cluster)
  --cluster ADDRESS or a dask cluster, by its scheduler: tcp://10.0.0.1:8786 (extra: cluster)

  --voxel LENGTH    edge of the cubes by which the reachable volume is counted; default: by the samples
  --plot FILE.png   draw the tips: projections, slices, histograms (.png, .pdf, .svg)
  --colour NAME     what colours them: z, stability_margin, manipulability, tubes.inner.rotation ...
  --json            print the summary as JSON

Needs the extra: sweep. Ctrl-C stops; the same command goes on. To walk through the results in the browser:
tactr view RESULTS.zarr. Exit code 2: something is wrong with the input.
"""

SCHEMA = """\
tactr schema: print the JSON Schema of robot or study files, with which editors complete and check them

Usage: tactr schema [KIND] > robot.schema.json

  KIND   robot (the default) or study

The first line of a YAML file may then be: # yaml-language-server: $schema=robot.schema.json
"""

EXAMPLES = """\
tactr examples: list the built-in example robots, or print one as a start for your own file

Usage: tactr examples [NAME]

  tactr examples two_tube_90 > my_robot.yaml
"""

REPRODUCE = """\
tactr reproduce: solve every experiment of the paper and write a report

Usage: tactr reproduce [OPTIONS]

  --out FOLDER   where report.html and report.md go; made if it is missing; default reproduction

The report shows the model's shapes, what was assumed and how much that matters, and which of the paper's
statements can be checked without its measurements. Needs the extra: plot.

Exit code 2: the report cannot be written, or matplotlib is missing.
"""

COMMANDS = {
    "solve": SOLVE,
    "drive": DRIVE,
    "view": VIEW,
    "calibrate": CALIBRATE,
    "sweep": SWEEP,
    "check": CHECK,
    "schema": SCHEMA,
    "examples": EXAMPLES,
    "reproduce": REPRODUCE,
}
