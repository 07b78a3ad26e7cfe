"""Independent driven joints with hidden effects: slides, hinges, MJCF models and spring sliders.

Nothing here imports the package under test: another integrator (midpoint steps), another friction (an elastoplastic bristle
with return mapping), another arm (its closed-form equations, not MuJoCo) and functional forms from the literature, so that
discovery is judged on what it does not contain literally. Only the documented file formats are shared.

plant       everything the integrator must know about one run: bodies, tables over speed, place and time
integrator  the compiled time stepping
motion      what the controller is asked to follow
bench       the rigs: sizes, sample rates, noise, controllers, nominal and true numbers
slider      the spring slider, which has no inertia
thrown      short slides, which nothing drives
forms       the hidden effects
unseen      further ones, for a report alone; unseen_second to unseen_twentieth: again others, for the next ones
case        (form, design, strength, seed) -> dataset folder and truth record
files       how a case is written down
series_checks  what every series of forms for a report must keep
"""
