"""Pictures without a display."""

import ctypes
import math

from . import _arrays
from ._calls import run
from ._library import Handle, RenderOptions, checked, lib

_BACKGROUNDS = {"gradient": 0, "white": 1, "transparent": 2}


def _angles(view):
    if isinstance(view, str):
        angles = (ctypes.c_double * 2)()
        if not lib.cw_view_named(view.encode(), angles):
            raise ValueError(f"views: {view!r} is none of front, back, left, right, side, top, bottom, three-quarter, "
                             "and no pair (yaw, pitch) of degrees")
        return tuple(angles)
    try:
        yaw, pitch = map(float, view)
        if math.isfinite(yaw) and math.isfinite(pitch):
            return yaw, pitch
    except (TypeError, ValueError):
        pass
    raise ValueError(f"views: {view!r} is no pair (yaw, pitch) of degrees")


def _is_one(views):
    if not hasattr(views, "__len__"):
        raise ValueError(f"views: {views!r} is no view, and no list of views")
    return isinstance(views, str) or (len(views) == 2 and not any(isinstance(part, (str, tuple, list)) for part in views))


def render(vertices, faces=None, cage_vertices=None, cage_faces=None, *, size=(1200, 900), views="three-quarter", up="y",
           background="gradient", shadows=True, ambient_occlusion=True, model_edges=False, cage_lines_only=False):
    """Draws a model, and a cage over it.

    Args:
        vertices, faces: the model, as for generate().
        cage_vertices, cage_faces: a cage, or None. Objects that have both may stand for either: render(model, cage).
        size: width and height of each view, in pixels.
        views: front, back, left, right, side, top, bottom, three-quarter, or (yaw, pitch) in degrees; of a list of
            them, pictures side by side.
        up: the model's up axis, "y" or "z".
        background: "gradient", "white" or "transparent".
        shadows, ambient_occlusion: darken what is in shadow, and folds.
        model_edges: draw the sides of the model's polygons.
        cage_lines_only: draw no faces of the cage.

    Returns:
        uint8, height x width x 4: red, green, blue, opacity; rows from the top. For matplotlib's imshow(), PIL's
        Image.fromarray(), imageio and the like.

    Raises:
        NotAvailable: this machine cannot draw (no EGL), or this library was built without pictures.

    >>> plt.imshow(cagewright.render(V, F, *cage, views=["front", "left"]))
    """
    if background not in _BACKGROUNDS:
        raise ValueError(f"background: {background!r} is none of gradient, white and transparent")
    if up not in ("y", "z"):
        raise ValueError(f'up: {up!r} is neither "y" nor "z"')
    has_cage = cage_vertices is not None or (faces is not None and _arrays.parts_of(faces) is not None)
    if has_cage:
        parts = _arrays.four_parts(vertices, faces, cage_vertices, cage_faces)
    else:
        parts = _arrays.two_parts(vertices, faces, "the model")
    model = _arrays.mesh_view(*parts[:2], "the model")
    cage = _arrays.mesh_view(*parts[2:], "the cage") if has_cage else None
    angles = [angle for view in ([views] if _is_one(views) else views) for angle in _angles(view)]
    block = (ctypes.c_double * len(angles))(*angles)
    try:
        width, height = (int(pixels) for pixels in size)
    except (TypeError, ValueError):
        raise ValueError(f"size: {size!r} is not a width and a height in pixels") from None
    options = RenderOptions(size=ctypes.sizeof(RenderOptions), width=width, height=height, views=block,
                            view_count=len(angles) // 2, z_up=int(up == "z"), background=_BACKGROUNDS[background],
                            no_shadows=int(not shadows), no_ambient_occlusion=int(not ambient_occlusion),
                            model_edges=int(model_edges), no_cage_faces=int(cage_lines_only))

    def work(_control):
        out = ctypes.c_void_p()
        checked(lib.cw_render, ctypes.byref(model), ctypes.byref(cage) if has_cage else None, ctypes.byref(options),
                ctypes.byref(out))
        return Handle(out.value, lib.cw_image_free)

    image = run(work, None, None)
    shape = (lib.cw_image_height(image.pointer), lib.cw_image_width(image.pointer), 4)
    return _arrays.view(image, lib.cw_image_pixels(image.pointer), shape, "|u1")
