"""Every test here runs MuJoCo Warp on its CPU device and bears the marker ``warp``; its kernels stay in Warp's own cache."""

from pathlib import Path

import pytest

pytest.importorskip("mujoco_warp", reason="MuJoCo Warp is not installed")


def pytest_collection_modifyitems(items):
    here = Path(__file__).parent
    for item in items:
        if here in item.path.parents:
            item.add_marker(pytest.mark.warp)
