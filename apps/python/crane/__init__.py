"""Statics, motion and vibration of cranes with flexible supports, links and drives, from a description in YAML.

>>> import crane
>>> c = crane.load("eight_link_flexible", load_mass=300)
>>> rest = c.statics()
>>> rest.stable
True
>>> c.mass_matrix(rest.q).shape
(25, 25)

Every function takes states as arrays whose last axis holds the coordinates, and broadcasts over the axes before it as NumPy does;
so do live parameters that are arrays. Batches run on all threads, without Python's global lock.
"""

from importlib import metadata

from . import experiments
from ._native import set_threads, shipped, threads
from .damage import Cycle, Fatigue, fatigue
from .fit_result import Band, Fit
from .fitting import fit
from .frames import Frames
from .joints import JointStates
from .mistakes import InvalidRowWarning, NoEquilibrium, ParameterError, SpecError, SpecWarning
from .model import Crane, from_mjcf, from_urdf, load
from .results import (
    Buckling,
    CylinderDuty,
    DriveDuty,
    Duties,
    Energies,
    Ensemble,
    Envelope,
    Equilibrium,
    Linearisation,
    Modes,
    PumpDuty,
    Run,
    Sensitivity,
    Stability,
    SteadyMotion,
    Strength,
)
from .simulation import Simulation, State
from .state_space import Margins, StateSpace
from .vector_simulation import VectorSimulation, VectorState

__version__ = metadata.version("crane")

__all__ = [
    "__version__",
    "Band",
    "Buckling",
    "Crane",
    "Cycle",
    "CylinderDuty",
    "DriveDuty",
    "Duties",
    "Energies",
    "Ensemble",
    "Envelope",
    "Equilibrium",
    "Fatigue",
    "Fit",
    "Frames",
    "InvalidRowWarning",
    "JointStates",
    "Linearisation",
    "Margins",
    "Modes",
    "NoEquilibrium",
    "ParameterError",
    "PumpDuty",
    "Run",
    "Sensitivity",
    "Simulation",
    "SpecError",
    "SpecWarning",
    "Stability",
    "State",
    "StateSpace",
    "SteadyMotion",
    "Strength",
    "VectorSimulation",
    "VectorState",
    "experiments",
    "fatigue",
    "fit",
    "from_mjcf",
    "from_urdf",
    "load",
    "set_threads",
    "shipped",
    "threads",
]
