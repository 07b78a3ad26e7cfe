"""Nothing is missing: numbers are off within their uncertainty, sensors and loggers are what they are."""
