"""The steps of this repository's workflow, exactly as written, in a Debian that holds nothing else (debootstrap, chroot)."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
WORKFLOW = ROOT / ".github" / "workflows" / "crossdem.yml"
OF_THE_MACHINE = (
    "etc/apt/sources.list",
    "etc/apt/sources.list.d",
    "etc/apt/apt.conf.d",
    "etc/apt/keyrings",
)
ONLY_HERE = ("etc/resolv.conf", "etc/hosts", "etc/ssl/certs", "usr/local/share/ca-certificates")
STEP_S = 1800


@pytest.fixture(scope="module")
def debian(tmp_path_factory):
    """The root of a minimal Debian 12 with the package sources and the network of this machine."""
    if os.geteuid() or not shutil.which("debootstrap"):
        pytest.fail("needs root and debootstrap: apt install debootstrap")
    root = tmp_path_factory.mktemp("debian")
    told = subprocess.run(
        ["apt-get", "indextargets", "--format", "$(REPO_URI) $(CODENAME)", "Component: main"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    mirror = next(line.split()[0] for line in told.splitlines() if line.endswith(" bookworm"))
    make = ["debootstrap", "--variant=minbase", "--no-check-gpg", "bookworm", root, mirror]
    subprocess.run(make, check=True, timeout=STEP_S)
    for name in (*OF_THE_MACHINE, *ONLY_HERE):
        here, there = Path("/", name), root / name
        if here.is_dir():
            shutil.copytree(here, there, dirs_exist_ok=True)
        elif here.exists():
            there.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(here, there)
    yield root
    shutil.rmtree(root, ignore_errors=True)


def in_debian(root, script, environment):
    """As GitHub runs a step with `shell: bash`."""
    contained = [
        "unshare",
        "--mount",
        "--pid",
        "--fork",
        f"--mount-proc={root}/proc",
        "chroot",
        root,
    ]
    command = [*contained, "/bin/bash", "--noprofile", "--norc", "-eo", "pipefail", "-c"]
    return subprocess.run(
        [*command, f"cd /workspace\n{script}"],
        env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "CI": "true"} | environment,
        timeout=STEP_S,
    ).returncode


def test_every_step_of_the_workflow_runs_in_a_clean_debian(debian):
    job = yaml.safe_load(WORKFLOW.read_text())["jobs"]["crossdem"]
    assert job["container"] == "debian:12"
    environment = job["env"] | {"GITHUB_STEP_SUMMARY": "/summary.md"}
    (debian / "workspace").mkdir()
    for step in job["steps"]:
        action = step.get("uses", "").partition("@")[0]
        if action == "actions/checkout":
            clone = ["git", "clone", "--quiet", "--no-hardlinks", ROOT, debian / "workspace"]
            subprocess.run(clone, check=True)
        elif action == "actions/upload-artifact":
            wanted = [path for path in step["with"]["path"].split() if not path.startswith("!")]
            found = {path: list((debian / "workspace").glob(path)) for path in wanted}
            assert found["results/crossdem/**/*.html"] and found["results/crossdem/**/junit.xml"]
        elif not action:
            assert in_debian(debian, step["run"], environment) == 0, step["name"]
        else:
            assert action == "actions/cache"  # a machine that has none yet
    summary = (debian / "summary.md").read_text()
    assert summary.startswith("# AGREES") or summary.startswith("# CONSISTENT")
