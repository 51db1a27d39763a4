"""What the tests of the Python module share."""

import os
import tempfile
from pathlib import Path

import pytest
from hypothesis.configuration import set_hypothesis_home_dir

import cncplan

set_hypothesis_home_dir(Path(tempfile.gettempdir()) / "cncplan-hypothesis")

ROOT = Path(__file__).resolve().parents[2]
LIMITS = {"velocity": 30, "acceleration": 1000, "jerk": 10000}
LEVELS = ("exact", "fast", "good", "best")


@pytest.fixture
def mill():
    return cncplan.Machine(**LIMITS)


@pytest.fixture
def simulate():
    """The program cncplan_simulate, which CNCPLAN_SIMULATE names: made of the same sources, or plans differ."""
    program = os.environ.get("CNCPLAN_SIMULATE", str(ROOT / "build/g++/examples/cncplan_simulate"))
    if not os.access(program, os.X_OK):
        if "CNCPLAN_SIMULATE" in os.environ:
            pytest.fail(f"CNCPLAN_SIMULATE: {program} is no program")
        pytest.skip("cncplan_simulate is not built here (CNCPLAN_SIMULATE)")
    return program


@pytest.fixture
def shared():
    """The folder of other projects' data, which CNCPLAN_SHARED names."""
    if "CNCPLAN_SHARED" not in os.environ:
        pytest.skip("CNCPLAN_SHARED is not set")
    return Path(os.environ["CNCPLAN_SHARED"])
