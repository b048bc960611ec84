"""``python -m pebo`` is ``pebo-gen``."""

import sys

from ._program import main

sys.exit(main())
