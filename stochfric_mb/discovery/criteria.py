"""Every number on which a decision of discovery hangs, with its reason; all have no dimension.

Where a rate of false alarms is stated, it was counted in simulated records in which nothing is missing (`null_scores`). The
others were chosen, and are as good as the tables of the tests that judge them. A result holds them all.
"""

from __future__ import annotations

# What is a name

FOLLOWED_UP, NAMED = 14.0, 20.0
"""Scores at which a candidate is followed up, and at which it is named [-]."""
FAMILY_WISE = 0.01
"""Chance that the best of all candidates is named where a scatter is declared and nothing is missing, and that the best of the
conditions of runs seems to foretell friction that is drawn anew for each of them [-]."""
OUTDONE = 0.5
"""A competitor that names no physics wins at once if the best effect has less than this share of its score [-]."""
CONTENDS = 0.75
"""Share of the best effect's score from which on forecasts decide between it and another one [-]: the first order of an effect
that changes a force by a tenth errs by as much, and the score of its marks by twice that."""
ALIKE_SCREENED, ALIKE_SHARE = 12.0, 0.03
"""Likelihood ratio of forecasts within which effects are of one class; score within which a spring's drift is no better [-]."""
ALIKE_SIMULATED = 10.0
"""Effects whose simulated criterion, in units of the best one's own misfit, is within this of the best are of one class with
it [-]."""
LACK_OF_FIT, LACK_OF_FIT_SHARE = 25.0, 0.35
"""A simulated candidate is refused if chi^2 stays this far above its freedom and above this share of the stated model's."""
SOFTER = 15.0
"""Score by which a stiffness that drifts must beat other drifts, or `ALIKE_SHARE` [-]."""
ALTERNATES = 0.9
"""Share of a ripple's score that alternation from slip to slip must reach to stand in its place [-]."""
BESIDE_SHAPES = 0.1
"""Share of the score of shapes that simulating has refuted from which on another effect may be named [-]."""
FORM_MISSES = 0.03
"""Share of the stated model's misfit that an effect of another form than the simulated one may leave [-]: a sixth of its
strength. The tests' forms leave 0.016 at most, those of other kinds 0.08 where friction varies along the stroke. As a share
of the size, not its square, it is what an empirical law of friction may miss where another stands in its place."""
OWN_FORM = 0.5
"""Share of the evidence of an effect and a smooth term along its own axis together that the effect's form must have by itself,
for the term to be taken for its shape [-]: the larger part."""
SECOND_SHARE = 0.1
"""A further effect needs at least this share of the first one's score [-]."""
LEFT_OVER = 0.35
"""Share of the scatter that named effects may leave where what is left is of no known kind: as in the forecasts, a name
must explain the larger part, 65 %."""
LEAST_KEPT = 0.5
"""Share of the slips that a model with effects must not miss for a search in what it leaves to make sense [-]."""
ENTRAINED = 0.03
"""Scatter of the intervals between slips, over their mean, up to which slips may keep to a wave [-]."""
SECOND_STEP = 20.0
"""Score that a second step of the sensor needs [-]."""
SHARE_OF_SHAPE = 0.7
"""Share of the score of shapes of their own for all runs that a fast wave must reach where the rates of the slips differ: that
all are fractions of one frequency is then evidence that the score does not count [-]."""
RATES_DIFFER = 1.1
"""Ratio of rates from which on they differ [-]."""

# Forecasts

