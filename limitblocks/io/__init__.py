"""Files in and out: the model file."""

from limitblocks.io.model_file import model_schema, read

__all__ = ["model_schema", "read"]
