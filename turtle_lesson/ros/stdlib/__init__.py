"""The standard library in a simulated process: time, random numbers, threads, locks, asyncio, signals, subprocess.

`patches.py` is the one table of everything that is replaced in the interpreter; `uninstall()` puts the originals back.
"""
