"""New designs: the optimisation problem, methods to solve it, what a winner is worth."""
