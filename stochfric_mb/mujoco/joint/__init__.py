"""Friction of joints and tendons, one coordinate each."""
