"""Files that may be wrong or damaged: read, or refused in lines that name them."""

import pytest

import limitblocks as lb


def fault(path, read=lb.files.read_blocks, **options):
    """What is said of a file that is wrong."""
    with pytest.raises(lb.ModelError) as caught:
        read(path, **options)
    return said_of(path, caught.value)


def outcome(path, read=lb.files.read_blocks, **options):
    """What is in a file, or what is said of it; any other exception, a warning too, fails the test."""
    try:
        return read(path, **options)
    except lb.ModelError as error:
        return said_of(path, error)


def said_of(path, error):
    assert all("\n" not in line and line.startswith(str(path)) for line in error.problems), error
    return str(error)


def read_or_refused(path):
    """A model file is refused, or read as a model that is written and read again bit for bit."""
    model = outcome(path, lb.read)
    if isinstance(model, lb.Model):
        assert lb.read(model.save(path, overwrite=True)).digest == model.digest


def places(part, path=()):
    """Paths to every value in a document."""
    items = part.items() if isinstance(part, dict) else enumerate(part) if isinstance(part, list) else ()
    for key, value in items:
        yield (*path, key)
        yield from places(value, (*path, key))
