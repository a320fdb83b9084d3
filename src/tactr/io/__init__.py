"""Robot files in YAML and TOML, units, and results in netCDF; nothing heavy is imported before it is used."""

from tactr.io.file_error import RobotFileError
from tactr.io.files import dumps, load, loads, save

__all__ = ["RobotFileError", "dumps", "load", "loads", "save"]
