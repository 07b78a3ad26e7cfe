"""Discovery: find where measured data and a model disagree, name the missing effect, add it, show that the gap shrinks.

One direction: record -> slips (events and friction forces) -> calibration -> regression and kinematics (screening) ->
confirmation by simulating -> decision -> refit -> gap on held-out data -> result.
"""
