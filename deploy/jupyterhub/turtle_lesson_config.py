# What every JupyterHub with the lesson sets, whatever starts its servers; it is loaded after the hub's own configuration.
# A server is the command `turtle-lesson open --hub`: it makes the folder my-lesson in the learner's home, or brings its pages
# up to date, and shows this folder alone, opened on page 00. No other user of the computer can read what is made there.
# ruff: noqa: F821

c.Spawner.cmd = ["/opt/turtle-lesson/.venv/bin/turtle-lesson", "open", "--hub"]

# Where a whole class logs in at once, the last server waits for the others.
c.Spawner.start_timeout = 120
c.Spawner.http_timeout = 120
