import os
from typing import (IO, Any, Callable, Iterable, Iterator, Literal, NamedTuple, Optional, Sequence, Union,
                    overload)

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Vertices = Any  # V x 3 numbers, or an object that has vertices and faces
_Faces = Any  # F x K integers, lists, (corners, offsets), one row as of PyVista
_Path = Union[str, bytes, "os.PathLike[str]"]
_Progress = Optional[Callable[[float, str], Optional[bool]]]
_Length = Union[float, str]

__version__: str
features: tuple[str, ...]
licence: str

class Error(Exception):
    code: str

class FileError(Error, OSError): ...
class InputError(Error, ValueError): ...
class NoValidCage(Error, RuntimeError): ...
class TooLarge(Error, MemoryError): ...
class NotAvailable(Error, RuntimeError): ...
class Cancelled(Error): ...
class NotAsAsked(UserWarning): ...

class Mesh:
    vertices: NDArray[np.float64]
    corners: NDArray[np.int32]
    offsets: NDArray[np.int64]
    triangles: NDArray[np.int32]
    colors: Optional[NDArray[np.float32]]
    group_names: list[str]
    face_groups: Optional[NDArray[np.int32]]
    notes: list[dict[str, str]]
    def __init__(self, vertices: NDArray[np.float64], corners: NDArray[np.int32], offsets: NDArray[np.int64],
                 triangles: NDArray[np.int32], colors: Optional[NDArray[np.float32]] = None,
                 group_names: Iterable[str] = (), face_groups: Optional[NDArray[np.int32]] = None,
                 notes: Iterable[dict[str, str]] = ()) -> None: ...
    @property
    def faces(self) -> NDArray[np.int32]: ...
    def __iter__(self) -> Iterator[NDArray[Any]]: ...

class Cage(Mesh):
    report: dict[str, Any]
    is_as_asked: bool
    def __init__(self, report: dict[str, Any], is_as_asked: bool, **arrays: Any) -> None: ...
    @property
    def remarks(self) -> list[str]: ...

class Violation(NamedTuple):
    kind: str
    elements: tuple[int, ...]
    place: tuple[float, float, float]
    message: str
    remedy: str

class Verdict:
    violations: list[Violation]
    counts: dict[str, int]
    figures: dict[str, Any]
    notes: list[str]
    report: dict[str, Any]
    def __init__(self, is_valid: bool, report: dict[str, Any]) -> None: ...
    def __bool__(self) -> bool: ...

class CSR(NamedTuple):
    data: NDArray[np.float64]
    indices: NDArray[np.int32]
    indptr: NDArray[np.int64]
    shape: tuple[int, int]
    def toarray(self) -> NDArray[np.float64]: ...

def read_mesh(source: Union[_Path, bytes, bytearray, memoryview, IO[bytes]], *, format: Optional[str] = None,
              pose: str = "shown") -> Mesh: ...
def write_mesh(path: _Path, vertices: _Vertices, faces: Optional[_Faces] = None) -> None: ...
def options() -> list[dict[str, str]]: ...
def generate(vertices: _Vertices, faces: Optional[_Faces] = None, *, num_vertices: Optional[int] = ...,
             num_faces: Optional[int] = None, max_gap: Optional[_Length] = None, quads: bool = False,
             clearance: _Length = 0.002, method: str = "envelope", symmetry: str = "auto", pieces: str = "together",
             density: Optional[ArrayLike] = None, joints: Optional[ArrayLike] = None, start: Any = None,
             threads: Optional[int] = None, progress: _Progress = None, **options: Any) -> Cage: ...
def check(vertices: _Vertices, faces: Optional[_Faces] = None, cage_vertices: Optional[_Vertices] = None,
          cage_faces: Optional[_Faces] = None, *, allow_pieces: bool = False, allow_inner_shells: bool = False,
          ignore_specks: bool = False, max_listed: Optional[int] = 20,
          threads: Optional[int] = None, progress: _Progress = None) -> Verdict: ...
def compare(vertices: _Vertices, faces: Optional[_Faces] = None, *cages: Any, names: Optional[Sequence[str]] = None,
            poses: bool = True, threads: Optional[int] = None, progress: _Progress = None) -> list[dict[str, Any]]: ...
def info(vertices: _Vertices, faces: Optional[_Faces] = None, *, resolution: int = 64, threads: Optional[int] = None,
         progress: _Progress = None) -> dict[str, Any]: ...
def coordinate_kinds() -> list[dict[str, Any]]: ...
@overload
def coordinates(kind: str, points: ArrayLike, cage_vertices: _Vertices, cage_faces: Optional[_Faces] = None, *,
                sparse: Literal[False] = False, threads: Optional[int] = None, progress: _Progress = None,
                **settings: Any) -> NDArray[np.float64]: ...
@overload
def coordinates(kind: str, points: ArrayLike, cage_vertices: _Vertices, cage_faces: Optional[_Faces] = None, *,
                sparse: Literal[True], threads: Optional[int] = None, progress: _Progress = None,
                **settings: Any) -> CSR: ...
@overload
def coordinates(kind: str, points: ArrayLike, cage_vertices: _Vertices, cage_faces: Optional[_Faces] = None, *,
                sparse: bool, threads: Optional[int] = None, progress: _Progress = None,
                **settings: Any) -> Union[NDArray[np.float64], CSR]: ...

class Deformer:
    def __init__(self, vertices: _Vertices, faces: Optional[_Faces] = None, cage_vertices: Optional[_Vertices] = None,
                 cage_faces: Optional[_Faces] = None, *, coordinates: str = "mean_value", storage: str = "single",
                 normals: bool = True, threads: Optional[int] = None, progress: _Progress = None,
                 **settings: Any) -> None: ...
    def __call__(self, cage_vertices: ArrayLike) -> NDArray[np.float64]: ...
    def move(self, vertices: ArrayLike, to: ArrayLike) -> NDArray[np.float64]: ...
    @property
    def positions(self) -> NDArray[np.float64]: ...
    @property
    def normals(self) -> Optional[NDArray[np.float64]]: ...
    @property
    def cage_positions(self) -> NDArray[np.float64]: ...
    @property
    def unbound(self) -> int: ...
    @property
    def weight_bytes(self) -> int: ...

def deform_file(model: _Path, cage: _Path, posed: Any, out: Union[_Path, Sequence[_Path]], *, coordinates: str = "mean_value",
                fps: float = 24, first_frame: float = 1, threads: Optional[int] = None, progress: _Progress = None,
                **settings: Any) -> list[str]: ...
def render(vertices: _Vertices, faces: Optional[_Faces] = None, cage_vertices: Optional[_Vertices] = None,
           cage_faces: Optional[_Faces] = None, *, size: tuple[int, int] = (1200, 900), views: Any = "three-quarter",
           up: str = "y", background: str = "gradient", shadows: bool = True, ambient_occlusion: bool = True,
           model_edges: bool = False, cage_lines_only: bool = False) -> NDArray[np.uint8]: ...
