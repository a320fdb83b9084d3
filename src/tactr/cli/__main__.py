"""`python -m tactr.cli`."""

import sys

from tactr.cli import main

sys.exit(main())
