"""`python -m turtle_lesson …` is `turtle-lesson …`."""

import sys

from .teaching.main import main

sys.exit(main())
