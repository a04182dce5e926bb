# SPDX-License-Identifier: GPL-3.0-or-later
# blender -b --factory-startup --python-exit-code 1 --python check_glb_blender.py -- FILE.glb FRAME_RATE
# Imports the file and prints one line of JSON: frames, frame rate, objects, vertices of the skin, and how far its vertices move (metres).
import json
import sys

import bpy
import numpy

# Debian's Blender 3.4 comes with a NumPy that has dropped names which its glTF importer still uses.
for plain in (bool, int, float, object):
    if plain.__name__ not in numpy.__dict__:
        setattr(numpy, plain.__name__, plain)

path = sys.argv[sys.argv.index("--") + 1]
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = int(sys.argv[sys.argv.index("--") + 2])
bpy.ops.import_scene.gltf(filepath=path)

keys = [f for action in bpy.data.actions for f in action.frame_range]
first, last = min(keys), max(keys)
skin = bpy.data.objects["skin"]


def posed():
    evaluated = skin.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    points = numpy.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", points)
    evaluated.to_mesh_clear()
    return points.reshape(-1, 3)


low = high = None
for frame in numpy.arange(first, last + 0.5, 5):
    scene.frame_set(int(round(frame)))
    points = posed()
    low = points if low is None else numpy.minimum(low, points)
    high = points if high is None else numpy.maximum(high, points)

travel = numpy.linalg.norm(high - low, axis=1)
print("PHIZ " + json.dumps({
    "frames": int(round(last - first)) + 1,
    "objects": sorted(o.name for o in bpy.data.objects),
    "skin_vertices": len(low),
    "moving_vertices": int((travel > 1e-4).sum()),
    "largest_travel": float(travel.max()),
    "finite": bool(numpy.isfinite(low).all() and numpy.isfinite(high).all()),
}))
