"""What keeps the harness honest: independent references, refinement, benchmarks, injected faults, the report."""
