"""Checks of exercises, which look at the running system as any node could: at the graph, messages, answers, parameters.

`page_NN.py` holds the checks of a page, `pages_NN_NN.py` of several; the other modules are what they are made of. How to
write a check is in `lab/README.md`; answers that must fail or pass are in `tests/answers`.
"""
