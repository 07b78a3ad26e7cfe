"""The commands of ``stochfric``, one file each. Importing one loads nothing but click."""
