"""Studies of many configurations: what varies, samples, the store of results, and what it says."""

from tactr.studies.axes import Range, Samples, Values
from tactr.studies.insertion import InsertionOrder
from tactr.studies.read_study import load_study
from tactr.studies.result import Sweep
from tactr.studies.study import Study
from tactr.studies.summary import Summary
from tactr.studies.sweep import sweep

__all__ = ["InsertionOrder", "Range", "Samples", "Study", "Summary", "Sweep", "Values", "load_study", "sweep"]
