"""Belt rigs of the fifteenth set, of unlike quality."""

from tests.discovery.unseen_forms.rigs import RIGS, Rig

RIGS_OF_THE_SET: dict[str, Rig] = {}

RIGS.update(RIGS_OF_THE_SET)
