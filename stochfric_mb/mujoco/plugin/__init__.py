"""The engine plugins: what MuJoCo calls, how models configure it, and how it is registered."""
