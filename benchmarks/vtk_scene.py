"""A scene drawn by VTK's renderer without a window, as well as it does without extra passes.

Everything that is alike becomes one actor, as one would for speed: opaque items and hyperedges
together, with a colour at each vertex, and what is translucent. Lights, camera and background are
the scene's; four samples in a pixel. With shadows there is a ground to catch them, which shows, and
edges are smooth by drawing larger (VTK's shadows know no samples).
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
import vtk
from numpy.typing import NDArray
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

from app.output.draft_scene import Normalization, draft_scene
from app.scene.color import srgb_from_linear
from app.scene.scene import Light, Node, Scene

os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")  # at its first one

SAMPLES = 4


def draw(scene: Scene, width: int, height: int, *, shadows: bool = False) -> NDArray[np.uint8]:
    """The picture (height, width, 3) as VTK draws it; everything is made anew each time."""
    renderer = vtk.vtkRenderer()
    actors = _actors(scene)
    if shadows:
        actors += [_ground(scene, node) for node in scene.nodes if node.shows == "ground"]
    for actor in actors:
        renderer.AddActor(actor)
    renderer.RemoveAllLights()
    renderer.AutomaticLightCreationOff()
    for light in _lights(scene.lights):
        renderer.AddLight(light)
    background = (1.0, 1.0, 1.0) if scene.background is None else scene.background
    renderer.SetBackground(*srgb_from_linear(np.array(background)))
    if shadows:
        _cast_shadows(renderer)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(width, height)
    window.SetMultiSamples(0 if shadows else SAMPLES)
    window.AddRenderer(renderer)
    _look(renderer, scene)
    window.Render()
    pixels = _pixels(window)
    window.Finalize()
    return pixels


def _actors(scene: Scene) -> list[Any]:
    """Two, or one: VTK is given the very arrays that the draft gives to OpenGL."""
    draft = draft_scene(scene, Normalization(np.zeros(3), 1.0))
    colors = np.round(255 * srgb_from_linear(draft.table[:, 0].astype(np.float64)))
    colors[:, 3] = np.round(255 * draft.table[:, 0, 3])
    opaque = sum(part.count for part in draft.sections if not part.is_clear)
    actors = []
    for faces in (draft.faces[:opaque], draft.faces[opaque:]):
        if not len(faces):
            continue
        data = vtk.vtkPolyData()
        points = vtk.vtkPoints()
        points.SetData(numpy_to_vtk(draft.positions, deep=False))
        data.SetPoints(points)
        data.SetPolys(_cells(faces))
        data.GetPointData().SetNormals(numpy_to_vtk(draft.normals, deep=False))
        shown = colors[draft.rows].astype(np.uint8)
        data.GetPointData().SetScalars(numpy_to_vtk(shown, array_type=vtk.VTK_UNSIGNED_CHAR))
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(data)
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetSpecular(0.25)
        actor.GetProperty().SetSpecularPower(30)
        actor.GetProperty().SetAmbient(0.25)
        actor.GetProperty().BackfaceCullingOn()
        actors.append(actor)
    return actors


def _cells(faces: NDArray[np.uint32]) -> Any:
    cells = vtk.vtkCellArray()
    starts = np.arange(0, 3 * len(faces) + 1, 3, dtype=np.int64)
    corners = np.ascontiguousarray(faces.reshape(-1), dtype=np.int64)
    cells.SetData(
        numpy_to_vtkIdTypeArray(starts, deep=True), numpy_to_vtkIdTypeArray(corners, deep=True)
    )
    return cells


def _ground(scene: Scene, node: Node) -> Any:
    """A plane in the colour of the background, which shows nothing but shadows."""
    height = node.translation[2]
    low, high = scene.bounds
    middle, reach = (low + high) / 2, float(np.linalg.norm(high - low))
    plane = vtk.vtkPlaneSource()
    plane.SetOrigin(middle[0] - reach, middle[1] - reach, height)
    plane.SetPoint1(middle[0] + reach, middle[1] - reach, height)
    plane.SetPoint2(middle[0] - reach, middle[1] + reach, height)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(plane.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(1.0, 1.0, 1.0)
    return actor


def _lights(lights: Sequence[Light]) -> list[Any]:
    total = sum(light.illuminance for light in lights)
    made = []
    for light in lights:
        sun = vtk.vtkLight()
        sun.SetLightTypeToSceneLight()
        sun.SetPositional(0)
        sun.SetFocalPoint(0.0, 0.0, 0.0)
        sun.SetPosition(*(-1000.0 * np.array(light.direction)))
        sun.SetColor(*light.color)
        sun.SetIntensity(0.95 * light.illuminance / total)
        made.append(sun)
    return made


def _cast_shadows(renderer: Any) -> None:
    shadows = vtk.vtkShadowMapPass()
    shadows.GetShadowMapBakerPass().SetResolution(1536)
    passes = vtk.vtkRenderPassCollection()
    passes.AddItem(shadows.GetShadowMapBakerPass())
    passes.AddItem(shadows)
    sequence = vtk.vtkSequencePass()
    sequence.SetPasses(passes)
    camera = vtk.vtkCameraPass()
    camera.SetDelegatePass(sequence)
    smooth = vtk.vtkSSAAPass()
    smooth.SetDelegatePass(camera)
    renderer.SetPass(smooth)


def _look(renderer: Any, scene: Scene) -> None:
    camera, seen = renderer.GetActiveCamera(), scene.camera
    camera.SetPosition(*seen.position)
    camera.SetFocalPoint(*seen.target)
    camera.SetViewUp(*seen.up)
    if seen.vertical_angle is not None:
        camera.SetViewAngle(float(np.degrees(seen.vertical_angle)))
    elif seen.height is not None:
        camera.ParallelProjectionOn()
        camera.SetParallelScale(seen.height / 2)
    renderer.ResetCameraClippingRange()


def _pixels(window: Any) -> NDArray[np.uint8]:
    width, height = window.GetSize()
    found = vtk.vtkUnsignedCharArray()
    window.GetPixelData(0, 0, width - 1, height - 1, 0, found, 0)
    pixels: NDArray[np.uint8] = vtk_to_numpy(found).reshape(height, width, 3)[::-1]
    return np.ascontiguousarray(pixels)
