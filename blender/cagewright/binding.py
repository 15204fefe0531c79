"""Models that follow their cages, live.

A bound model remembers its cage as it was at rest, and how it follows it. Whenever the cage has moved, Cagewright says
how far each vertex of the model has to go; that is an attribute of its mesh, which a modifier of geometry nodes adds to
its positions. So the model's own shape stays as it is, the modifier may be switched off, the file shows the same without
this add-on, and subdivision, armatures and shape keys of the model go on working.

At rest means: in the frame of the binding, which is the world as it was round the model, less its place. Weights are
computed there, so that a scaled or mirrored object is bound as it looks.
"""

import base64
import json
import uuid

import bpy
import numpy as np

from . import engine, geometry
from .engine import Failure
from .preferences import threads

MODIFIER = "Cagewright"


# ---- What is remembered -------------------------------------------------------------------------


def _packed(array):
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode()


def _unpacked(text, dtype, columns=None):
    flat = np.frombuffer(base64.b64decode(text), dtype)
    return flat if columns is None else flat.reshape(-1, columns)


class Record:
    """A binding as the file has it."""

    def __init__(self, cage, corners, offsets, frame, anchor):
        self.cage = cage          # C x 3, at rest, in the frame
        self.corners = corners
        self.offsets = offsets
        self.frame = frame        # 4 x 4: from the model's own space to the frame
        self.anchor = anchor      # 4 x 4: from the model's own space to that of the cage's parent; None: it had none

    def text(self):
        return json.dumps({"cage": _packed(self.cage), "corners": _packed(self.corners), "offsets": _packed(self.offsets),
                           "frame": _packed(self.frame), "anchor": None if self.anchor is None else _packed(self.anchor)})

    @classmethod
    def of(cls, text):
        parts = json.loads(text)
        return cls(_unpacked(parts["cage"], np.float64, 3), _unpacked(parts["corners"], np.int32),
                   _unpacked(parts["offsets"], np.int64), _unpacked(parts["frame"], np.float64, 4),
                   None if parts["anchor"] is None else _unpacked(parts["anchor"], np.float64, 4))


def attribute_of(state):
    return f"cagewright_{state.key}"


def rest_attribute_of(state):
    return f"cagewright_rest_{state.key}"


def options_of(state):
    """Those of the coordinates."""
    return json.loads(state.options)


def _new_key():
    return uuid.uuid4().hex[:8]


def is_bound(obj):
    return obj.type == "MESH" and bool(obj.cagewright.key)


def bound_models():
    return [obj for obj in bpy.data.objects if is_bound(obj) and obj.library is None]


def models_bound_to(cage):
    return [obj for obj in bound_models() if obj.cagewright.cage == cage]


# ---- The cage as it is now ----------------------------------------------------------------------


def _inverse(matrix, what):
    if abs(np.linalg.det(matrix[:3, :3])) < 1e-30:
        raise Failure(f"{what} is scaled to nothing along an axis: give it a scale other than 0")
    return np.linalg.inv(matrix)


def _mixed_keys(cage, depsgraph):
    """The cage's own vertices with its shape keys, but without its modifiers."""
    keys = cage.data.shape_keys
    if cage.mode == "EDIT":
        import bmesh
        edited = bmesh.from_edit_mesh(cage.data)
        return np.array([vertex.co[:] for vertex in edited.verts], np.float64).reshape(-1, 3)
    if keys is None or not keys.use_relative:
        return geometry.points_of(cage.data)
    values = keys.evaluated_get(depsgraph).key_blocks
    shapes = {}
    for block in keys.key_blocks:
        flat = np.empty(3 * len(block.data), np.float32)
        block.data.foreach_get("co", flat)
        shapes[block.name] = flat.reshape(-1, 3).astype(np.float64)
    mixed = shapes[keys.reference_key.name].copy()
    for block in keys.key_blocks:
        if block.mute or block == keys.reference_key:
            continue
        move = shapes[block.name] - shapes[block.relative_key.name]
        group = cage.vertex_groups.get(block.vertex_group) if block.vertex_group else None
        if group is not None:
            move = move * _weights_of_group(cage, group)[:, None]
        mixed += values[block.name].value * move
    return mixed


def _weights_of_group(obj, group):
    weights = np.zeros(len(obj.data.vertices))
    for vertex in obj.data.vertices:
        for element in vertex.groups:
            if element.group == group.index:
                weights[vertex.index] = element.weight
    return weights


