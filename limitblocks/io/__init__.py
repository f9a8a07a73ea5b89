"""Files in and out: the model file and the result file."""

from limitblocks.io.model_file import model_schema, read
from limitblocks.io.result_file import read_result, write_result

__all__ = ["model_schema", "read", "read_result", "write_result"]
