"""Many configurations or designs at once: arrays in, arrays out."""

from tactr.batch.result import Batch
from tactr.batch.solve_batch import solve_batch

__all__ = ["Batch", "solve_batch"]
