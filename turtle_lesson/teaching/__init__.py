"""The command `turtle-lesson` for teachers and learners at a terminal: open, grade, reset and student."""