def _follows_armature_of(cage, model):
    """Whether both follow the same armature: then it poses the model after the cage has moved it."""
    armatures = {modifier.object for modifier in model.modifiers if modifier.type == "ARMATURE" and modifier.object}
    return any(modifier.type == "ARMATURE" and modifier.object in armatures for modifier in cage.modifiers)


def _parent_of(cage):
    """The mesh that the cage is parented to, or None: then it counts how the cage lies in that. So a model that was
    copied alone bends in its own place as the first does."""
    parent = cage.parent
    return parent if parent is not None and parent.type == "MESH" and cage.parent_type == "OBJECT" else None


def _world(obj, depsgraph):
    return geometry.matrix_of(obj.evaluated_get(depsgraph).matrix_world)


def cage_in_model(model, cage, depsgraph, pose, anchor):
    """The vertices of the cage in the model's own space, as they are now."""
    if pose == "REST" and _follows_armature_of(cage, model):
        points = _mixed_keys(cage, depsgraph)
    else:
        with geometry.Evaluated(cage, depsgraph) as mesh:
            points = geometry.points_of(mesh)
    parent = _parent_of(cage)
    home = _world(model, depsgraph) if anchor is None or parent is None else _world(parent, depsgraph) @ anchor
    return geometry.transformed(points, _inverse(home, model.name) @ _world(cage, depsgraph))


# ---- Following ----------------------------------------------------------------------------------


class _Live:
    """A bound model in memory."""

    def __init__(self, model, record, rest, deformer):
        self.record = record
        self.rest = rest          # P x 3, in the frame
        self.deformer = deformer
        self.last = None          # the cage that the model shows
        self.key = model.cagewright.key
        linear = record.frame[:3, :3]
        self._back = None if np.array_equal(linear, np.eye(3)) else np.linalg.inv(linear).T

    def offsets(self, cage):
        """How far each vertex goes, in the model's own space: P x 3 floats."""
        moves = self.deformer(geometry.transformed(cage, self.record.frame)) - self.rest
        return (moves if self._back is None else moves @ self._back).astype(np.float32)


_live = {}  # by the name of the model


def forget():
    """Everything in memory; it is made anew when it is needed."""
    _live.clear()


def _rest_points(model, state):
    """The P points that were bound, in the model's own space."""
    attribute = model.data.attributes.get(rest_attribute_of(state))
    if attribute is None:
        return geometry.points_of(model.data)
    flat = np.empty(3 * len(model.data.vertices), np.float32)
    attribute.data.foreach_get("vector", flat)
    return flat.reshape(-1, 3).astype(np.float64)


def live_of(model):
    """A bound model in memory; computed where it is not there yet, such as after a file was opened."""
    state = model.cagewright
    live = _live.get(model.name)
    if live is not None and live.key == state.key and len(live.rest) == len(model.data.vertices):
        return live
    record = Record.of(state.packed)
    rest = geometry.transformed(_rest_points(model, state), record.frame)
    deformer = engine.get().deformer(rest, geometry.faces_of(model.data), record.cage, (record.corners, record.offsets),
                                     state.kind, options_of(state), threads=threads())
    _live[model.name] = _Live(model, record, rest, deformer)
    return _live[model.name]


def offsets_now(model, depsgraph):
    """How far the cage, as it is now, moves each vertex of a bound model."""
    live = live_of(model)
    return live.offsets(_checked_cage(model, live, depsgraph))


def _checked_cage(model, live, depsgraph):
    state = model.cagewright
    now = cage_in_model(model, state.cage, depsgraph, state.pose, live.record.anchor)
    if len(now) != len(live.record.cage):
        raise Failure(f"{state.cage.name} has {len(now)} vertices, and had {len(live.record.cage)} when {model.name} was "
                      "bound: undo, switch off what makes more, or bind again")
    return now


def linked_mesh(model):
    return (f"{model.name}: its mesh is linked from another file; make it local first (Object > Relations > Make Local > "
            "Selected Objects and Data)")


def _set_problem(state, text):
    if state.problem != text:
        state.problem = text


def follow(model, depsgraph):
    """Brings a bound model up to date. What stands in the way is remembered, for the panel."""
    state = model.cagewright
    mesh = model.data
    if model.mode == "EDIT":
        return
    try:
        if mesh.library is not None:
            raise Failure(linked_mesh(model))
        live = live_of(model)
        now = _checked_cage(model, live, depsgraph)
        attribute = mesh.attributes.get(attribute_of(state))
        if live.last is not None and np.array_equal(now, live.last) and attribute is not None:
            return
        if attribute is None:
            attribute = mesh.attributes.new(attribute_of(state), "FLOAT_VECTOR", "POINT")
        attribute.data.foreach_set("vector", live.offsets(now).ravel())
        live.last = now
        mesh.update_tag()
        _set_problem(state, "")
    except Failure as failure:
        _set_problem(state, str(failure))


