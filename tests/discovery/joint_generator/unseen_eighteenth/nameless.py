"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there."""
