"""The rules that xtask/budget.py holds, in a small repository."""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "xtask/budget.py"


def git(*arguments: str) -> None:
    author = ["-c", "user.name=A", "-c", "user.email=a@example.org"]
    subprocess.run(["git", *author, *arguments], check=True, capture_output=True)


def budget(*arguments: str) -> tuple[int, str]:
    run = subprocess.run([sys.executable, str(SCRIPT), *arguments], capture_output=True, text=True)
    return run.returncode, run.stderr


def write(code: int, most: int) -> None:
    """Write a folder with this many lines of code, and a budget for it."""
    tests = "#[cfg(test)]\nmod tests {\n    fn a() {}\n}\n"
    Path("src").mkdir(exist_ok=True)
    Path("src/lib.rs").write_text("//! Words.\n\n" + "fn a() {}\n" * code + tests)
    Path("BUDGET").write_text(f"src {most} - - - - -\nall {most} - - - - 1000\n")


def test_rows_hold_and_rise_in_commits_of_their_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    git("init", "-q")
    write(50, 50)
    git("add", ".")
    git("commit", "-qm", "first")
    assert budget() == (0, "")
    write(51, 50)
    code, error = budget()
    assert code == 1 and "src: 51 of rust; BUDGET has 50" in error
    assert budget("--write") == (0, "") and budget()[0] == 1, "--write raises nothing"
    write(51, 100)
    assert budget() == (0, "")
    git("commit", "-qam", "more code, and more room for it")
    code, error = budget()
    assert code == 1 and "raises src rust, all rust and changes 1 other files" in error
    git("reset", "-q", "--soft", "HEAD~1")
    git("reset", "-q", "src")
    git("commit", "-qm", "more room")
    git("commit", "-qam", "more code")
    assert budget() == (0, "")
    write(20, 100)
    assert budget("--write") == (0, "") and "50" in Path("BUDGET").read_text() and budget() == (0, "")
