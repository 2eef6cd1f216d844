# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The plugin for ParaView: isosurfaces, bands, slices, boundaries, isolines and height fields of
data in a plane, and a reader of .nestgrid files.

python -m nestgrid.paraview starts ParaView so that it finds this file.
"""
import ast
import math

from paraview import print_error
from paraview.util.vtkAlgorithm import smproperty, smproxy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData

import nestgrid
from nestgrid.paraview._inputs import field_of

INDICATORS = ("offset", "visual", "numerical", "wavelet")

ARRAY = """
<StringVectorProperty name="Scalars" command="SetInputArrayToProcess"
    number_of_elements="5" element_types="0 0 0 0 2" animateable="0">
  <ArrayListDomain name="array_list" attribute_type="Scalars">
    <RequiredProperties><Property name="Input" function="Input"/></RequiredProperties>
  </ArrayListDomain>
  <Documentation>Numbers at the points of image data or of an unstructured grid, or in the cells of
  a hyper tree grid.</Documentation>
</StringVectorProperty>
"""
ISOVALUE = """
<DoubleVectorProperty name="Isovalue" command="SetIsovalue" number_of_elements="1"
    default_values="0">
  <ArrayRangeDomain name="range" default_mode="mid">
    <RequiredProperties>
      <Property name="Input" function="Input"/>
      <Property name="Scalars" function="ArraySelection"/>
    </RequiredProperties>
  </ArrayRangeDomain>
  <Documentation>The value on the surface, in the units of the data.</Documentation>
</DoubleVectorProperty>
"""
MORE_ISOVALUES = """
<DoubleVectorProperty name="MoreIsovalues" command="AddMoreIsovalue"
    clean_command="ClearMoreIsovalues" number_of_elements="0" number_of_elements_per_command="1"
    repeat_command="1">
  <Documentation>Others, whose surfaces are drawn in the same walk, at a threshold or within an
  error: the cell array "value" tells the isovalue of each triangle.</Documentation>
</DoubleVectorProperty>
"""
PLANE = """
<DoubleVectorProperty name="Origin" command="SetOrigin" number_of_elements="3"
    default_values="0 0 0">
  <BoundsDomain name="range" mode="normal" default_mode="mid">
    <RequiredProperties><Property name="Input" function="Input"/></RequiredProperties>
  </BoundsDomain>
  <Documentation>A point on the plane.</Documentation>
</DoubleVectorProperty>
"""
FREE_PLANE = """
<DoubleVectorProperty name="Origin" command="SetOrigin" number_of_elements="3"
    default_values="0 0 0">
  <Documentation>A point on the plane.</Documentation>
</DoubleVectorProperty>
"""
NORMAL = """
<DoubleVectorProperty name="Normal" command="SetNormal" number_of_elements="3"
    default_values="0 0 1">
  <Documentation>Across the plane, of any length.</Documentation>
</DoubleVectorProperty>
"""
PLANE_GROUP = """
<PropertyGroup label="Plane" panel_widget="InteractivePlane">
  <Property function="Origin" name="Origin"/>
  <Property function="Normal" name="Normal"/>
</PropertyGroup>
"""
THRESHOLD = """
<DoubleVectorProperty name="Threshold" command="SetThreshold" number_of_elements="1"
    default_values="0">
  <DoubleRangeDomain name="range" min="0"/>
  <Documentation>Detail up to it is left out, in the units of the indicator; 0 draws
  everything.</Documentation>
</DoubleVectorProperty>
"""
ERROR = """
<DoubleVectorProperty name="Error" command="SetError" number_of_elements="1" default_values="0">
  <DoubleRangeDomain name="range" min="0"/>
  <Documentation>Data and drawing differ by no more, in the units of the data; 0 asks for
  nothing. Goes before the threshold.</Documentation>
</DoubleVectorProperty>
"""
DISTANCE = """
<DoubleVectorProperty name="Distance" command="SetDistance" number_of_elements="1"
    default_values="0" panel_visibility="advanced">
  <DoubleRangeDomain name="range" min="0"/>
  <Documentation>About how far the drawing may be from the surface of all data, in units of
  length: an estimate; 0 asks for nothing. Goes before the threshold.</Documentation>
</DoubleVectorProperty>
"""
DISTANCE_FIELD = """
<IntVectorProperty name="DistanceField" command="SetDistanceField" number_of_elements="1"
    default_values="0" panel_visibility="advanced">
  <BooleanDomain name="bool"/>
  <Documentation>Keep the distance there and back: draw more where the surfaces are farther from
  each other, which takes longer.</Documentation>
