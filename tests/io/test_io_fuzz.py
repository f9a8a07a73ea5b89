"""Model files with anything in them: a model, or one of our errors."""

import json

from hypothesis import given
from hypothesis import strategies as st
from portal import LISTED, PORTAL, changed
from reading import places, read_or_refused

VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(allow_nan=False, allow_infinity=False),
    st.sampled_from([0.0, -1.0, 1e-300, 1e29, 1e308, [], {}, [[]], "", "left", "ground", "dry", "type"]),
    st.text(max_size=8),
    st.lists(st.floats(-2, 2), max_size=4),
)


MUTATIONS = [(document, path) for document in (PORTAL, LISTED) for path in places(document)]


@given(st.sampled_from(MUTATIONS), VALUES | st.just(...), st.data())
def test_only_our_errors_come_out_of_mutated_documents(tmp_path_factory, mutation, value, data):
    document, path = mutation
    document = changed(document, *path, to=value)
    if data.draw(st.booleans()) and isinstance(value, dict):
        document = changed(document, *path, data.draw(st.text(max_size=3)), to=data.draw(VALUES))
    file = tmp_path_factory.mktemp("fuzz") / "model.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    read_or_refused(file)


@given(st.data())
def test_only_our_errors_come_out_of_broken_text(tmp_path_factory, data):
    text = bytearray(json.dumps(PORTAL).encode())
    for _ in range(data.draw(st.integers(1, 4))):
        text[data.draw(st.integers(0, len(text) - 1))] = data.draw(st.integers(0, 255))
    file = tmp_path_factory.mktemp("fuzz") / "model.json"
    file.write_bytes(text[: data.draw(st.integers(0, len(text)))] if data.draw(st.booleans()) else text)
    read_or_refused(file)
