"""Every test here runs MuJoCo Warp, on a GPU if there is one, and bears the marker ``warp``; kernels stay in its own cache."""

import importlib.util
from pathlib import Path

import pytest

if importlib.util.find_spec("mujoco_warp") is None:
    collect_ignore_glob = ["test_*.py"]  # pip install -e '.[warp]'


def pytest_collection_modifyitems(items):
    here = Path(__file__).parent
    for item in items:
        if here in item.path.parents:
            item.add_marker(pytest.mark.warp)