</IntVectorProperty>
"""
COLLAPSE = """
<IntVectorProperty name="Collapse" command="SetCollapse" number_of_elements="1"
    default_values="0">
  <BooleanDomain name="bool"/>
  <Documentation>Take edges away while the error, or the distance there and back, is kept, or
  down to the triangles asked for: fewer triangles, in more time. With a threshold or a cap
  nothing is taken away. Of slices the colours keep the error, and the place.</Documentation>
</IntVectorProperty>
"""
MAX_TRIANGLES = """
<IntVectorProperty name="MaxTriangles" command="SetMaxTriangles" number_of_elements="1"
    default_values="0">
  <IntRangeDomain name="range" min="0"/>
  <Documentation>Finds the least threshold with no more triangles; 0 is no limit. Goes before the
  threshold.</Documentation>
</IntVectorProperty>
"""
INDICATOR = f"""
<IntVectorProperty name="Indicator" command="SetIndicator" number_of_elements="1"
    default_values="0" panel_visibility="advanced">
  <EnumerationDomain name="enum">
    {"".join(f'<Entry value="{i}" text="{name}"/>' for i, name in enumerate(INDICATORS))}
  </EnumerationDomain>
  <Documentation>What the threshold limits: offsets from means, folds, jumps of the gradient or
  wavelet coefficients.</Documentation>
</IntVectorProperty>
"""
NORMALS = """
<IntVectorProperty name="Normals" command="SetNormals" number_of_elements="1" default_values="1">
  <BooleanDomain name="bool"/>
  <Documentation>Normals from gradients of the data, for smooth shading.</Documentation>
</IntVectorProperty>
"""
CAP = """
<IntVectorProperty name="Cap" command="SetCap" number_of_elements="1" default_values="0">
  <BooleanDomain name="bool"/>
  <Documentation>Close the surface along the boundary of the domain.</Documentation>
</IntVectorProperty>
"""
AT_NODES = """
<IntVectorProperty name="AtNodes" command="SetAtNodes" number_of_elements="1" default_values="0"
    panel_visibility="advanced">
  <BooleanDomain name="bool"/>
  <Documentation>Draw no slivers around nodes at which the data have the value.</Documentation>
</IntVectorProperty>
"""
CUTS = """
<IntVectorProperty name="Cuts" command="SetCuts" number_of_elements="1" default_values="0"
    panel_visibility="advanced">
  <EnumerationDomain name="enum">
    <Entry value="0" text="as what is asked for needs them"/>
    <Entry value="1" text="linear"/><Entry value="2" text="finest"/>
  </EnumerationDomain>
  <Documentation>Where edges of coarse elements are cut: between their ends, or where the finest
  data have the value.</Documentation>
</IntVectorProperty>
"""
OUTLINES = """
<IntVectorProperty name="Outlines" command="SetOutlines" number_of_elements="1" default_values="0"
    panel_visibility="advanced">
  <BooleanDomain name="bool"/>
  <Documentation>In the place of the surface the edges that elements have on it, which show where
  it is coarse and where fine.</Documentation>
</IntVectorProperty>
"""
BLEND = """
<DoubleVectorProperty name="Blend" command="SetBlend" number_of_elements="1" default_values="1"
    panel_visibility="advanced">
  <DoubleRangeDomain name="range" min="1"/>
  <Documentation>Nodes move from their mean to their value as the indicator grows from the threshold
  to this many times it; 1: they jump.</Documentation>
</DoubleVectorProperty>
"""
LENS = """
<DoubleVectorProperty name="LensCentre" command="SetLensCentre" number_of_elements="3"
    default_values="0 0 0" panel_visibility="advanced">
  <Documentation>Where elements are fine; away from there they may grow.</Documentation>
</DoubleVectorProperty>
<DoubleVectorProperty name="LensRadius" command="SetLensRadius" number_of_elements="1"
    default_values="0" panel_visibility="advanced">
  <DoubleRangeDomain name="range" min="0"/>
  <Documentation>Of the ball in which all is drawn, in units of length; 0: no lens.</Documentation>
</DoubleVectorProperty>
"""
REGION = """
<DoubleVectorProperty name="RegionBounds" command="SetRegionBounds" number_of_elements="6"
    default_values="0 0 0 0 0 0" panel_visibility="advanced">
  <Documentation>A box with a threshold of its own: its least and greatest x, y and z. As long as
  all are 0 there is none.</Documentation>
