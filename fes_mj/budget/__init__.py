"""One error budget: what everything that is not known contributes to the error of a design's mean power."""
