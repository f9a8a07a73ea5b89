"""A file is the old one or the new one at any moment, whatever stops the writer and whoever reads."""

import errno
import os
import signal
import stat
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import limitblocks as lb
from limitblocks import structures, studies, written

OLD = b"old"
MODEL = structures.column(lb.PointContact(0.7), count=1, width=0.5, height=1.0)
WRITERS = {
    "model.json": lambda path: MODEL.save(path, overwrite=True),
    "result.json": lambda path: lb.files.write_result(lb.bounds(MODEL), path, overwrite=True),
    "report.html": lambda path: lb.report(MODEL, lb.bounds(MODEL)).save(path, overwrite=True),
    "blocks.obj": lambda path: lb.files.write_blocks(MODEL.blocks, path, overwrite=True),
    "table.csv": lambda path: studies.directions(MODEL, 1).write_csv(path, overwrite=True),
    **{
        f"mesh{suffix}": lambda path: lb.files.write_blocks(MODEL, path, overwrite=True)
        for suffix in (".stl", ".ply", ".glb", ".dxf", ".3dm", ".json")
    },
    **{
        f"forces{suffix}": lambda path: lb.files.write_forces(MODEL, path, lb.bounds(MODEL), overwrite=True)
        for suffix in (".3dm", ".json", ".glb")
    },
    **{
        f"page{suffix}": lambda path: lb.report(MODEL, lb.bounds(MODEL)).save(path, overwrite=True)
        for suffix in (".md", ".json", ".pdf")
    },
    "field.vtu": lambda path: lb.files.write_vtu(MODEL, path, None, overwrite=True),
    "motion.glb": lambda path: lb.files.write_animation(MODEL, path, lb.bounds(MODEL), overwrite=True),
}


def full(*_):
    raise OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_leaves_the_old_file(tmp_path, monkeypatch, name):
    path = tmp_path / name
    path.write_bytes(OLD)
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(lb.LimitBlocksError, match=f"cannot write .*{name}: No space left on device"):
            WRITERS[name](path)
    assert path.read_bytes() == OLD
    assert os.listdir(tmp_path) == [name]
    WRITERS[name](path)  # no writer goes another way
    assert path.read_bytes() != OLD


@pytest.mark.parametrize("step", ["fsync", "replace", "link"])
@pytest.mark.parametrize("overwrite", [True, False])
def test_an_interrupt_at_any_step_leaves_the_old_file(tmp_path, monkeypatch, step, overwrite):
    def interrupted(*_):
        raise KeyboardInterrupt

    path = tmp_path / "a"
    if overwrite:
        path.write_bytes(OLD)
    monkeypatch.setattr(os, step, interrupted)
    if (step == "replace" and not overwrite) or (step == "link" and overwrite):
        written.write(path, b"new", overwrite)  # does not take this step
        return
    with pytest.raises(KeyboardInterrupt):
        written.write(path, b"new", overwrite)
    assert os.listdir(tmp_path) == (["a"] if overwrite else [])
    assert not overwrite or path.read_bytes() == OLD


@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL")
def test_a_killed_writer_leaves_a_whole_file(tmp_path):
    path, size = tmp_path / "a", 300_000
    code = (
        f"from pathlib import Path; from limitblocks.written import write\nk = 0\n"
        f"while True:\n k += 1; write(Path({str(path)!r}), str(k % 10) * {size}, True); print(k, flush=True)"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) as process:
        process.stdout.readline()
        time.sleep(0.003)
        process.send_signal(signal.SIGKILL)
    text = path.read_text()
    assert (len(text), len(set(text))) == (size, 1)


def test_two_writers_and_a_reader(tmp_path):
    path, contents = tmp_path / "a", (b"1" * 50_000, b"2" * 70_000)
    written.write(path, contents[0], False)

    def keep_writing(data):
        for _ in range(60):
            written.write(path, data, True)

    with ThreadPoolExecutor() as pool:
        writers = [pool.submit(keep_writing, data) for data in contents]
        while not all(writer.done() for writer in writers):
            assert path.read_bytes() in contents
        assert [writer.result() for writer in writers] == [None, None]
    assert os.listdir(tmp_path) == ["a"]


@pytest.mark.parametrize("links", [True, False])
def test_an_existing_file_is_refused(tmp_path, monkeypatch, links):
    if not links:  # as on a FAT stick
        monkeypatch.setattr(os, "link", lambda *_: full())
    path = tmp_path / "a"
    assert written.write(path, OLD, False) == path
    with pytest.raises(lb.LimitBlocksError, match="a exists; give another name or overwrite=True"):
        written.write(path, b"new", False)
    assert path.read_bytes() == OLD
    assert os.listdir(tmp_path) == ["a"]


def test_of_writers_that_race_one_wins(tmp_path):
    def tried(k):
        try:
            return written.write(tmp_path / "a", str(k), False)
        except lb.LimitBlocksError:
            return None

    with ThreadPoolExecutor(8) as pool:
        assert sum(one is not None for one in pool.map(tried, range(40))) == 1


@pytest.mark.skipif(sys.platform == "win32", reason="modes, links and devices of POSIX")
def test_links_modes_and_devices_stay(tmp_path):
    path, link = tmp_path / "a", tmp_path / "link"
    path.write_bytes(OLD)
    path.chmod(0o640)
    link.symlink_to(path)
    written.write(link, b"new", True)
    assert (link.is_symlink(), path.read_bytes(), stat.S_IMODE(path.stat().st_mode)) == (True, b"new", 0o640)
    written.write(Path(os.devnull), b"new", True)
    assert not Path(os.devnull).is_file()


def test_half_a_character_is_one_line(tmp_path):
    with pytest.raises(
        lb.LimitBlocksError, match=r"cannot write .*a: '\\ud800' in a name is half a character"
    ):
        written.write(tmp_path / "a", "stone \ud800", False)
    assert os.listdir(tmp_path) == []


def test_a_model_is_saved_under_a_name_that_is_read_again(tmp_path):
    model = lb.structures.block(lb.PointContact(0.4), width=0.5, height=1.0)
    for name in ("model.obj", "model.txt", "wall 1.5"):
        with pytest.raises(lb.ModelError, match=r"ends in \.json; files\.write_blocks"):
            model.save(tmp_path / name)
    assert not list(tmp_path.iterdir())
    for name in ("model", "model.json", "model.JSON"):
        assert lb.read(model.save(tmp_path / name)).digest == model.digest
