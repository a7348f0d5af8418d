"""The learner's workspace, and the files that each page leaves in it, which are read from the published pages."""
