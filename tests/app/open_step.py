# Opens the STEP file named by TOOTHPATH_STEP in FreeCAD and writes what FreeCAD thinks of it to TOOTHPATH_STEP_SEEN,
# as JSON: freecadcmd open_step.py < /dev/null
import json
import os

import Part

shape = Part.Shape()
shape.read(os.environ["TOOTHPATH_STEP"])
places, triangles = shape.tessellate(float(os.environ["TOOTHPATH_DEFLECTION"]))
volume = sum(places[a].dot(places[b].cross(places[c])) for a, b, c in triangles) / 6
box = shape.BoundBox
seen = {
    "type": shape.ShapeType,
    "valid": shape.isValid(),
    "closed": shape.isClosed(),
    "solids": len(shape.Solids),
    "shells": len(shape.Shells),
    "faces": len(shape.Faces),
    "edges": len(shape.Edges),
    "volume_of_facets": volume,  # shape.Volume integrates long trimmed cones to some 0.3 % only
    "volume": shape.Volume,
    "area": shape.Area,
    "box": [box.XMin, box.YMin, box.ZMin, box.XMax, box.YMax, box.ZMax],
}
with open(os.environ["TOOTHPATH_STEP_SEEN"], "w") as out:
    json.dump(seen, out)
