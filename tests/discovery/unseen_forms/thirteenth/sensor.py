"""Effects of the sensor."""
