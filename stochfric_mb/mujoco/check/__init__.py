"""What friction a MuJoCo model really has, probed site by site, and what this package's does in its place."""