</DoubleVectorProperty>
<DoubleVectorProperty name="RegionThreshold" command="SetRegionThreshold" number_of_elements="1"
    default_values="0" panel_visibility="advanced">
  <DoubleRangeDomain name="range" min="0"/>
  <Documentation>The threshold in the box, in the units of the indicator.</Documentation>
</DoubleVectorProperty>
"""
COLOUR_TOLERANCE = """
<DoubleVectorProperty name="ColourTolerance" command="SetColourTolerance" number_of_elements="1"
    default_values="0" panel_visibility="advanced">
  <DoubleRangeDomain name="range" min="0"/>
  <Documentation>Split triangles until their colours follow the data within this, in the units of
  the data; 0: not at all. Not with collapses, nor with a number of triangles.</Documentation>
</DoubleVectorProperty>
"""
POSITION_ERROR = """
<DoubleVectorProperty name="PositionError" command="SetPositionError" number_of_elements="1"
    default_values="0" panel_visibility="advanced">
  <DoubleRangeDomain name="range" min="0"/>
  <Documentation>How far points of curved cells may be from where they are drawn, in units of
  length; 0: the same share of the domain as the error is of the range of the data.</Documentation>
</DoubleVectorProperty>
"""
BAND = """
<DoubleVectorProperty name="Band" command="SetBand" number_of_elements="2" default_values="0 1">
  <ArrayRangeDomain name="range">
    <RequiredProperties>
      <Property name="Input" function="Input"/>
      <Property name="Scalars" function="ArraySelection"/>
    </RequiredProperties>
  </ArrayRangeDomain>
  <Documentation>The lower and the upper value, in the units of the data.</Documentation>
</DoubleVectorProperty>
"""
VALUES = """
<DoubleVectorProperty name="Values" command="AddValue" clean_command="ClearValues"
    number_of_elements="0" number_of_elements_per_command="1" repeat_command="1">
  <ArrayRangeDomain name="scalar_range" default_mode="mid">
    <RequiredProperties>
      <Property name="Input" function="Input"/>
      <Property name="Scalars" function="ArraySelection"/>
    </RequiredProperties>
  </ArrayRangeDomain>
  <Documentation>The values on the lines, in the units of the data.</Documentation>
</DoubleVectorProperty>
"""
MAX_SEGMENTS = """
<IntVectorProperty name="MaxSegments" command="SetMaxTriangles" number_of_elements="1"
    default_values="0">
  <IntRangeDomain name="range" min="0"/>
  <Documentation>Finds the least threshold at which all lines together have no more segments; 0 is
  no limit. Goes before the threshold.</Documentation>
</IntVectorProperty>
"""
SCALE = """
<DoubleVectorProperty name="Scale" command="SetScale" number_of_elements="1" default_values="1">
  <Documentation>Heights are the data times this, in units of length; 0: all lies in the
  plane.</Documentation>
</DoubleVectorProperty>
"""
SHAPE = """
<IntVectorProperty name="Shape" command="SetShape" number_of_elements="1" default_values="0">
  <EnumerationDomain name="enum">
    <Entry value="0" text="Plane"/><Entry value="1" text="Sphere"/>
    <Entry value="2" text="Cylinder"/><Entry value="3" text="Function"/>
  </EnumerationDomain>
  <Documentation>What cuts: a plane across the normal, a sphere around the origin, a cylinder around
  the normal through it, or the zero of the function.</Documentation>
</IntVectorProperty>
<StringVectorProperty name="Function" command="SetFunction" number_of_elements="1"
    default_values="x*x + y*y - 1">
  <Documentation>Of x, y and z, in Python, with the functions of its module math.</Documentation>
</StringVectorProperty>
<DoubleVectorProperty name="Radius" command="SetRadius" number_of_elements="1" default_values="1">
  <DoubleRangeDomain name="range" min="0"/>
  <Documentation>Of the sphere or the cylinder, in units of length.</Documentation>
</DoubleVectorProperty>
<DoubleVectorProperty name="SliceDistance" command="SetSliceDistance" number_of_elements="1"
    default_values="0" panel_visibility="advanced">
  <DoubleRangeDomain name="range" min="0"/>
  <Documentation>How far a slice that is no plane, and whose edges are collapsed, may be from that of all
  data, there and back, in units of length; 0: it keeps its place.</Documentation>
