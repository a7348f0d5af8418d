"""The world with its processes and packages, the streams that they print to, and the files that they may change."""
