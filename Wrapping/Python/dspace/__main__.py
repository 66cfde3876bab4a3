"""python -m dspace: the `dspace` command."""
import sys

from dspace.command_line import main

sys.exit(main())
