"""An independent belt-box rig with hidden effects.

Nothing here imports the package under test: another integrator (RK4 with bisected events), another state machine and other
functional forms, so that discovery is judged on effects that it does not contain literally. Only the documented file formats
are shared.

curve       tables over one variable, which is how a form enters the simulator
machine     everything the simulator must know about one run
integrator  the compiled time stepping
rig         the nominal rig, what is uncertain, and what is true
design      which runs an experiment has
forms       the hidden effects
case        (form, design, strength, seed) -> dataset folder and truth record
gap         how much of the held-out forecast error the effect is worth
"""
