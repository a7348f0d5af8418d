"""What is special in IPython: commands among Python, completion, and errors from the learner's point of view."""
