"""The cross-engine regression suite: closed-form mechanics and belt-box cases for every engine, yours included.

Run it with ``pytest --pyargs stochfric_mb.testing``, on an adapter of your own with
``--stochfric-engine my_package.adapter`` or ``--stochfric-engine path/to/adapter.py``.
"""

from stochfric_mb.testing.accuracy import Accuracy

__all__ = ["Accuracy"]
