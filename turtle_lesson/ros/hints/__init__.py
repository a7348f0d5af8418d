"""What to try after an error of a learner's program: a sentence that is added below the error's own words."""
