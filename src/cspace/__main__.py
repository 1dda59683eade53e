"""`python -m cspace` is the command `cspace`."""

import sys

from cspace.cli import main

sys.exit(main())