EXPLAINED, EXPLAINED_RANDOM = 0.65, 0.2
"""Share of the reducible error of the fit runs' forecasts that named effects must explain; the second one where random
effects or a step between two slips, whose moment is not known well, are among them, and of what stick phases name: contacts
that yield come to 0.45 and more in the tests, what looks like one in stick to 0.12 [-]."""
LACKS = 2.0
"""Standard errors by which the forecasts of the fit runs must show that less than that share is explained [-]: where an effect
changes the forecasts of fifty slips by a tenth of the noise, the share itself is known to no better than a fifth."""
EVIDENCE_LEFT = (1.0 - EXPLAINED) ** 2
"""Share of each part of the evidence in the forces of the slips that a name may leave [-]: evidence goes by squares."""
LEFT_BEYOND = 4.0
"""Standard deviations by which what is left must exceed that share [-]: chance in the edges of single slips passes three."""
NONE_MISSES = 0.5
"""Reducible error over the error itself above which "none" is no answer [-]: more is wrong with the forecasts than is right.
Where nothing is missing, noise and declared scatter leave up to a third."""
THROWN_OFF, FEWEST_THROWN_OFF = 3.0, 2
"""Error of a forecast over that of most from which on something came between, and how many of them kicks leave at least:
noise alone, however coloured, leaves forecasts that all miss by about the same [-]."""
HELD_OUT_DOUBT = 2.0
"""Standard errors of the mean difference by which forecasts must be worse: chance does that once in 40 times [-]."""
HELD_OUT_FAR_OFF = 1.1
"""Error with an effect, over that without it, from which on it is refused, unless most forecasts are better [-]."""
HELD_OUT_MOST = 2.0
"""Standard deviations of a fair coin by which better forecasts must outnumber worse ones to be most [-]."""
LEAST_REDUCIBLE = 0.08
"""Reducible error, over the error itself, below which shares of it would be noise over noise [-]."""
SHOWS_IN_FORECASTS = 0.5
"""Reducible share of the error of forecasts over that of slip forces below which an effect shows in the forces [-]: at less
than half of it noise hides in a forecast most of what the forces show."""
CLOSES_NOTHING = 0.02
"""Share of the error of forecasts, or of predicted slip forces, below which a change of it is nothing over nothing: an effect
that takes away no more of either is not named, and a gap no larger has no closed share [-]."""
STRENGTH_DECIDED = 3.84
"""Likelihood ratio to a fit without the effect at which its strength differs from zero: chi^2 of one degree, 5 % [-]."""
UNNAMED_LEAST = 0.0
"""Score that an axis must reach: more evidence than its numbers and the choice between the axes cost."""
LEFT_IN_FORCES = 1.5
"""Error of the forces of held-out slips, over what it would be if the model were true, from which more is said to be missing
[-], as at joints: eight right names of a stranger's records left up to 1.35, one of a rig whose
engine smooths friction 2.0, names that were not all 3.6 and more."""
FORCES_FEWEST = 6
"""Slips below which there is no score."""
DECIDED_BY_DATA = 0.5
"""Share of what is known of a number below which its prior, not the data, has made it [-]: the larger half decides."""
SURPRISING = 2.0
"""Stated standard deviations by which a parameter is off from what is stated to be pointed out [-]: one in twenty by chance."""

# Stick phases and the sensor

