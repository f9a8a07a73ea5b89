"""Wavefront OBJ: each object or group a solid, faces as they are drawn."""
