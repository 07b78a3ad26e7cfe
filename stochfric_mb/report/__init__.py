"""Reports: figures and pages that need nothing but themselves (no network, no second file)."""