STICK_EXPLAINED, STICK_SLACK = 0.75, 60.0
"""Share of what stick phases show beyond noise that a name must explain, but for so much of chi^2 [-]: chosen."""
STICK_DEPARTS = 1.0
"""What a stuck box does beyond noise, over the noise of one reading, up to which it may be the sensor's slow noise [-]: a zero
that wanders less is seen in the means of many readings alone, and moves no forecast by more than a reading errs."""
ROUNDING = 0.5
"""Deviation of rounding over that of the noise from which on noise is mostly rounding [-]: the larger half."""
SINGLE_MOMENTS = 0.2
"""Share of what stick phases show beyond noise from which on jumps at single moments count [-]: chosen."""
HIDES = 0.5
"""Slope of the reading over the position at an end of the range below which the sensor is clipped by and by [-]: it hides the
larger half of the motion."""
YIELDS_FOR_CREEP = 0.5
"""Share of the evidence for creep that a yielding or ringing contact must reach to be named in its place [-]."""
LEAST_OUTLIERS, FEWEST_OUTLIERS = 5.0e-5, 5
"""Share of outliers, and their number, from which on they are named [-]."""
OUTLIERS_BY_CHANCE = 1.0e-4
"""Chance of as many outliers within slips, if they fell anywhere, below which they belong to the slips [-]."""
LINE_OUTSHINES = 10.0
"""Evidence of such a line over that of the best effect in stick from which on the line is no trace of the effect: a contact
that rings is seen in the first few periods after each re-stick, a line all along [-]."""
LINE_STRENGTH = 60.0
"""Strength of a line in the noise at which it is no chance [-]; the largest of 64 without a line stays below 10."""
LOUD_LINE = 1.0
"""Variance of such a line over that of the rest of the noise below which it is part of the noise [-]."""
BELT_NOTED = 0.01
"""Relative error of the belt's speed that is worth a note [-]."""
BELT_TOO_MUCH = 0.03
"""Relative error above which no force is judged [-]: the damper's share and the momenta at both ends of a slip are then
wrong by as much as a weak effect is strong."""
BELT_DOUBT = 5.0
"""Standard deviations that an error must reach [-]."""
BELT_RESTS = 0.2
"""Speed of the box where it seems to stick, over the belt's, below which it rests, and slides on: a belt five times too slow is
no slip of the pen, and of units other errors tell."""
PHASE_ACCIDENT, PHASE_MOST_ACCIDENTS = 3.0, 0.25
"""Misfit of a stick phase over that of the others from which on it is an accident, and the share of the phases that may
be; more of them are the rule [-]. Of phases of noise that is slower than a tenth of them 1 in 100 is set aside."""
RINGS = 0.15
"""Share of the evidence for a contact that rings and yields that its ringing alone must have [-]: a box that creeps lags behind
the belt as one on a yielding contact does, but hardly rings when it sticks again."""
PHASE_JUMPED = 30.0
"""Fall of chi^2 by a step within one stick phase from which on it is a jump [-]; of 200 phases of noise, none of 100 runs has
one."""
FEWEST_PHASES = 8
"""Stick phases below which a wave cannot be distinguished from noise."""
WAVE_EXPLAINED = 0.1
"""Share of the variance that a wave must explain [-]: noise of 50 phases, ten independent numbers each, gives the best of a
thousand waves 3 %."""
TONES_EXPLAIN = 0.5
"""Share of what a wave's best tone leaves of the stick phases that its other tones must explain, to be no noise [-]: more than
they leave. Ten numbers follow a quarter of the noise of ten phases."""
FEWEST_VISITS = 4
"""Level visits to an end that a run needs."""
LEVEL_VISITS = 0.5
"""Share of the visits to an end that must be level for the sensor to be called clipped there [-]."""
LEVEL_SHARP = 4.0
"""Standard deviations within which a visit must be level [-]."""
LEVEL_MIDDLE, LEVEL_ROUND = 0.7, 3.0
"""Share of a visit that must be level on the mean of a run's visits, and the standard deviations within which it must be: the
top of a smooth motion lies 3 to 6 off where two fifths of its single visits seem level [-]."""
RANGE_BEYOND = 8.0
"""Noise beyond an end from which on a sample shows that the range goes on [-]."""
RANGE_BEYOND_SHARE = 1.0e-3
"""Share of a run's samples that may lie there: outliers [-]."""

# Scatter, kicks and switching

