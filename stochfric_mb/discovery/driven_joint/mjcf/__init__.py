"""A user's own MuJoCo model: inverse dynamics along its records, and forward runs with friction in it."""
