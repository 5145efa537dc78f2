# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
# Types of the module `tactus`, for editors and checkers.
from typing import Optional, Sequence, TypedDict

from numpy import float64, uint8, uint32
from numpy.typing import ArrayLike, NDArray

__version__: str

EXACT: int
SEPARATED: int
BOUNDED: int
STALE: int
WITHIN_TOLERANCE: int
IN_CONTACT: int
HALTED: int
OVER_CONSTRAINED: int
CAPACITY_EXCEEDED: int
RATE_LIMITED: int
DATA_LIMITED: int
UNSIGNED: int
OUTSIDE: int
INSIDE: int

class Error(RuntimeError): ...

class Model:
    def __init__(self, path: str) -> None: ...
    @staticmethod
    def find(name: str, domain: int = 0, wait_s: float = 10.0) -> Model: ...
    @property
    def faces(self) -> int: ...
    @property
    def vertices(self) -> int: ...
    @property
    def diagonal_m(self) -> float: ...
    @property
    def low_m(self) -> list[float]: ...
    @property
    def high_m(self) -> list[float]: ...
    @property
    def is_closed(self) -> bool: ...
    @property
    def hash(self) -> str: ...

class Distances:
    @property
    def lower_m(self) -> NDArray[float64]: ...
    @property
    def upper_m(self) -> NDArray[float64]: ...
    @property
    def side(self) -> NDArray[uint8]: ...
    @property
    def nearest_m(self) -> NDArray[float64]: ...

class StaticModel:
    def __init__(self, path: str) -> None: ...
    def distances(self, points_m: ArrayLike) -> Distances: ...

class Tool:
    def __init__(self, radius_m: float, *, shape: str = "sphere",
                 half_m: Optional[ArrayLike] = None, query_only: bool = False,
                 wants_distance: bool = False, stiffness_n_per_m: Optional[float] = None,
                 force_max_n: Optional[float] = None, torque_max_nm: Optional[float] = None,
                 speed_max_m_per_s: Optional[float] = None, shading_m: float = 0.0) -> None: ...

class Object:
    def __init__(self, model: int = 0, *, rotation: Optional[ArrayLike] = None,
                 translation_m: Optional[ArrayLike] = None, scale: float = 1.0,
                 static_friction: float = 0.0, dynamic_friction: float = 0.0) -> None: ...

class Answers:
    @property
    def force_n(self) -> NDArray[float64]: ...
    @property
    def torque_nm(self) -> NDArray[float64]: ...
    @property
    def proxy_m(self) -> NDArray[float64]: ...
    @property
    def flags(self) -> NDArray[uint32]: ...
    @property
    def lower_m(self) -> NDArray[float64]: ...
    @property
    def upper_m(self) -> NDArray[float64]: ...
    @property
    def kind(self) -> NDArray[uint8]: ...
    @property
    def nearest_m(self) -> NDArray[float64]: ...

class FrameState(TypedDict):
    frames: int
    pages_used: int
    pages_total: int
    faces_used: int
    is_whole: bool

class Frame:
    def __init__(self, models: Sequence[Model], tools: Sequence[Tool], objects: Sequence[Object],
                 *, memory_mib: float = 16.0, period_s: float = 0.001, loads_whole: bool = False,
                 object_speed_max_m_per_s: float = 0.5) -> None: ...
    def run(self, positions_m: ArrayLike, rotations: Optional[ArrayLike] = None,
            rounds: int = 0) -> Answers: ...
    def load(self) -> None: ...
    def place(self, object: int, *, rotation: Optional[ArrayLike] = None,
              translation_m: Optional[ArrayLike] = None, scale: float = 1.0) -> None: ...
    def feel(self, object: int, *, stiffness_n_per_m: float = 0.0, static_friction: float = 0.0,
             dynamic_friction: float = 0.0, damping_n_s_per_m: float = 0.0,
             viscosity_n_s_per_m: float = 0.0, texture_height_m: float = 0.0,
             texture_length_m: float = 0.0) -> None: ...
    def state(self) -> FrameState: ...