SCATTER_CERTAIN = 30.0
"""Likelihood ratio at which friction scatters beyond doubt [-]."""
SCATTER_MEMORY = 3.0
"""Correlation from slip to slip over its standard error at which the scatter has a memory [-]."""
SCATTER_REMAINING = 0.1
"""Share of the stated model's scatter that must remain with the effects in for it to be called random [-]."""
SCATTER_LEAST_SHARE = 0.004
"""Scatter over the friction itself below which, beside a named effect, it is what the effect's form leaves [-]."""
ACCIDENTS, MOST_KICKED = 0.05, 0.45
"""Share of slips that stand out up to which they are no scatter, one slip of thirty may do so by accident (see `pool`), and
from which on they are no kicks [-]. Kicks of fewer slips throw forecasts off, as edges that noise hides do not."""
KICK_STRAY = 8.0
"""Robust deviations beyond which a slip is an accident [-]."""
KICK_LEAST = 0.01
"""Change of a slip's force, over that at break-away, below which nothing stands out, however little the others scatter [-]."""
KICKS_ONE_SIDED = 1.0
"""Mean of the impulses over their deviation from which on they come from one side [-]."""
KICKED_SLIDING = 0.1
"""Distance of an onset force from the kinetic force, over that of a usual break-away, below which nothing has stuck [-]."""
FEWEST_KICKS = 3
"""Slips that must stand out: jumps in stick alone say too little of the force that makes them."""
FEWEST_ALIKE, KICKS_ALIKE, KICKS_LEVEL = 4, 0.3, 0.01
"""Slips that stand out by the same, their share of those that do, from which on friction has a second level, and how far apart
the same may be [-]: a level that is reached in a ramp is known to no better, and amounts that are spread evenly over a tenth of
the force would put one in ten so close together."""
ONCE_A_TURN = 0.7
"""Slips that stand out, over turns of the belt, from which on a bump comes back each turn, and turns over such slips [-]: noise
hides some, and a wide bump marks two slips."""
FOLDED_BY_CHANCE = 0.02
"""Chance of places that come back as well if they are random, below which they are a bump of the belt [-]: so many sets of true
kicks are called unknown."""
SCATTER_MORE_MEMORY = 2.0**0.5 * SCATTER_MEMORY
"""The same beyond that of a declared process, which one simulation tells with as large an error [-]."""
SCATTER_TOGETHER = 0.5
"""Correlation of stick and slip above which the scatter is not that of two independent coefficients [-]: of 24 slips with
independent ones 1 in 80 reaches it, of 48 1 in 3000."""
SCATTER_ALIKE = 2.0
"""Correlation of stick and slip over its standard error from which on a scatter may be the zero of the sensor, which moves both
alike [-]: one in forty by chance."""
WANDER_WORTH_A_LOOK = 2.0
"""Correlation over its standard error below which no wander is looked for [-]."""
LEVELS_APART = 12.0
"""Distance of two levels over the robust width of a level from which on they are two [-]: of 400 records of 26 slips,
normal, even or wandering, cut into two groups at the best place, none reached it, and of 50 along a sine 1 in 100."""
LEVELS_FEWEST = 24
"""Slips below which such groups may come about by chance."""
LEVEL_JUMP = 6.0
"""Change from one slip to the next over the robust deviation of such changes that is a jump [-]: no normal change in 1e8."""
FEWEST_JUMPS = 3
"""Jumps in all runs, below which they may be single accidents."""
MOST_JUMPS = 0.4
"""Share of the changes that may be jumps: with more of them, friction does not stay."""
STEPS_OF_A_SENSOR = 2.0
"""Changes of level a run that a sensor's steps may make."""
OUT_OF_STEP = 0.25
"""Share of the rarer level's slips that a regular alternation may miss [-]; random ones miss half."""

# Driven joints

