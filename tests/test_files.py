"""A file of the learner's is written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from turtle_lesson import files


def test_an_interrupt_leaves_the_old_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "node.py"
    files.write(file, "old")

    def interrupted(self: Path, text: str, **options: object) -> int:
        self.touch()
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_text", interrupted)
    with pytest.raises(KeyboardInterrupt):
        files.write(file, "new")
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("node.py", "old")]


def test_permissions_and_links_stay(tmp_path: Path) -> None:
    file, link = tmp_path / "src" / "node.py", tmp_path / "link.py"
    files.write(file, "old")
    file.chmod(0o755)
    link.symlink_to(file)
    files.write(link, "new")
    assert link.is_symlink()
    assert file.read_text() == "new"
    assert os.name == "nt" or file.stat().st_mode & 0o777 == 0o755
