"""Memory that MuJoCo and friction share, as named records for compiled code: its structs, our state, its library."""
