"""The packages' own tests are for those who build them: `tests/site/test_programs_students.py` runs them."""

collect_ignore_glob = ["*/test/*"]
