"""Tests of discovery: hidden effects planted by a generator that shares no code with the package.

One case:   python -m tests.discovery.generate --case frictional_lag --design several --strength 0.5 --seed 3 --out DIR
The suite:  python -m tests.discovery.suite --out DIR --seeds 0..2 --full --jobs 2
A handful:  python -m tests.discovery.suite --out DIR --kind dwell_ageing --design belt_speeds --keep
Driven joints: python -m tests.discovery.joint_suite --out DIR --seeds 0
"""
