"""The learner's workspace, and the story of the pages that it grows with."""