</DoubleVectorProperty>
"""
MEASURE = """
<IntVectorProperty name="Measure" command="SetMeasure" number_of_elements="1" default_values="0"
    panel_visibility="advanced">
  <BooleanDomain name="bool"/>
  <Documentation>Measure how far the surface is from the data and from that of all data, there and
  back: field data "error", "distance" and "distance back" have, for each isovalue, the greatest, the
  mean and the root of the mean square.</Documentation>
</IntVectorProperty>
"""
WHERE = (BLEND, LENS, REGION, POSITION_ERROR)
OF_SURFACES = (OUTLINES, *WHERE)
INPUT = """
<InputProperty name="Input" command="SetInputConnection">
  <ProxyGroupDomain name="groups"><Group name="sources"/><Group name="filters"/></ProxyGroupDomain>
  <DataTypeDomain name="input_type" composite_data_supported="0">
    <DataType value="vtkImageData"/><DataType value="vtkHyperTreeGrid"/>
    <DataType value="vtkUnstructuredGrid"/><DataType value="vtkOverlappingAMR"/>
  </DataTypeDomain>
  <InputArrayDomain name="one_component" attribute_type="any" number_of_components="1"/>
</InputProperty>
"""


#: What a formula consists of.
ARITHMETIC = (ast.Expression, ast.BinOp, ast.UnaryOp, ast.Call, ast.Name, ast.Load, ast.Constant,
              ast.operator, ast.unaryop)


def function_of(text):
    """The function of x, y and z that an expression is."""
    known = {name: each for name, each in vars(math).items() if not name.startswith("_")}
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except SyntaxError:
        raise nestgrid.InvalidInput(f"the function is no expression: {text!r}") from None
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and node.id not in {"x", "y", "z", *known}:
            raise nestgrid.InvalidInput(f"the function has {node.id!r}, but knows only x, y, z and math")
        text_in_it = isinstance(node, ast.Constant) and not isinstance(node.value, (int, float))
        if text_in_it or not isinstance(node, ARITHMETIC):
            raise nestgrid.InvalidInput(f"the function is no formula of x, y and z: {text!r}")
    code = compile(tree, "Function", "eval")

    def function(x, y, z):
        try:
            return float(eval(code, {"__builtins__": {}, **known}, {"x": x, "y": y, "z": z}))
        except (ArithmeticError, TypeError, ValueError) as error:
            where = f"({x:g}, {y:g}, {z:g})"
            raise nestgrid.InvalidInput(f"the function is no number at {where}: {error}") from None

    return function


def properties(*texts):
    """Adds properties in the order in which they are shown."""

    def decorate(kind):
        for text in texts:
            kind = smproperty.xml(text)(kind)
        return kind

    return decorate


class Aborted(Exception):
    """The reader has ended what is drawn."""


def told(measured):
    """What was measured of surfaces, as arrays of field data."""
    for name, key in (("error", "error"), ("distance", "distance"), ("distance back", "distance_back")):
        array = vtkDoubleArray()
        array.SetName(name)
        array.SetNumberOfComponents(3)
        for each in measured:
            array.InsertNextTuple3(each[key], each[key + "_mean"], each[key + "_rms"])
        yield array


class Together:
    """Surfaces of several values as one data set, each triangle of which tells its value."""

    def __init__(self, values, surfaces):
        self._parts = list(zip(values, surfaces))

    @property
    def parts(self):
        return self._parts

    def outlines(self):
        return Together(*zip(*((value, each.outlines()) for value, each in self._parts)))

    def to_vtk(self):
        append = vtkAppendPolyData()
        for value, surface in self._parts:
            data = surface.to_vtk()
            of_triangles = vtkDoubleArray()
            of_triangles.SetName("value")
            of_triangles.SetNumberOfValues(data.GetNumberOfCells())
            of_triangles.Fill(value)
            data.GetCellData().AddArray(of_triangles)
            append.AddInputData(data)
        append.Update()
        return append.GetOutput()


class Drawing(VTKPythonAlgorithmBase):
    """What filters and the reader have in common: options, and poly data as output."""

    def __init__(self, inputs):
        super().__init__(nInputPorts=inputs, nOutputPorts=1, outputType="vtkPolyData")
        # How fine to draw: the first of these that is not 0, else the threshold.
        self._fineness = {"error": 0.0, "distance": 0.0, "max_triangles": 0, "threshold": 0.0}
        self._indicator = {"indicator": "offset"}
        self._collapse = {"collapse": False}
        self._distance_field = {"distance_field": False}
        self._isovalue = 0.0
        self._more_isovalues = []
        self._band = {"values": (0.0, 1.0)}
        self._values = []
        self._scale = {"scale": 1.0}
        self._plane = {"origin": (0.0, 0.0, 0.0), "normal": (0.0, 0.0, 1.0)}
        self._shape = {"kind": "plane", "radius": 1.0, "distance": 0.0, "function": ""}
        self._surface_options = {"normals": True, "cap": False, "at_nodes": False, "cuts": None}
        self._elements = {"elements": False}  # told by triangles: for their outlines
        self._blend = {"blend": 1.0}
        self._lens = {"centre": (0.0, 0.0, 0.0), "radius": 0.0}
        self._region = {"bounds": (0.0,) * 6, "threshold": 0.0}
        self._colours = {"colour_tolerance": 0.0}
        self._places = {"position_error": 0.0}
        self._measure = {"measure": False}

    def _set(self, where, name, value):
        if where[name] != value:
            where[name] = value
            self.Modified()

    def SetThreshold(self, value):
        self._set(self._fineness, "threshold", value)

    def SetError(self, value):
        self._set(self._fineness, "error", value)

    def SetDistance(self, value):
        self._set(self._fineness, "distance", value)

    def SetCollapse(self, value):
        self._set(self._collapse, "collapse", bool(value))

    def SetDistanceField(self, value):
        self._set(self._distance_field, "distance_field", bool(value))

    def SetMaxTriangles(self, value):
        self._set(self._fineness, "max_triangles", value)

    def SetIndicator(self, number):
        self._set(self._indicator, "indicator", INDICATORS[number])

    def SetIsovalue(self, value):
        if value != self._isovalue:
            self._isovalue = value
            self.Modified()

    def AddMoreIsovalue(self, value):
        self._more_isovalues.append(value)
        self.Modified()

    def ClearMoreIsovalues(self):
        self._more_isovalues = []
        self.Modified()

    def SetNormals(self, value):
        self._set(self._surface_options, "normals", bool(value))

    def SetCap(self, value):
        self._set(self._surface_options, "cap", bool(value))

    def SetAtNodes(self, value):
        self._set(self._surface_options, "at_nodes", bool(value))

    def SetCuts(self, number):
        self._set(self._surface_options, "cuts", (None, "linear", "finest")[number])

    def SetOutlines(self, value):
        self._set(self._elements, "elements", bool(value))

    def SetBlend(self, value):
        self._set(self._blend, "blend", value)

    def SetLensCentre(self, x, y, z):
        self._set(self._lens, "centre", (x, y, z))

    def SetLensRadius(self, value):
        self._set(self._lens, "radius", value)

    def SetRegionBounds(self, *bounds):
        self._set(self._region, "bounds", bounds)

    def SetRegionThreshold(self, value):
        self._set(self._region, "threshold", value)

    def SetColourTolerance(self, value):
        self._set(self._colours, "colour_tolerance", value)

    def SetPositionError(self, value):
        self._set(self._places, "position_error", value)

    def SetMeasure(self, value):
        self._set(self._measure, "measure", bool(value))

    def SetBand(self, low, high):
        self._set(self._band, "values", (low, high))

    def AddValue(self, value):
        self._values.append(value)
        self.Modified()

    def ClearValues(self):
        self._values = []
        self.Modified()

    def SetScale(self, value):
        self._set(self._scale, "scale", value)

    def SetShape(self, number):
        self._set(self._shape, "kind", ("plane", "sphere", "cylinder", "function")[number])

    def SetRadius(self, value):
        self._set(self._shape, "radius", value)

    def SetFunction(self, text):
        self._set(self._shape, "function", text)

    def SetSliceDistance(self, value):
        self._set(self._shape, "distance", value)

    def SetOrigin(self, x, y, z):
        self._set(self._plane, "origin", (x, y, z))

    def SetNormal(self, x, y, z):
        self._set(self._plane, "normal", (x, y, z))

    def fineness(self, without=()):
        """What says how fine to draw, as arguments of a field."""
        asked = [name for name, value in self._fineness.items() if value > 0 and name not in without]
        name = asked[0] if asked else "threshold"
        kind = self._indicator if name in ("threshold", "max_triangles") else {}
        return {name: self._fineness[name], **kind, **self.where()}

    def where(self):
        """What holds in a part of space, and how nodes move, as arguments of a field."""
        where = dict(self._blend)
        if self._places["position_error"] > 0:
            where.update(self._places)
        if self._lens["radius"] > 0:
            where["lens"] = (self._lens["centre"], self._lens["radius"])
        bounds = self._region["bounds"]
        if any(bounds):
            box = nestgrid.box(bounds[0::2], bounds[1::2])
            where["region"] = nestgrid.Region(box, self._region["threshold"])
        return where

    def collapsed(self, options):
        """Options with collapses, where these and something to keep are asked for."""
        if self._collapse["collapse"] and "threshold" not in options:
            options = {**options, "collapse": True}
            options.pop("indicator", None)
        return options

    def isosurfaces(self, field):
        values = [self._isovalue, *self._more_isovalues]
        options = {**self.fineness(), **self._surface_options, **self._elements}
        one = {"distance", "max_triangles"} & options.keys()
        if one or self._collapse["collapse"]:
            raise nestgrid.InvalidInput(
                "several isovalues are drawn at a threshold or within an error: by a distance, "
                "within a number of triangles or collapsed a single one is"
            )
        if len(set(values)) < len(values):
            raise nestgrid.InvalidInput("the isovalues have a number twice")
        options["cuts"] = options["cuts"] or "linear"
        return Together(values, field.isosurfaces(values, **options))

    def isosurface(self, field):
        if self._more_isovalues:
            return self.isosurfaces(field)
        options = {**self.fineness(), **self._surface_options, **self._elements}
        if "distance" in options:
            options.update(self._distance_field)
        if not options["cap"]:
            options = self.collapsed(options)
        return field.isosurface(self._isovalue, **options)

    def band(self, field):
        options = self.fineness(without=("distance", "max_triangles"))
        options.update(self._elements, normals=self._surface_options["normals"])
        return field.isoband(*self._band["values"], **options)

    def coloured(self):
        """How finely what has a place of its own is drawn."""
        options = self.collapsed(self.fineness(without=("distance",)))
        return {**options, **self._colours, **self._elements}

    def slice(self, field):
        origin, normal, radius = *self._plane.values(), self._shape["radius"]
        kind = self._shape["kind"]
        shape = {"plane": (origin, normal), "sphere": (origin, radius)}
        shape["cylinder"] = (origin, normal, radius)
        if kind == "function":
            shape["function"] = function_of(self._shape["function"])
        options = self.coloured()
        if options.get("collapse") and kind != "plane" and self._shape["distance"] > 0:
            options["distance"] = self._shape["distance"]
        return field.slice(**{kind: shape[kind]}, **options)

    def boundary(self, field):
        return field.boundary(**self.coloured())

    def isolines(self, field):
        options = self.fineness(without=("distance",))
        if "max_triangles" in options:
            options["max_segments"] = options.pop("max_triangles")
        return field.isolines(self._values, **options)

    def height_field(self, field):
        options = {**self.collapsed(self.fineness(without=("distance",))), **self._elements}
        return field.height_field(self._scale["scale"] or None, **options)

    def drawn(self, field, drawing):
        """What is drawn, and what was measured of its surfaces."""
        surface = drawing(field)
        measured = []
        if self._measure["measure"] and drawing == self.isosurface:
            parts = surface.parts if self._more_isovalues else [(self._isovalue, surface)]
            measured = [field.measure(each, value) for value, each in parts]
        return surface.outlines() if self._elements["elements"] else surface, measured

    def look(self):
        """Tells observers that the drawing goes on, and ends it where one of them asks for that."""
        self.UpdateProgress(self.GetProgress())
        if self.GetAbortExecute():
            raise Aborted

    def draw(self, outInfo, field_of_data, drawing, name):
        """Draws into the output. What the library refuses is empty, with a message in the log."""
        output = vtkPolyData.GetData(outInfo)
        self.SetAbortExecute(0)  # that of the last drawing
        try:
            surface, measured = nestgrid._nestgrid.watched(
                lambda: self.drawn(field_of_data(), drawing), self.look
            )
        except Aborted:
            output.Initialize()
            return
        except (nestgrid.InvalidInput, nestgrid.GridError, nestgrid.IoError) as error:
            print_error(f"nestgrid: {error}")
            return
        data = surface.to_vtk()
        for array in told(measured) if measured else ():
            data.GetFieldData().AddArray(array)
        values = data.GetPointData().GetArray("value")
        if values is not None:
            values.SetName(name)
            data.GetPointData().SetActiveScalars(name)
        output.ShallowCopy(data)


class Filter(Drawing):
    """Keeps the field, and with it what was computed once, while the input stays as it is."""

    def __init__(self):
        super().__init__(1)
        self._field = None
        self._made_of = None

    def FillInputPortInformation(self, port, info):
        info.Set(self.INPUT_REQUIRED_DATA_TYPE(), "vtkImageData")
        info.Append(self.INPUT_REQUIRED_DATA_TYPE(), "vtkHyperTreeGrid")
        info.Append(self.INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid")
        info.Append(self.INPUT_REQUIRED_DATA_TYPE(), "vtkOverlappingAMR")
        return 1

    def array(self, data):
        """The chosen array; None where there is none."""
        chosen = self.GetInputArrayInformation(0)
        if not chosen.Has(vtkDataObject.FIELD_NAME()):
            return None
        if data.IsA("vtkOverlappingAMR"):  # has its arrays in blocks
            data = data.NewIterator().GetCurrentDataObject()
            if data is None:
                return None
        in_cells = chosen.Get(vtkDataObject.FIELD_ASSOCIATION()) == vtkDataObject.CELL
        attributes = data.GetAttributes(vtkDataObject.CELL if in_cells else vtkDataObject.POINT)
        return attributes and attributes.GetArray(chosen.Get(vtkDataObject.FIELD_NAME()))

    def field(self, data):
        array = self.array(data)
        made_of = (data.GetMTime(), array and array.GetMTime(), array and array.GetName())
        if self._field is None or made_of != self._made_of:
            self._field = field_of(data, array)
            self._made_of = made_of
        return self._field

    def request(self, inInfo, outInfo, drawing):
        data = vtkDataObject.GetData(inInfo[0])
        array = self.array(data)
        name = array.GetName() if array else "value"
        self.draw(outInfo, lambda: self.field(data), drawing, name)
        return 1


@smproxy.filter(name="NestgridIsosurface", label="Nestgrid Isosurface")
@properties(
    INPUT, ARRAY, ISOVALUE, MORE_ISOVALUES, THRESHOLD, MAX_TRIANGLES, ERROR, COLLAPSE, DISTANCE,
    DISTANCE_FIELD, INDICATOR, NORMALS, CAP, AT_NODES, CUTS, MEASURE, *OF_SURFACES,
)
class NestgridIsosurface(Filter):
    def RequestData(self, request, inInfo, outInfo):
        return self.request(inInfo, outInfo, self.isosurface)


@smproxy.filter(name="NestgridSlice", label="Nestgrid Slice")
@properties(
    INPUT, ARRAY, PLANE, NORMAL, PLANE_GROUP, SHAPE, THRESHOLD, MAX_TRIANGLES, ERROR, COLLAPSE,
    INDICATOR, COLOUR_TOLERANCE, *OF_SURFACES,
)
class NestgridSlice(Filter):
    def RequestData(self, request, inInfo, outInfo):
        return self.request(inInfo, outInfo, self.slice)


@smproxy.filter(name="NestgridBand", label="Nestgrid Band")
@properties(INPUT, ARRAY, BAND, THRESHOLD, ERROR, INDICATOR, NORMALS, *OF_SURFACES)
class NestgridBand(Filter):
    def RequestData(self, request, inInfo, outInfo):
        return self.request(inInfo, outInfo, self.band)


@smproxy.filter(name="NestgridBoundary", label="Nestgrid Boundary")
@properties(
    INPUT, ARRAY, THRESHOLD, MAX_TRIANGLES, ERROR, COLLAPSE, INDICATOR, COLOUR_TOLERANCE,
    *OF_SURFACES,
)
class NestgridBoundary(Filter):
    def RequestData(self, request, inInfo, outInfo):
        return self.request(inInfo, outInfo, self.boundary)


@smproxy.filter(name="NestgridIsolines", label="Nestgrid Isolines")
@properties(INPUT, ARRAY, VALUES, THRESHOLD, MAX_SEGMENTS, ERROR, INDICATOR, *WHERE)
class NestgridIsolines(Filter):
    def RequestData(self, request, inInfo, outInfo):
        return self.request(inInfo, outInfo, self.isolines)


@smproxy.filter(name="NestgridHeightField", label="Nestgrid Height Field")
@properties(INPUT, ARRAY, SCALE, THRESHOLD, MAX_TRIANGLES, ERROR, COLLAPSE, INDICATOR, *OF_SURFACES)
class NestgridHeightField(Filter):
    def RequestData(self, request, inInfo, outInfo):
        return self.request(inInfo, outInfo, self.height_field)


FILE_NAMES = """
<StringVectorProperty name="FileNames" command="AddFileName" clean_command="ClearFileNames"
    animateable="0" number_of_elements="0" number_of_elements_per_command="1" repeat_command="1"
    panel_visibility="never">
  <FileListDomain name="files"/>
  <Documentation>A file, or one for each time step.</Documentation>
