"""Effects of the vocabulary: what records say is late, repeated or off."""
