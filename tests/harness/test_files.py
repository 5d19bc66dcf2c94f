"""Files that are there whole or not at all."""

import os

import pytest

from crossdem.adapters.files import write_whole


def test_a_file_is_replaced_and_nothing_lies_beside_it(tmp_path):
    for content in (b"one", b"two"):
        write_whole(tmp_path / "file", content)
        assert (tmp_path / "file").read_bytes() == content
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize("end", [KeyboardInterrupt, OSError])
def test_what_breaks_it_off_leaves_the_old_file_alone(tmp_path, monkeypatch, end):
    def broken(*_):
        raise end

    write_whole(tmp_path / "file", b"one")
    monkeypatch.setattr(os, "fsync", broken)
    with pytest.raises(end):
        write_whole(tmp_path / "file", b"two")
    assert (tmp_path / "file").read_bytes() == b"one"
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_two_machines_with_one_number_for_a_process_do_not_meet(tmp_path, monkeypatch):
    """As containers have, where the first process is 1 in each."""
    rename, used = os.rename, []
    monkeypatch.setattr(os, "rename", lambda old, new: (used.append(old), rename(old, new)))
    for _ in range(2):
        write_whole(tmp_path / "file", b"one")
    assert used[0] != used[1]