</StringVectorProperty>
"""
FIELD_NAME = """
<StringVectorProperty name="FieldName" command="SetFieldName" number_of_elements="1"
    default_values="">
  <Documentation>The field, where files have several.</Documentation>
</StringVectorProperty>
"""
DRAW = """
<IntVectorProperty name="Draw" command="SetDraw" number_of_elements="1" default_values="0">
  <EnumerationDomain name="enum">
    <Entry value="0" text="Isosurface"/><Entry value="1" text="Slice"/>
  </EnumerationDomain>
  <Documentation>What is drawn of the hierarchy.</Documentation>
</IntVectorProperty>
"""
FREE_ISOVALUE = """
<DoubleVectorProperty name="Isovalue" command="SetIsovalue" number_of_elements="1"
    default_values="0">
  <Documentation>The value on the surface, in the units of the data.</Documentation>
</DoubleVectorProperty>
"""


@smproxy.reader(
    name="NestgridReader",
    label="Nestgrid Reader",
    extensions="nestgrid",
    file_description="nestgrid hierarchies",
)
@properties(
    FILE_NAMES, FIELD_NAME, DRAW, FREE_ISOVALUE, MORE_ISOVALUES, FREE_PLANE, NORMAL, THRESHOLD,
    MAX_TRIANGLES, ERROR, COLLAPSE, DISTANCE, DISTANCE_FIELD, INDICATOR, NORMALS, CAP, AT_NODES,
    CUTS, MEASURE, *OF_SURFACES,
)
class NestgridReader(Drawing):
    """Draws hierarchies from files; their elements are no data of VTK."""

    def __init__(self):
        super().__init__(0)
        self._files = []
        self._name = ""
        self._slices = False
        self._loaded = (None, None)

    def AddFileName(self, name):
        self._files.append(name)
        self.Modified()

    def ClearFileNames(self):
        self._files = []
        self.Modified()

    def SetFieldName(self, name):
        name = name or ""  # ParaView hands over None for an empty one
        if name != self._name:
            self._name = name
            self.Modified()

    def SetDraw(self, what):
        if bool(what) != self._slices:
            self._slices = bool(what)
            self.Modified()

    @smproperty.doublevector(
        name="TimestepValues", information_only="1", si_class="vtkSITimeStepsProperty"
    )
    def GetTimestepValues(self):
        if len(self._files) > 1:
            return [float(i) for i in range(len(self._files))]
        if not self._files:
            return None
        try:
            loaded = self.loaded(self._files[0])
        except (nestgrid.InvalidInput, nestgrid.GridError, nestgrid.IoError):
            return None  # drawing tells why
        return loaded.times if isinstance(loaded, nestgrid.Frames) else None

    def RequestInformation(self, request, inInfo, outInfo):
        info = outInfo.GetInformationObject(0)
        executive = self.GetExecutive()
        times = self.GetTimestepValues()
        info.Remove(executive.TIME_STEPS())
        info.Remove(executive.TIME_RANGE())
        if times:
            for time in times:
                info.Append(executive.TIME_STEPS(), time)
            info.Append(executive.TIME_RANGE(), times[0])
            info.Append(executive.TIME_RANGE(), times[-1])
        return 1

    def loaded(self, path):
        key = (path, self._name)
        if self._loaded[0] != key:
            self._loaded = (key, nestgrid.load(*key))
        return self._loaded[1]

    def field(self, time):
        """The field at a time: of the file that is next to it, or between frames of the only one."""
        if len(self._files) > 1:
            step = min(max(round(time), 0), len(self._files) - 1)
            return self.loaded(self._files[step])
        loaded = self.loaded(self._files[0])
        if not isinstance(loaded, nestgrid.Frames):
            return loaded
        return loaded.at(min(max(time, loaded.times[0]), loaded.times[-1]))

    def RequestData(self, request, inInfo, outInfo):
        info = outInfo.GetInformationObject(0)
        time = 0.0
        if info.Has(self.GetExecutive().UPDATE_TIME_STEP()):
            time = info.Get(self.GetExecutive().UPDATE_TIME_STEP())
        drawing = self.slice if self._slices else self.isosurface
        self.draw(outInfo, lambda: self.field(time), drawing, self._name or "value")
        if self.GetTimestepValues():
            vtkPolyData.GetData(outInfo).GetInformation().Set(
                vtkDataObject.DATA_TIME_STEP(), float(time)
            )
        return 1
