"""crossdem as a Python package: from the checkout, and installed without network."""

import os
import shutil
import subprocess

import pytest
from command_line import REFERENCE, ROOT

from crossdem.adapters.solver import find_solver

PYTHON = "/usr/bin/python3"


def _python(code, *, path, cwd):
    return subprocess.run(
        [PYTHON, "-c", code],
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": str(path)},
        capture_output=True,
        text=True,
        check=True,
    ).stdout.strip()


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """The folder that `pip install` fills, from a copy of the sources so that the checkout stays clean."""
    sources = tmp_path_factory.mktemp("sources")
    for folder in ("adapters", "compare", "reference_cases"):
        shutil.copytree(
            ROOT / folder, sources / folder, ignore=shutil.ignore_patterns("__pycache__")
        )
    for file in ("crossdem.py", "pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / file, sources)
    target = tmp_path_factory.mktemp("installed")
    subprocess.run(
        [PYTHON, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--no-index"]
        + ["--root-user-action=ignore", "--target", target, sources],
        check=True,
    )
    return target


def test_the_checkout_is_importable(tmp_path):
    code = "import crossdem.compare.cli as c; print(c.__file__)"
    assert _python(code, path=ROOT, cwd=tmp_path) == str(ROOT / "compare" / "cli.py")


def test_the_installed_package_is_importable(installed, tmp_path):
    code = "import crossdem.compare.cli as c; print(c.__file__)"
    expected = installed / "crossdem" / "compare" / "cli.py"
    assert _python(code, path=installed, cwd=tmp_path) == str(expected)


def test_the_installed_package_knows_its_version(installed, tmp_path):
    code = "import crossdem, importlib.metadata as m; print(crossdem.__version__, m.version('crossdem'))"
    here, recorded = _python(code, path=installed, cwd=tmp_path).split()
    assert here == recorded


@pytest.mark.parametrize("folder", ["adapters", "compare", "reference_cases"])
def test_every_file_of_the_checkout_is_installed(installed, folder):
    def files(root):
        found = (path for path in (root / folder).rglob("*") if path.is_file())
        return {str(path.relative_to(root)) for path in found if path.suffix != ".pyc"}

    assert files(installed / "crossdem") == files(ROOT)


def test_the_installed_command_resolves_a_case(installed, tmp_path):
    ended = subprocess.run(
        [PYTHON, installed / "bin" / "crossdem", "resolve", REFERENCE],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(installed), "CROSSDEM_SOLVER": str(find_solver())},
        capture_output=True,
        text=True,
    )
    assert ended.returncode == 0, ended.stderr
    assert '"name":"bar_penetration"' in ended.stdout


def test_the_installed_command_conforms_with_its_own_cases(installed, tmp_path):
    """As far as the ladder, on which this code fails at every run."""
    (tmp_path / "code.toml").write_text(
        'name = "code"\nversion = ["echo", "1"]\nrun = ["false", "{case}", "{packing}", "{out}"]\n'
    )
    ended = subprocess.run(
        [PYTHON, installed / "bin" / "crossdem", "conform", "code.toml", "--no-bed"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(installed), "CROSSDEM_SOLVER": str(find_solver())},
        capture_output=True,
        text=True,
    )
    assert ended.returncode == 3, ended.stderr
    assert "code, 1: ladder 0/" in ended.stdout


def test_an_installation_does_not_take_the_repository_around_it_for_its_own(installed, tmp_path):
    git = ["git", "-C", installed]
    subprocess.run([*git, "init", "--quiet"], check=True)
    subprocess.run([*git, "remote", "add", "origin", "https://example.org/mine.git"], check=True)
    ended = subprocess.run(
        [PYTHON, installed / "bin" / "crossdem", "init-ci"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(installed)},
        capture_output=True,
        text=True,
    )
    assert ended.returncode == 2
    assert "--source ADDRESS#TAG" in ended.stderr
