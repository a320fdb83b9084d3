"""What --help prints, ready made: building it from the commands takes longer than seeing it should."""

HELP = """\
tactr: the shape of tendon-actuated concentric tube robots

Usage: tactr COMMAND [ARGUMENTS]

  solve [FILE]       compute the shape of a robot and report it
  view [FILE]        show a robot in the browser, where everything can be moved
  check FILE...      check robot files without solving
  schema             print the JSON Schema of robot files, for editors
  examples [NAME]    list the built-in example robots, or print one

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

VIEW = """\
tactr view: show a robot in the browser, where everything can be moved

Usage: tactr view [FILE] [OPTIONS]

  FILE           a robot file (.yaml, .toml) or the name of a built-in example; default two_tube_90

  --port NUMBER  where to serve the page; default: the first free port from 8080 on
  --headless     do not open a browser: only say where the page is

The page is served on this machine only (127.0.0.1) and asks no other for anything. Closing it ends the
command, as does Ctrl-C. Needs the extra view: pip install 'tactr[view]'
"""

CHECK = """\
tactr check: check robot files without solving; every problem is listed with its line

Usage: tactr check FILES...

  FILES   robot files (.yaml, .toml) or names of built-in examples

What a file marks as assumed is listed too. Exit code 2: a file cannot be used.
"""

SCHEMA = """\
tactr schema: print the JSON Schema of robot files, with which editors complete and check them

Usage: tactr schema > robot.schema.json

The first line of a YAML file may then be: # yaml-language-server: $schema=robot.schema.json
"""

EXAMPLES = """\
tactr examples: list the built-in example robots, or print one as a start for your own file

Usage: tactr examples [NAME]

  tactr examples two_tube_90 > my_robot.yaml
"""

COMMANDS = {"solve": SOLVE, "view": VIEW, "check": CHECK, "schema": SCHEMA, "examples": EXAMPLES}
