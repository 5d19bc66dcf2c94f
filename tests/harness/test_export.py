"""What is exported opens in the programs that it is for, with the numbers of the run."""

import numpy as np
import pytest
import synthetic
from command_line import crossdem
from small_case import small_file

from crossdem.compare.export import write_h5md, write_vtk

# Debian has no stubs, and a machine without them must say so: these are in scripts/packages.txt.
import MDAnalysis
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


@pytest.fixture(scope="module")
def run():
    return synthetic.dataset(synthetic.case())


def read_vtp(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def test_vtk_reads_every_frame_with_its_particles(run, tmp_path):
    write_vtk(run, tmp_path)
    for frame in range(len(run.motion.time_s)):
        found = read_vtp(tmp_path / f"particles-{frame:04d}.vtp")
        points_m = vtk_to_numpy(found.GetPoints().GetData())
        np.testing.assert_array_equal(points_m[:, :2], run.motion.position_m[frame])
        assert (points_m[:, 2] == 0).all()
        data = found.GetPointData()
        np.testing.assert_array_equal(vtk_to_numpy(data.GetArray("radius_m")), run.radius_m)
        velocity = vtk_to_numpy(data.GetArray("velocity_m_s"))
        np.testing.assert_array_equal(velocity[:, :2], run.motion.velocity_m_s[frame])
        assert found.GetNumberOfVerts() == len(run.radius_m)


def test_vtk_reads_the_bar_where_it_is(run, tmp_path):
    write_vtk(run, tmp_path)
    last = len(run.motion.time_s) - 1
    bounds_m = read_vtp(tmp_path / f"bar-{last:04d}.vtp").GetBounds()
    bar = run.case["bar"]
    assert bounds_m[2] == run.motion.bar_tip_m[last]
    assert bounds_m[1] - bounds_m[0] == pytest.approx(bar["width_m"])


def test_the_collection_names_each_frame_at_its_time(run, tmp_path):
    text = write_vtk(run, tmp_path).read_text()
    for frame, time_s in enumerate(run.motion.time_s):
        assert (
            f'timestep="{float(time_s)!r}" part="0" name="particles" file="particles-{frame:04d}.vtp"'
            in text
        )


def test_a_reader_of_h5md_finds_the_motion(run, tmp_path):
    path = write_h5md(run, tmp_path / "motion.h5")
    universe = MDAnalysis.Universe.empty(len(run.radius_m), trajectory=False)
    universe.load_new(str(path), format="H5MD", convert_units=False)
    assert len(universe.trajectory) == len(run.motion.time_s)
    for frame, step in enumerate(universe.trajectory):
        np.testing.assert_allclose(step.positions[:, :2], run.motion.position_m[frame], rtol=1e-6)
        assert step.time == pytest.approx(run.motion.time_s[frame])


def test_the_command_writes_what_is_asked_for(tmp_path):
    options = ("--engines", "native", "--seeds", "1", "--out", tmp_path / "out")
    assert crossdem("run", small_file(tmp_path), *options).returncode == 0
    (folder,) = (tmp_path / "out" / "runs").glob("native-*")
    done = crossdem("export", folder, "--vtk", "--h5md", "--out", tmp_path / "exported")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "exported" / "vtk" / "motion.pvd").exists()
    assert (tmp_path / "exported" / "motion.h5").exists()


def test_nothing_to_write_and_nothing_to_read_are_told(tmp_path):
    assert crossdem("export", tmp_path, cwd=tmp_path).returncode == 2
    assert crossdem("export", tmp_path / "nothing", "--vtk", cwd=tmp_path).returncode == 2
    assert list(tmp_path.iterdir()) == []
