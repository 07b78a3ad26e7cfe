"""Effects of the friction law and of what varies it."""
