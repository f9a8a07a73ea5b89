"""The chunks that a 3dm file consists of: whether they fit together.

rhino3dm searches most damaged files without end, so that this is looked at first. A chunk is a code (4 bytes)
and a length (8 bytes) with as many bytes after it; a short chunk has a value instead of the length
(openNURBS, opennurbs_3dm.h).
"""

from __future__ import annotations

import struct

_HEADER = struct.Struct("<Iq")
_MAGIC = b"3D Geometry File Format "
_FIRST = 32  # bytes before the first chunk
_SHORT = 0x80000000
_TABLE = 0x10000000
_OBJECT = 0x20008070
_RECORDS = (_OBJECT, 0x20008076, 0x00027FFA)  # object, instance definition, object of a class
_END = 0x00007FFF


def fault(data: bytes) -> str:
    """Say what keeps `data` from being a whole 3dm file; empty when sound."""
    if not data.startswith(_MAGIC):
        return "is not a 3dm file: it does not begin as one"
    version = data[len(_MAGIC) : _FIRST].strip()
    if not version.isdigit() or int(version) < 50:
        return f"is of 3dm version {version.decode('ascii', 'replace')!r}; save it with Rhino 5 or later"
    at, _ = _walk(data)
    if at is not None:
        return f"is not a whole 3dm file: the part at byte {at} of {len(data)} is damaged or cut off"
    if data[-20:-8] != _HEADER.pack(_END, 8) or int.from_bytes(data[-8:], "little") != len(data):
        return f"is not a whole 3dm file: its end is missing after {len(data)} bytes"
    return ""


def objects(data: bytes) -> int:
    """Return the number of objects in a 3dm file without fault."""
    return _walk(data)[1]


def _walk(data: bytes) -> tuple[int | None, int]:
    """Return where chunks do not fill what they are in, None where all do, and the number of objects."""
    spans, objects = [(_FIRST, len(data))], 0
    while spans:
        at, end = spans.pop()
        while at < end:
            if end - at < _HEADER.size:
                return at, objects
            code, length = _HEADER.unpack_from(data, at)
            body = at + _HEADER.size
            after = body if code & _SHORT else body + length
            if not body <= after <= end:
                return at, objects
            objects += code == _OBJECT
            if not code & _SHORT and code & _TABLE:
                spans.append((body, after))
            elif code in _RECORDS:
                spans.append((body, after - 4 if code & 0x8000 else after))  # less its check sum
            at = after
    return None, objects