MATERIAL = 0.05
"""Least share of the error on left-out parts of the record that an effect must take away [-]: less is real, perhaps, but no
explanation."""
MATERIAL_PHASED = 0.15
"""The same, on runs left out, for a wave whose phase is taken from each run [-]: motion that is periodic itself, seen through
an effect of another form, leaves waves that runs share by accident. Chosen: forces of the tests take away 0.5 and more."""
BETTER = 0.5
"""Least share of the parts that must get better [-]: an effect that shows in one place only is one that was fitted to it."""
STROKES_BY_CHANCE = 0.05
"""Without a score that names it an effect is taken where strokes left out, one by one, say so with no more chance than this of
error, the axes that were tried counted, and where each half of the record foretells the other better with it [-]."""
FEWEST_STROKES = 8
"""Fewest strokes that can."""
FEWEST_RUNS = 4
"""Fewest runs of which a trend from one to the next is asked: through three of them nearly every curve is a line."""
TIE = 10.0
"""Difference of scores within which effects cannot be distinguished [-]."""
FAINT = 0.1
"""Part of the evidence of the best candidate, to first order, below which one is not fitted [-]. In 76 records of joints, of
3192 fits, none below a fifth or too weak to pay for its own numbers was named or reached half of the best; one below a quarter
did."""
STANDS_IN = 0.5
"""Least part of an effect's evidence that one must have which could stand in for it [-]: the larger half."""
MOST_EFFECTS = 4
"""Most effects in one joint: beyond, errors of the first ones would be explained."""
SERIES = 3
"""Names from which on what they leave has to be noise [-]: so many that leave more draw what is there as terms of a series
would. Chosen, as many as are looked for in slips: of three series of joints all five answers of three names that left more were
wrong."""
WINS_BY, WINS_BY_SHARE = 15.0, 0.03
"""A smooth dependence without a name wins by that score, or that part of the best effect's score, whichever is more [-]."""
FACTOR = 3.0
"""Ratio of a number to what is stated, or the other way round, from which on a gear, a unit or a scale is named as what may be
wrong [-]: no mass is weighed so badly. Only said: it decides nothing."""
FAR_OFF = 10.0
"""Error of the stated model at a joint over its friction, from which on units and columns are named as what may be wrong [-].
Only said: it decides nothing."""
MOST_OFF, AT_BOUND = 4.0, 0.95
"""Standard deviations by which data may move what is believed of law and mechanism, and the part of that from which on a number
is held by it [-]; 6e-5 of all priors are off by more. What is off by more is a finding, or not that number at all."""
FAR_AHEAD = 2.0
"""Factor on the error of forward simulation from which an effect is not named, whatever else it explains, where one with
the controller in the loop has the last word [-]: chosen, so that the scatter of such errors, which starts and contacts decide,
rejects nothing. Where no controller is known that error may rise by `CLOSES_NOTHING`."""
EXPLAINED_HELD_OUT = 0.5
"""Part of the squared error, noise apart, that effects have to explain on held-out runs to be named [-]: more than they
leave."""
EXPLAINED_BY_MECHANICS = 0.9
"""The same where what leads is no law of friction but has the form that mechanics gives it, and more than noise is left [-]: it
has to explain nine times what it leaves. Chosen: in four sets of joints (16 to 19) wrong names of that kind came to 0.55 to
0.93, right ones to 0.95 and more but for a gain of the drive that changes with no usual course (0.77).
Two of the wrong ones, at 0.93, keep their names."""
UNNAMED_CARRIES = 0.05
"""Part of the squared error, noise apart, that a term without a name has to explain on held-out runs [-]: that something is
missing is known already, so any part that carries over is of use."""
EXPLAINED_AT_JOINTS = 0.7
"""Share of the squared error above the noise, on the fit runs, that one late position column of several must explain [-]:
chosen between 0.77, load dependence in the measured O-ring seal, and 0.66, a drift in the place of a bearing that seizes."""
WINDOWS_A_NUMBER = 4.0
"""Independent windows that a record must have for each number of a course at a joint, and of a step of the selection that is
asked for a delay [-]: with as many numbers as windows either leaves nothing of anything, and the score, which holds where they
are few among many, says nothing. Chosen: a swing-up of 14 windows took 18 numbers, a worn patch of a test, which is one, 10 of
90."""
EXPLAINED_BY_DELAY = 0.5
"""The same for a delay of all positions, with the effects beside it, of the mean square and of the square of the median size,
for a delay is there all along a motion [-]: more is explained than is left. Delays, filters and measured swing-ups come to
0.52 and more by the median, play and blows, which are late in some places, to 0.37 at most."""
CONTROLLER_MISFIT = 0.5
"""Error of what a stated controller gives from the measured motion, over the recorded drive, from which on it is not believed
[-]: it then explains less than three quarters of the drive's square."""
PLAINLY_LEFT = 0.1
"""Share of the squared error without effects from which on what they leave may not depend on conditions that are not theirs
[-]: a third of the error. Grease at one end of a stroke leaves a name by place 0.19; the measured seals leave load dependence
below 0.06 in all."""
ZERO_WANDERS = 0.15
"""Force over friction up to which what goes on across reversals is a zero of the drive that wanders [-]: chosen between 0.12 of
such a zero and 0.2 of a hose that somebody moves, in the tests."""
COLOURED = 8.0
"""Noise of the balance, from differences between its windows, over what white noise of its channels leaves there, beyond which
it is no noise of theirs but something quick that is missing [-]: chosen so that 1.5 times it lies between the 9.7 that encoders
which smooth leave in the nulls of tests/discovery/joint_generator, and the 14 of a load cell that rings at half strength."""
WAVE_FLATTENS, WAVE_CERTAIN = 2.6, 2.6
"""Kurtosis of what is left below which half of its power is waves (3 - 1.5 share^2), and standard errors sqrt(24/n) that it
must be off by [-]: chance does that in one place of 200. Nulls of tests/discovery/joint_generator stay above 2.7."""

