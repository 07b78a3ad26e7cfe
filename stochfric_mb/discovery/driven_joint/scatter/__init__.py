"""Whether friction is drawn anew, for each stroke or each run, where its mean is known."""
