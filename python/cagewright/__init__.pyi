import os
from typing import Any, Callable, Iterator, NamedTuple, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

Vertices = Any  # V x 3 numbers, or an object that has vertices and faces
Faces = Any  # F x K integers, lists, (corners, offsets), one row as of PyVista
Path = Union[str, bytes, "os.PathLike[str]"]
Progress = Optional[Callable[[float, str], Optional[bool]]]
Length = Union[float, str]

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
    @property
    def faces(self) -> NDArray[np.int32]: ...
    def __iter__(self) -> Iterator[NDArray[Any]]: ...

class Cage(Mesh):
    report: dict[str, Any]
    is_as_asked: bool
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
    def __bool__(self) -> bool: ...

class CSR(NamedTuple):
    data: NDArray[np.float64]
    indices: NDArray[np.int32]
    indptr: NDArray[np.int64]
    shape: tuple[int, int]
    def toarray(self) -> NDArray[np.float64]: ...

def read_mesh(source: Union[Path, bytes, bytearray, memoryview], *, format: Optional[str] = None,
              pose: str = "shown") -> Mesh: ...
def write_mesh(path: Path, vertices: Vertices, faces: Optional[Faces] = None) -> None: ...
def options() -> list[dict[str, str]]: ...
def generate(vertices: Vertices, faces: Optional[Faces] = None, *, num_vertices: Optional[int] = 100,
             num_faces: Optional[int] = None, max_gap: Optional[Length] = None, quads: bool = False,
             clearance: Length = 0.002, method: str = "envelope", symmetry: str = "auto", pieces: str = "together",
             density: Optional[ArrayLike] = None, start: Any = None, threads: Optional[int] = None,
             progress: Progress = None, **options: Any) -> Cage: ...
def check(vertices: Vertices, faces: Optional[Faces] = None, cage_vertices: Optional[Vertices] = None,
          cage_faces: Optional[Faces] = None, *, allow_pieces: bool = False, allow_inner_shells: bool = False,
          max_listed: int = 20, threads: Optional[int] = None, progress: Progress = None) -> Verdict: ...
def compare(vertices: Vertices, faces: Optional[Faces] = None, *cages: Any, names: Optional[Sequence[str]] = None,
            poses: bool = True, threads: Optional[int] = None, progress: Progress = None) -> list[dict[str, Any]]: ...
def info(vertices: Vertices, faces: Optional[Faces] = None, *, resolution: int = 64, threads: Optional[int] = None,
         progress: Progress = None) -> dict[str, Any]: ...
def coordinate_kinds() -> list[dict[str, Any]]: ...
def coordinates(kind: str, points: ArrayLike, cage_vertices: Vertices, cage_faces: Optional[Faces] = None, *,
                sparse: bool = False, threads: Optional[int] = None, progress: Progress = None,
                **settings: Any) -> Union[NDArray[np.float64], CSR]: ...

class Deformer:
    def __init__(self, vertices: Vertices, faces: Optional[Faces] = None, cage_vertices: Optional[Vertices] = None,
                 cage_faces: Optional[Faces] = None, *, coordinates: str = "mean_value", storage: str = "single",
                 normals: bool = True, threads: Optional[int] = None, progress: Progress = None,
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

def deform_file(model: Path, cage: Path, posed: Any, out: Union[Path, Sequence[Path]], *, coordinates: str = "mean_value",
                fps: float = 24, first_frame: float = 1, threads: Optional[int] = None, progress: Progress = None,
                **settings: Any) -> list[str]: ...
def render(vertices: Vertices, faces: Optional[Faces] = None, cage_vertices: Optional[Vertices] = None,
           cage_faces: Optional[Faces] = None, *, size: tuple[int, int] = (1200, 900), views: Any = "three-quarter",
           up: str = "y", background: str = "gradient", shadows: bool = True, ambient_occlusion: bool = True,
           model_edges: bool = False, cage_lines_only: bool = False) -> NDArray[np.uint8]: ...