MEASURED_TO = 1.0e-3
"""Changes of friction in velocity steps, over friction itself, up to which they may be the load cell's own [-]: chosen, the
accuracy of a usual one. Slow noise of the tests' nulls comes to 0.0005, what is missing without a name to 0.005 and more."""

# Records

MOST_FRICTION = 3.0
"""Coefficient of friction from which a position's zero or the load is wrong, unless as much is stated [-]: metals in air and
rubber reach 1 to 2 (Bowden and Tabor 1950)."""
FEWEST_SLIPS, FEWEST_OF_RUN = 12, 8
"""Slips of all runs below which they say too little to be used, and those of one run: its errors are estimated by simulating it
twice, from 15 slips or more."""
FAR_FROM_STATED = 13.9
"""Sum of the squares of what mass, stiffness and damping seem to be off by, in stated deviations, beyond which an effect looks
like them: chi^2 of three, passed by 3 rigs of 1000 [-]."""
FEWEST_SAMPLES = 40
"""Samples in a period of the natural oscillation below which edges cannot be located and corners look like outliers."""
GROSS_SLIP = 8.0
"""A slip whose features lie further from its run's medians than this many robust deviations is set aside [-]."""
STRAY_SLIP = 6.0
"""The same for slips that stray by accident, an edge that noise has hidden: calibration leaves out what strays as far [-]."""
FEW_STRAY, STRAY_SHARE = 2, 0.03
"""Number of a run's slips, or share of them, that may stray so; friction that varies puts more of them there, or none."""
OUTLIER_DEVIATIONS = 5.5
"""A sample further from the running median than this many standard deviations is an outlier [-]."""
TOO_LOUD = 0.1
"""Noise over the expected travel of a slip from which on slips drown in it [-]: their edges are located by the bend that a
break-away puts into the record, which is a tenth of the travel after a fifth of the slip."""
RIDES = 0.9
"""Share of the belt's travel that a box follows if it sticks throughout [-]."""
BEYOND_SPRING = 3.0
"""Travel of a box over the largest deflection that friction of the stated mu_s allows, from which its position is no deflection
[-]: the stated mu_s may be off by a half, and a zero does not move."""
SLIDES = 0.1
"""Share of it that a box stays below if it slides throughout [-]."""


def values() -> dict[str, float]:
    """Return every number above by its name, as a result holds them."""
    return {name.lower(): value for name, value in globals().items() if name.isupper() and isinstance(value, (int, float))}