def show_again(model):
    """The next follow() writes, whatever was shown last: after undo, say."""
    live = _live.get(model.name)
    if live is not None:
        live.last = None


# ---- Binding ------------------------------------------------------------------------------------


def _nodes(key, cage):
    """The modifier's nodes: positions plus the attribute; and a node that may name the cage, see name_cage()."""
    tree = bpy.data.node_groups.new(f"{MODIFIER} {key}", "GeometryNodeTree")
    if hasattr(tree, "interface"):
        tree.interface.new_socket(name="Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
        tree.interface.new_socket(name="Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    if hasattr(tree, "is_modifier"):
        tree.is_modifier = True
    nodes = [tree.nodes.new(kind) for kind in ("NodeGroupInput", "GeometryNodeInputNamedAttribute",
                                               "GeometryNodeSetPosition", "NodeGroupOutput", "GeometryNodeObjectInfo")]
    given, attribute, moved, out, info = nodes
    for node, place in zip(nodes, [(0, 200), (0, 0), (250, 150), (500, 150), (0, -250)]):
        node.location = place
    attribute.data_type = "FLOAT_VECTOR"
    attribute.inputs["Name"].default_value = f"cagewright_{key}"
    tree["cage"] = cage
    value = next(socket for socket in attribute.outputs if socket.enabled and socket.name == "Attribute")
    tree.links.new(given.outputs[0], moved.inputs["Geometry"])
    tree.links.new(value, moved.inputs["Offset"])
    tree.links.new(moved.outputs[0], out.inputs[0])
    return tree


def modifier_of(model):
    for modifier in model.modifiers:
        if modifier.type == "NODES" and modifier.node_group is not None \
                and modifier.node_group.name.startswith(f"{MODIFIER} {model.cagewright.key}"):
            return modifier
    return None


def name_cage(model, is_named):
    """Whether the nodes name the cage: Blender then evaluates it even where it is hidden, in renders above all, but
    evaluates the model twice for each of its moves."""
    modifier = modifier_of(model)
    if modifier is None:
        return
    wanted = model.cagewright.cage if is_named else None
    for node in modifier.node_group.nodes:
        if node.bl_idname == "GeometryNodeObjectInfo" and node.inputs["Object"].default_value != wanted:
            node.inputs["Object"].default_value = wanted


def own_nodes(model):
    """A copy of a model and its cage follows the copied cage: it gets nodes of its own."""
    modifier = modifier_of(model)
    if modifier is None or modifier.node_group.get("cage") == model.cagewright.cage:
        return
    tree = modifier.node_group
    modifier.node_group = _nodes(model.cagewright.key, model.cagewright.cage)
    if tree.users == 0:
        bpy.data.node_groups.remove(tree)


def own_attributes(model, others):
    """An object that shares its mesh with others that are bound gets attributes of its own in it, where the others are
    moved otherwise: of a linked copy that stands elsewhere, say."""
    state, mesh = model.cagewright, model.data
    sharing = [other for other in others if other.data == mesh and other.cagewright.key == state.key]
    if not sharing or mesh.library is not None or mesh.is_editmode:
        return
    is_in_parent = _parent_of(state.cage) is not None and Record.of(state.packed).anchor is not None
    if is_in_parent and all(other.cagewright.cage == state.cage for other in sharing):
        return  # all are moved alike
    modifier, rest = modifier_of(model), mesh.attributes.get(rest_attribute_of(state))
    state.key = _new_key()
    if rest is not None:
        flat = np.empty(3 * len(mesh.vertices), np.float32)
        rest.data.foreach_get("vector", flat)
        mesh.attributes.new(rest_attribute_of(state), "FLOAT_VECTOR", "POINT").data.foreach_set("vector", flat)
    if modifier is not None:
        modifier.node_group = _nodes(state.key, state.cage)


class Request:
    """A model to be bound: what is read of it on the main thread, and the deformer that is made on another."""

    def __init__(self, model, cage, pose, kind, options):
        if model.data.library is not None or model.library is not None:
            raise Failure(linked_mesh(model))
        if cage.type != "MESH":
            raise Failure(f"{cage.name} is no mesh")
        if cage == model:
            raise Failure(f"{model.name} cannot be its own cage")
        if _follows_armature_of(cage, model):  # which then poses both; the cage is edited beneath
            pose = "REST"
        depsgraph = bpy.context.evaluated_depsgraph_get()
        world = _world(model, depsgraph)
        frame = np.eye(4)
        frame[:3, :3] = world[:3, :3]
        _inverse(frame, model.name)
        parent = _parent_of(cage)
        anchor = None if parent is None else _inverse(_world(parent, depsgraph), parent.name) @ world
        self.model, self.cage, self.pose, self.kind, self.options = model.name, cage.name, pose, kind, options
        self.points = geometry.points_of(model.data) if pose == "REST" else geometry.own_points_shown(model)
        self.faces = geometry.faces_of(model.data)
        rest = geometry.transformed(cage_in_model(model, cage, depsgraph, pose, anchor), frame)
        corners, offsets = geometry.faces_of(cage.data)
        if len(rest) != len(cage.data.vertices):
            making = [modifier.name for modifier in cage.modifiers
                      if modifier.show_viewport and modifier.type not in geometry.KEEPING]
            raise Failure(f"{cage.name}: its modifier {', '.join(making)} makes other vertices; apply it, or switch it "
                          "off, and bind again")
        if len(rest) == 0 or len(offsets) < 2:
            raise Failure(f"{cage.name} has no faces")
        self.record = Record(rest, corners, offsets, frame, anchor)
        self.rest = geometry.transformed(self.points, frame)
        self.deformer = None

    def compute(self, progress):
        self.deformer = engine.get().deformer(self.rest, self.faces, self.record.cage,
                                              (self.record.corners, self.record.offsets), self.kind, self.options,
                                              threads=threads(), progress=progress)
        return self


def attach(request):
    """Makes a computed binding the model's."""
    model, cage = bpy.data.objects.get(request.model), bpy.data.objects.get(request.cage)
    if model is None or cage is None or len(model.data.vertices) != len(request.rest):
        raise Failure(f"{request.model} or {request.cage} has changed while it was being bound: bind again")
    unbind(model)
    state = model.cagewright
    state.key = _new_key()
    state.cage = cage
    state.kind = request.kind
    state.options = json.dumps(request.options)
    state.pose = request.pose
    state.packed = request.record.text()
    if request.pose == "SHOWN":
        rest = model.data.attributes.new(rest_attribute_of(state), "FLOAT_VECTOR", "POINT")
        rest.data.foreach_set("vector", request.points.astype(np.float32).ravel())
    place = 0 if request.pose == "REST" else geometry.first_making(model)
    modifier = model.modifiers.new(MODIFIER, "NODES")
    if modifier.node_group is not None:  # Blender before 4 makes one of its own
        bpy.data.node_groups.remove(modifier.node_group)
    modifier.node_group = _nodes(state.key, cage)
    modifier.show_expanded = False
    move_to(model, modifier, place)
    _live[model.name] = _Live(model, request.record, request.rest, request.deformer)
    follow(model, bpy.context.evaluated_depsgraph_get())


def move_to(model, modifier, place):
    """Moves a modifier to a place in the stack."""
    now = list(model.modifiers).index(modifier)
    if now == place:
        return
    if hasattr(model.modifiers, "move"):  # Blender 4
        model.modifiers.move(now, place)
    else:
        with bpy.context.temp_override(object=model, active_object=model):
            bpy.ops.object.modifier_move_to_index(modifier=modifier.name, index=place)


def unbind(model):
    """The model no longer follows a cage, and is as it was before."""
    state = model.cagewright
    if not state.key:
        return
    modifier = modifier_of(model)
    if modifier is not None:
        tree = modifier.node_group
        model.modifiers.remove(modifier)
        if tree.users == 0:
            bpy.data.node_groups.remove(tree)
    if model.data.library is None and model.mode != "EDIT":
        for name in (attribute_of(state), rest_attribute_of(state)):
            attribute = model.data.attributes.get(name)
            if attribute is not None and not _is_used_by_another(model, state.key):
                model.data.attributes.remove(attribute)
    _live.pop(model.name, None)
    state.cage = None
    for name in ("key", "kind", "options", "pose", "packed", "problem"):
        setattr(state, name, "")


def _is_used_by_another(model, key):
    return any(other.data == model.data and other.cagewright.key == key and other != model for other in bound_models())
