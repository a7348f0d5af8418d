"""What to try about an error of a learner's program, said below the error's own words."""
