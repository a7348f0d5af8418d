"""What the standard library lends a simulated process: threads, locks, queues, asyncio, signals … in virtual time."""
