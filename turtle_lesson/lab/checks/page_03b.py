"""Page 03b: a navigator that answers on arrival."""

from __future__ import annotations

PAGE = "03b_answer_on_arrival"
