"""What the report's viewer is given: frames that unpack to the run's within the error that is said, and few enough."""

import base64
import gzip

import numpy as np
import pytest
import synthetic

from crossdem.compare import viewer


def unpacked(packed, particles):
    """As viewer.js does it."""
    differences = np.frombuffer(gzip.decompress(base64.b64decode(packed["gzip"])), "<i2")
    steps = np.cumsum(differences.reshape(-1, particles), axis=0, dtype=np.int16)
    return packed["step"] * steps


def test_frames_come_back_within_half_a_step():
    run = synthetic.dataset(synthetic.case())
    (shown,) = viewer.viewer_data({"native": run})["runs"]
    for number, name in enumerate("xy"):
        packed = shown["channels"][name]
        value_m = run.motion.position_m[..., number]
        off_m = np.abs(unpacked(packed, len(run.radius_m)) - value_m)
        assert off_m.max() <= 0.5001 * packed["step"] <= 1e-5 / 2
    assert shown["time_s"] == run.motion.time_s.tolist()
    assert shown["radius_m"] == run.radius_m.tolist()


@pytest.mark.parametrize("values", [[[0.0, 0.0]], [[-3.0, 3.0], [3.0, -3.0], [-3.0, 2.0]]])
def test_values_without_size_and_jumps_from_end_to_end_are_packed_too(values):
    packed = viewer.pack(np.array(values))
    assert unpacked(packed, 2) == pytest.approx(np.array(values), abs=packed["step"])


def test_an_engine_without_angles_has_none_of_them():
    run = synthetic.dataset(synthetic.case())
    (shown,) = viewer.viewer_data({"native": run})["runs"]
    assert run.motion.angle_rad is None and set(shown["channels"]) == {"x", "y", "speed", "spin"}


def test_of_many_frames_as_many_are_shown_as_fit_a_page(monkeypatch):
    run = synthetic.dataset(synthetic.case())
    particles = len(run.radius_m)
    monkeypatch.setattr(viewer, "MOST_VALUES", 10 * viewer.CHANNELS * particles)
    (shown,) = viewer.viewer_data({"native": run})["runs"]
    times_s = run.motion.time_s
    assert len(shown["time_s"]) == len(shown["bar_tip_m"]) == 10
    assert (shown["time_s"][0], shown["time_s"][-1]) == (times_s[0], times_s[-1])
    monkeypatch.setattr(viewer, "MOST_VALUES", 2 * viewer.CHANNELS * particles - 1)
    assert viewer.viewer_data({"native": run}) is None
    assert viewer.viewer_data({}) is None
