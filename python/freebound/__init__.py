"""Flattens meshes into the plane with hard constraints and an exact proof of every result.

>>> import freebound
>>> layout = freebound.unwrap("model.obj")
>>> layout.verdict.planar
True
>>> layout.save("unwrapped.obj")
['unwrapped.obj']
"""

from ._check import charts, check
from ._errors import Cancelled, Error, InputError, NotProved, OptionError
from ._freebound import VERSION as __version__
from ._freebound import Step
from ._layout import Layout, Verdict
from ._map import MapRecord, map
from ._mesh import Mesh, read
from ._pack import Packed, pack
from ._plot import plot
from ._run import Drag, Flattener, Job, Pack, equations, flatten, start, unwrap
from ._transfer import Baked, Transferred, bake, transfer

__all__ = [
    "Baked",
    "Cancelled",
    "Drag",
    "Error",
    "Flattener",
    "InputError",
    "Job",
    "Layout",
    "MapRecord",
    "Mesh",
    "NotProved",
    "OptionError",
    "Pack",
    "Packed",
    "Step",
    "Transferred",
    "Verdict",
    "__version__",
    "bake",
    "charts",
    "check",
    "equations",
    "flatten",
    "map",
    "pack",
    "plot",
    "read",
    "start",
    "transfer",
    "unwrap",
]
