"""The standard library in a simulated process: time, random, threads, locks, asyncio, signals and terminals in virtual time."""
