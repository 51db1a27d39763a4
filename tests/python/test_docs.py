"""The code of docs/python.md, and the examples, run as they stand."""

import os
import re
import subprocess
import sys

import pytest
from conftest import ROOT

PART = "G21 G90 F1200\nG1 X20\nG3 X25 Y5 R5\nG1 Y15\nM30\n"


def test_code_of_the_page(tmp_path, monkeypatch):
    (tmp_path / "part.ngc").write_text(PART)
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / "docs/python.md").read_text(), re.M | re.S)
    assert len(blocks) >= 5
    names = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)
    assert len(names["positions"]) > 1000


@pytest.mark.parametrize("name", ["cycle_time", "corner", "kk22", "jerk_and_tolerance", "controller", "joints"])
def test_examples(tmp_path, name):
    pytest.importorskip("matplotlib")
    done = subprocess.run([sys.executable, ROOT / "python/examples" / f"{name}.py", "--out", tmp_path / "new"], check=True,
                          capture_output=True, text=True, env={**os.environ, "MPLCONFIGDIR": str(tmp_path)})
    assert (tmp_path / "new" / f"python_{name}.png").stat().st_size > 5000
    if name == "kk22":  # the figures of docs/kk22.md
        for figure in ("47.124 mm", "1.835 s", "1.758 s", "1.680 s"):
            assert figure in done.stdout
