"""What is set in the panel, and what objects remember.

The options of generating and the kinds of coordinates are those that Cagewright declares: nothing of them is written
here again.
"""

import bpy
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty,
                       StringProperty)

from . import engine

COORDINATE = "of_"  # before the names of options of coordinates, among the settings


def _title(name):
    words = name.replace("_", " ").replace("-", " ")
    return words[:1].upper() + words[1:]


class Option:
    """An option of Cagewright as a property of Blender's."""

    def __init__(self, declared):
        self.name = declared["name"]
        self.group = declared["group"]
        self.attribute = self.name.replace("-", "_")
        values, default = declared["values"], declared["default"]
        self.property, self._text = self._made(declared["label"], declared["help"], values, default)

    @staticmethod
    def _made(label, help_text, values, default):
        if values == "off|on":
            return (BoolProperty(name=label, description=help_text, default=default == "on"),
                    lambda value: "on" if value else "off")
        if "|" in values:
            items = [(word, _title(word), "") for word in values.split("|")]
            return EnumProperty(name=label, description=help_text, items=items, default=default), str
        least, most = values.split(" to ")
        is_unset = not default[:1].isdigit()  # "no limit": said by 0
        help_text += f" 0: {default}" if is_unset else ""
        if "%" in values:
            least, most = float(least.rstrip("%")), float(most.rstrip("%"))
            initial = 0.0 if is_unset else float(default.rstrip("%"))
            return (FloatProperty(name=label, description=help_text, subtype="PERCENTAGE", precision=3,
                                  min=0.0 if is_unset else least, max=most, default=initial),
                    lambda value: f"{value:.9g}%" if value or not is_unset else None)
        if "." in values + default or (least, most) == ("0", "1"):
            return (FloatProperty(name=label, description=help_text, min=float(least), max=float(most),
                                  default=float(default)), lambda value: f"{value:.9g}")
        return (IntProperty(name=label, description=help_text, min=0 if is_unset else int(least), max=int(most),
                            default=0 if is_unset else int(default)),
                lambda value: str(value) if value or not is_unset else None)

    def text(self, settings):
        """The value as people write it on the command line; None: not set."""
        return self._text(getattr(settings, self.attribute))


def _coordinate_property(option):
    label = _title(option["name"])
    if option.get("words"):
        return EnumProperty(name=label, description=option["help"], default=option["default"],
                            items=[(word, _title(word), "") for word in option["words"]])
    return FloatProperty(name=label, description=option["help"], default=option["default"], min=option["least"],
                         max=option["most"])


OPTIONS = [Option(declared) for declared in engine.options()]
KINDS = {kind["name"]: kind for kind in engine.kinds()}


def options_of(settings):
    """The options of generating by their names on the command line; initial ones are left out."""
    given = {}
    for option in OPTIONS:
        text = option.text(settings)
        if text is not None and settings.is_property_set(option.attribute):
            given[option.name] = text
    return given


def coordinates_of(settings):
    """The chosen kind of coordinates, and a dict of its options."""
    kind = KINDS[settings.coordinates]
    return kind["name"], {option["name"].replace("-", "_"): getattr(settings, COORDINATE + option["name"].replace("-", "_"))
                          for option in kind["options"]}


def _scene_properties():
    properties = {option.attribute: option.property for option in OPTIONS}
    properties["pose"] = EnumProperty(
        name="Model", default="SHOWN", description="Which shape of the model the cage is for",
        items=[("SHOWN", "As Shown", "With its modifiers and in its pose, polygons cut as in the viewport. The cage "
                                     "moves it after its armature"),
               ("REST", "As Stored", "The mesh itself, without modifiers: a rigged character in its rest pose. The "
                                     "cage moves it before its armature, which goes on posing it")])
    properties["together"] = BoolProperty(
        name="One for All", default=False,
        description="All selected objects get one cage, such as a body and its clothes; else each gets its own")
    properties["parent"] = BoolProperty(
        name="Parent", default=True,
        description="The cage goes along when the model is moved, turned or scaled as a whole")
    properties["skin"] = BoolProperty(
        name="Skin to Rig", default=False,
        description="The cage of a rigged model gets the weights of the model near it and follows the same armature")
    properties["coordinates"] = EnumProperty(
        name="Coordinates", description="How the model follows its cage",
        items=[(name, _title(name), kind["idea"] + ". Reproduces " + kind["reproduces"]) for name, kind in KINDS.items()])
    for kind in KINDS.values():
        for option in kind["options"]:
            properties[COORDINATE + option["name"].replace("-", "_")] = _coordinate_property(option)
    return properties


CagewrightSettings = type("CagewrightSettings", (bpy.types.PropertyGroup,), {"__annotations__": _scene_properties(),
                                                                             "__doc__": "What is set in the panel."})


_KEPT = {"LIBRARY_OVERRIDABLE"}  # with the file where the object is an override of one in another


class CagewrightModel(bpy.types.PropertyGroup):
    """A model that a cage was made for."""

    object: PointerProperty(type=bpy.types.Object, override=_KEPT)


class CagewrightObject(bpy.types.PropertyGroup):
    """What an object remembers: of a bound model its binding, of a cage whose it is."""

    # Of a bound model; see binding.py.
    cage: PointerProperty(name="Cage", type=bpy.types.Object, override=_KEPT)
    key: StringProperty(override=_KEPT)
    kind: StringProperty(override=_KEPT)
    options: StringProperty(override=_KEPT)
    pose: StringProperty(override=_KEPT)
    packed: StringProperty(override=_KEPT)
    problem: StringProperty(override=_KEPT)
    # Of a cage.
    models: CollectionProperty(type=CagewrightModel, override=_KEPT)
    mirror: StringProperty(override=_KEPT)
    verdict: StringProperty(override=_KEPT)


_CLASSES = [CagewrightSettings, CagewrightModel, CagewrightObject]


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.cagewright = PointerProperty(type=CagewrightSettings)
    bpy.types.Object.cagewright = PointerProperty(type=CagewrightObject, override=_KEPT)


def unregister():
    del bpy.types.Object.cagewright
    del bpy.types.Scene.cagewright
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
