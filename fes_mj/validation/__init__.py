"""Predictions beside what somebody measured: published numbers, and an experiment of one's own."""
