"""``python -m styluscam``: the command line."""

from styluscam.cli import main

if __name__ == "__main__":
    main()
