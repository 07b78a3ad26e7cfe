"""Effects of the vocabulary: by speed, direction, load, time, temperature, chance."""
