"""What is special in IPython: commands in cells, completion, and errors shown from the learner's point of view."""
