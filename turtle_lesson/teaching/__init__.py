"""For teachers: the console command `turtle-lesson`, which grades copies of pages, resets them and strips solutions."""
