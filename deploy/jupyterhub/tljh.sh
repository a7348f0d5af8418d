#!/usr/bin/env bash
# Puts the lesson on a computer with The Littlest JupyterHub: sudo bash /opt/turtle-lesson/deploy/jupyterhub/tljh.sh
# Run it again after each `git pull` there. What learners have written stays.
set -euo pipefail
cd /opt/turtle-lesson

hub=$(/opt/tljh/hub/bin/python -c 'import jupyterhub; print(jupyterhub.__version__)')
/opt/tljh/user/bin/python3 -m venv .venv
.venv/bin/python -m pip install -r environment.txt "jupyterhub==$hub"
.venv/bin/python -m compileall -q turtle_lesson # learners cannot write here, and each kernel would compile it anew

install -D -m 644 deploy/jupyterhub/turtle_lesson_config.py -t /opt/tljh/config/jupyterhub_config.d
tljh-config set limits.memory 1G
tljh-config set services.cull.timeout 3600   # an idle server is stopped after an hour,
tljh-config set services.cull.max_age 28800  # and any after eight: a lesson left playing is never idle
tljh-config reload hub
