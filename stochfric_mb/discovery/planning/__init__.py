"""Before anything is measured: what planned runs could show, at what size, and which extra run would show more."""
