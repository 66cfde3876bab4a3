"""Makes the objects of a scene: from files, shapes, points and text."""
import numpy as np

from dspace._core import wire
from dspace._core.fields import (about, array_of, file_path, flag, integers, keywords, number, numbers, put,
                                 put_color, put_given, put_vector, reject, shown, word)
from dspace._core.replies import warn
from dspace.cameras.camera import put_projection
from dspace.errors import InvalidArgument, NotFound, WrongType
from dspace.frames.frame import put_pose
from dspace.frames.poses import Pose, quaternion_of_axis, to_pose
from dspace.objects.assemblies import is_assembly, load_assembly
from dspace.objects.graphics import (UP, GraphicsObject, Primitive, Stars, Text, TiltMarker, Trail, put_rotation,
                                     put_settings)
from dspace.objects.meshes import Mesh, put_mesh_levels
from dspace.objects.models import Model
from dspace.objects.polydata import make_polydata
from dspace.objects.robots import Robot
from dspace.stars.catalog import StarCatalog, bright_stars
from dspace.stars.lines import GRID_COLORS, RADIUS, constellation_names, constellations
from dspace.stars.lines import grid as sky_grid

# The rotation that turns a file's axis to Z.
_TURNS = {"z": (1, 0, 0, 0), "y": tuple(quaternion_of_axis("x", 90)),
          "x": tuple(quaternion_of_axis("y", -90)), "-z": (0, 1, 0, 0)}


# The settings of objects that a URDF accepts.
_ROBOT = ("name", "fragment", "position", "quaternion", "pose")


def _points(points, about):
    array = array_of(points, "points", "an array (n, 3)", about)
    if array.size and (array.ndim != 2 or array.shape[1] != 3):
        raise InvalidArgument(f"{about}: the points have shape {array.shape}; accepted: (n, 3)")
    return array


class ObjectFactory:
    """Makes the objects of a Scene, which delegates to it and documents what all of its functions accept."""

    def __init__(self, scene):
        self._scene = scene

    def load(self, path, frame=None, ornamental=False, scale=1.0, up=None, rotation=None,
             levels=(), strict=False, point_cloud=False, frames=False, lights=False, **settings):
        """A model file (glTF, GLB, VRML, OBJ, STL, PLY) as a GraphicsObject; a URDF as a Robot; the
        folder of a frames.json, or that file, as an Assembly.

        scale: metres per unit of the file. up: the file's axis that becomes Z ("z", "y", "x", "-z"; default "z"). glTF
        files usually need "y". rotation: a quaternion that turns the model further. levels: coarser files as (path,
        pixels) pairs; each is drawn while the object appears larger than `pixels`. The last one should have 0, and
        `path` is then also a (path, pixels) pair.
        strict: a missing texture or mesh, and damage that could be repaired, raise an error. Otherwise they give a
        warning, and an orange cube, or the edges of a box of the size stated in its glTF, replaces a URDF's mesh.
        frames: a frame for each node of the file, so that parts can be moved; the result is then a Model. Its settings
        are those of each object; `position`, `quaternion` and a uniform `stretch` place the model.
        lights: with frames, the lights of a glTF become lights of the scene; their lux or candela become `intensity`.
        point_cloud: shows a file of points, `point_size` pixels large; a file without faces is otherwise rejected.
        A URDF (links to frames, joints as `robot.joints[name].position` in degrees or metres, meshes
        from beside it) and a frames.json take frame, scale, up, rotation, ornamental, strict, name,
        fragment, and position, quaternion or `pose` of their base frame. A URDF takes levels too: URDF files of the same
        links with coarser visuals, as many for each link or none; each visual changes by its own size."""
        first, pixels = path if isinstance(path, tuple) and len(path) == 2 else (path, 0.0)
        first = file_path(first, "the path", "model")
        label = f"file {first!r}"
        turn = word("z" if up is None else up, UP, "up", label)
        if not isinstance(levels, (list, tuple)):
            reject(label, "levels", levels, "a list of (path, pixels)", WrongType)
        kind = ("URDF" if first.lower().endswith(".urdf")
                else "frames.json" if is_assembly(first) else None)
        if kind:
            pixels, scale = (number(value, name, label)
                             for name, value in (("pixels", pixels), ("the scale", scale)))
            if (flag(point_cloud, "point_cloud", label) or flag(frames, "frames", label)
                    or flag(lights, "lights", label)):
                raise InvalidArgument(f"{label}: point_cloud={point_cloud!r}, frames={frames!r} and lights={lights!r}; "
                                      f"accepted for a {kind}: none of these")
            if kind != "URDF" and (len(levels) or pixels):
                raise InvalidArgument(f"{label}: levels {levels!r} and {pixels:g} pixels; accepted for a {kind}: neither")
            keywords(settings, _ROBOT, f"{label}, a {kind}")
            base = self._base_pose(label, scale, up or "z", rotation, settings)
            if kind == "URDF":
                return self._load_robot(first, pixels, levels, base, frame, ornamental, strict, **settings)
            return self._load_assembly(first, base, frame, ornamental, strict, **settings)
        command = self._scene._command()
        if flag(frames, "frames", label):
            command.import_nodes.lights = flag(lights, "lights", label)
            message = getattr(command.import_nodes, "import")
        elif flag(lights, "lights", label):
            raise InvalidArgument(f"{label}: lights=True; accepted with frames=True")
        else:
            message = command.import_object
        put_settings(self._scene, message.object, label, frame=frame, ornamental=ornamental, **settings)
        put(message.level.add(), label, path=first, minimum_pixels=pixels)
        self._put_levels(message, levels, label)
        put(message, label, scale=scale, up=turn, strict=strict, point_cloud=point_cloud)
        if rotation is not None:
            put_rotation(message.rotation, rotation, "the rotation", label)
        reply = self._scene._execute(command)
        made = Model(self._scene, reply.nodes) if frames else GraphicsObject(self._scene, reply.object.object)
        if up is None and first.lower().endswith((".gltf", ".glb")):
            warn(f"{label}: in glTF Y is up, and nothing is turned unasked; if it lies on its side give "
                 "up='y', else up='z'")
        return made

    @staticmethod
    def _put_levels(message, levels, label):
        for level in levels:
            if not isinstance(level, (tuple, list)) or len(level) != 2:
                raise WrongType(f"{label}: a level is {shown(level)}; accepted: (path, pixels)")
            put(message.level.add(), label, path=file_path(level[0], "a level's path", label),
                minimum_pixels=level[1])

    @staticmethod
    def _base_pose(label, scale, up, rotation, settings):
        """Takes what places a base frame out of the settings."""
        with about(label):
            base = to_pose(settings.pop("position", None), settings.pop("quaternion", None), None,
                           settings.pop("pose", None))
            if up != "z" or rotation is not None or scale != 1.0:
                turn = Pose(quaternion=_TURNS[up], scale=scale)
                base = base @ (turn if rotation is None else Pose(quaternion=rotation) @ turn)
        return base

    def _load_assembly(self, path, base, frame, ornamental, strict, **settings):
        return load_assembly(self._scene, path, base, frame, ornamental=ornamental, strict=strict, **settings)

    def _load_robot(self, path, pixels, levels, base, frame, ornamental, strict, name=None, fragment=None):
        label = f"file {path!r}"
        command = self._scene._command()
        message = command.load_robot
        put(message, label, path=path, name="" if name is None else name, frame=self._scene._frame_id(frame),
            fragment=self._scene._fragment_name(fragment), strict=strict, minimum_pixels=pixels)
        self._put_levels(message, levels, label)
        put_pose(message.pose, base)
        message.nature = 1 if flag(ornamental, "ornamental", label) else 0
        return Robot(self._scene, self._scene._execute(command).robot)

    def _primitive(self, settings, shape, **fields):
        command = self._scene._command()
        label = put_settings(self._scene, command.create_primitive.object, shape, **settings)
        message = getattr(command.create_primitive, shape)
        message.SetInParent()
        put_given(message, label, **fields)
        return command

    def _make(self, command, kind=Primitive):
        return kind(self._scene, self._scene._execute(command).object.object)

    def add_box(self, size, **settings):
        """Adds a centered box. size: three edges [m]."""
        command = self._primitive(settings, "box")
        put_vector(command.create_primitive.box.size, size, "the size", "box")
        return self._make(command)

    def add_sphere(self, radius, resolution=None, **settings):
        """Centred, poles on Z [m]."""
        return self._make(self._primitive(settings, "sphere", radius=radius, resolution=resolution))

    def add_cylinder(self, radius, height, resolution=None, **settings):
        """Centred, along Z [m]."""
        return self._make(self._primitive(settings, "cylinder", radius=radius, height=height,
                                          resolution=resolution))

    def add_cone(self, radius, height, resolution=None, **settings):
        """Along Z, the apex at +height / 2 [m]."""
        return self._make(self._primitive(settings, "cone", radius=radius, height=height,
                                          resolution=resolution))

    def add_plane(self, width, height, **settings):
        """Centred, in XY, facing +Z [m]."""
        return self._make(self._primitive(settings, "plane", width=width, height=height))

    def add_disc(self, radius, resolution=None, **settings):
        """Centred, in XY, facing +Z [m]."""
        return self._make(self._primitive(settings, "disc", radius=radius, resolution=resolution))

    def add_torus(self, radius, tube, resolution=None, **settings):
        """About Z; radius to the middle of the tube [m]."""
        return self._make(self._primitive(settings, "torus", radius=radius, tube=tube,
                                          resolution=resolution))

    def add_arrow(self, length, ornamental=True, **settings):
        """From the origin along +X [m]."""
        return self._make(self._primitive({**settings, "ornamental": ornamental}, "arrow",
                                          length=length))

    def add_axes(self, length, ornamental=True, **settings):
        """X red, Y green, Z blue, from the origin [m]."""
        return self._make(self._primitive({**settings, "ornamental": ornamental}, "axes",
                                          length=length))

    def add_lines(self, points, closed=False, ornamental=True, **settings):
        """One polyline through an array (n, 3), or a list of several such [m]."""
        several = (isinstance(points, (list, tuple)) and len(points)
                   and isinstance(points[0], (list, tuple, np.ndarray)) and len(points[0])
                   and hasattr(points[0][0], "__len__"))
        lines = [_points(line, "lines") for line in (points if several else [points])]
        command = self._primitive({**settings, "ornamental": ornamental}, "lines", closed=closed)
        message = command.create_primitive.lines
        wire.put_array(message, "point", np.concatenate([line.ravel() for line in lines]))
        if several:
            message.count.extend(len(line) for line in lines)
        return self._make(command)

    def add_points(self, points, ornamental=True, **settings):
        """Points of an array (n, 3) [m], `point_size` pixels large."""
        command = self._primitive({**settings, "ornamental": ornamental}, "points")
        wire.put_array(command.create_primitive.points, "point", _points(points, "points"))
        return self._make(command)

    def add_frustum(self, length, size, fov_deg=None, height=None, tangents=None, near=None,
                    ornamental=True, **settings):
        """What a camera (X right, Y down, Z forward) with an image of `size` (width, height) pixels
        sees up to `length` along Z [m]; the projection as in Camera.set_projection."""
        width, rows = integers(size, 2, "the size", "frustum", "(width, height), two integers")
        command = self._primitive({**settings, "ornamental": ornamental}, "frustum", length=length,
                                  width=width, height=rows)
        put_projection(command.create_primitive.frustum.projection, fov_deg, height, tangents, near,
                       about="frustum")
        return self._make(command)

    def add_goal(self, height, ornamental=True, **settings):
        """A pole along Z with a flag and a ring on the ground [m]."""
        return self._make(self._primitive({**settings, "ornamental": ornamental}, "goal",
                                          height=height))

    def add_tilt_marker(self, radius, tilt_deg=0.0, warn_deg=None, limit_deg=None, ornamental=True,
                        **settings):
        """A ring with a needle: green upright, yellow at warn_deg (15), red from limit_deg (30)."""
        command = self._primitive({**settings, "ornamental": ornamental}, "tilt", radius=radius,
                                  tilt_deg=tilt_deg, warn_deg=warn_deg, limit_deg=limit_deg)
        return self._make(command, TiltMarker)

    def add_text(self, text, height, ornamental=True, **settings):
        """Adds flat text in XY, readable from +Z. A capital letter is `height` metres high.

        The text may use any left-to-right alphabet that DejaVu Sans supports."""
        command = self._scene._command()
        put_settings(self._scene, command.create_text.object, "text", ornamental=ornamental, **settings)
        put(command.create_text, "text", text=text)
        put(command.create_text.solid, "text", height=height)
        return self._make(command, Text)

    def add_label(self, text, font_size=None, color=None, background=None, background_opacity=None,
                  offset=None, ornamental=True, **settings):
        """Adds a label that faces the camera; font_size and offset (right, up) in pixels.

        The alphabets are those of add_text."""
        command = self._scene._command()
        put_settings(self._scene, command.create_text.object, "label", ornamental=ornamental, **settings)
        put(command.create_text, "label", text=text)
        label = command.create_text.label
        label.SetInParent()
        for field, value in (("color", color), ("background", background)):
            if value is not None:
                put_color(getattr(label, field), value, field, "label")
        put_given(label, "label", font_size=font_size, background_opacity=background_opacity)
        if offset is not None:
            label.offset_x, label.offset_y = numbers(offset, 2, "the offset", "label")
        return self._make(command, Text)

    def add_prop(self, prop, **settings):
        """Shows a vtkProp3D of this process as an object of the scene: a volume, a glyph mapper's actor, an image slice.

        VTK draws it in every viewport, after its own pipeline is brought up to date. Its coordinates, with its position
        and user matrix, are those of the object. The scene's lights shade it (ambient light does not), its vtkProperty
        gives its look. Opaque props are in depth and label planes and can be picked; translucent ones and volumes are
        blended over what is behind them and are in no plane.

        Accepted: vtkActor, vtkVolume with a vtkGPUVolumeRayCastMapper or a vtkSmartVolumeMapper, vtkImageSlice, and
        vtkAssembly of these, each in no renderer and no other scene. settings: as for other objects, but for materials,
        line_width and point_size. In process only: recordings and servers leave props out."""
        client = self._scene._client
        session = client.local()
        kind = "vtkProp3D"
        if not hasattr(prop, "IsA") or not prop.IsA(kind):
            reject(f"scene {self._scene.name!r}", "the prop", prop, f"a {kind}: a volume, an actor, an image slice",
                   WrongType)
        mapper = prop.GetMapper() if prop.IsA("vtkVolume") else None
        if mapper is not None and mapper.IsA("vtkSmartVolumeMapper") and mapper.GetRequestedRenderMode() not in (0, 2):
            raise InvalidArgument(f"scene {self._scene.name!r}: the vtkSmartVolumeMapper draws on the CPU, which does "
                                  "not see the scene's depth; accepted: SetRequestedRenderModeToGPU(), or the default")
        command = self._scene._command()
        put_settings(self._scene, command.create_drawn.object, "prop", **settings)
        command.create_drawn.drawer = f"vtk:{prop.GetClassName()}"
        session.OfferProp(prop)
        try:
            return self._make(command, GraphicsObject)
        finally:
            session.OfferProp(None)

    def add_drawn(self, drawer, parameters=b"", **settings):
        """An object that a plug-in of this process draws (see Session.load_plugin and Documentation/OwnObjects.md).

        drawer: the name that the plug-in registered. parameters: bytes, whose meaning is the plug-in's.
        settings: as for other objects. A recording has the name and the parameters, not what is drawn."""
        label = f"scene {self._scene.name!r}"
        session = self._scene._client.local()
        if not isinstance(drawer, str) or not drawer or drawer.startswith("vtk:"):
            reject(label, "the drawer", drawer, "the name that a plug-in registered")
        if not isinstance(parameters, (bytes, bytearray, memoryview)):
            reject(label, "the parameters", parameters, "bytes", WrongType)
        names = session.GetDrawerNames().splitlines()
        if drawer not in names:
            known = ", ".join(map(repr, names)) or "none"
            raise NotFound(f"{label}: no plug-in has registered drawer {shown(drawer)}; registered: {known} "
                           "(Session.load_plugin)", label)
        command = self._scene._command()
        put_settings(self._scene, command.create_drawn.object, "drawn", **settings)
        command.create_drawn.drawer = drawer
        command.create_drawn.parameters = bytes(parameters)
        return self._make(command, GraphicsObject)

    def add_trail(self, capacity=10000, minimum_spacing=0.0, fade=False, ornamental=True,
                  **settings):
        """Adds a line through the last `capacity` points given to Trail.append, each at least `minimum_spacing` [m]
        from the one before. fade: older points are fainter."""
        command = self._scene._command()
        message = command.create_trail
        label = put_settings(self._scene, message.object, "trail", ornamental=ornamental, **settings)
        put(message, label, capacity=capacity, minimum_spacing=minimum_spacing, fade=fade)
        return self._make(command, Trail)

    def add_stars(self, stars=None, epoch=2000.0, observer=(0.0, 0.0, 0.0), gain=1.0, spread=0.6, faintest=None,
                  **settings):
        """Adds stars behind everything else, with their true light and colour. Returns a Stars.

        stars: a dspace.stars.StarCatalog; by default the Bright Star Catalogue (dspace.stars.bright_stars()). Their axes
        are those of `frame`: X to the equinox, Z to the north pole. epoch [Julian year] and observer (x, y, z [au] from the
        solar system's barycentre): for proper motion and parallax.
        gain: factor on their light, 0 to 1e12. With 1 a picture that is exposed for sunlit ground shows none, as a
        photograph would; 3e4 or so shows them to the eye. Physical pictures have 1.
        spread: standard deviation of the Gaussian of each [pixels], 0.2 to 20. faintest: the limiting V magnitude; None:
        all. Orthographic cameras see none."""
        catalog = bright_stars() if stars is None else stars
        if not isinstance(catalog, StarCatalog):
            reject("stars", "the catalogue", stars, "a dspace.stars.StarCatalog (bright_stars(), read_stars(path))", WrongType)
        command = self._scene._command()
        message = command.create_stars
        label = put_settings(self._scene, message.object, "stars", **settings)
        message.direction = np.ascontiguousarray(catalog.directions(epoch, observer), "<f4").tobytes()
        message.magnitude = np.ascontiguousarray(catalog.magnitude, "<f4").tobytes()
        message.color_index = np.ascontiguousarray(catalog.color_index, "<f4").tobytes()
        put(message.look, label, gain=gain, spread=spread)
        put_given(message.look, label, faintest=faintest)
        return self._make(command, Stars)

    def add_sky_grid(self, kind="equatorial", step_deg=15.0, color=None, **settings):
        """Adds meridians and parallels of the sky, 1e17 m away, as an ornament without label. Returns a Mesh.

        kind: "equatorial" (right ascension and declination) or "ecliptic" (of J2000), in a `frame` whose axes are those of
        J2000 (X to the equinox, Z to the north pole); "horizon" (azimuth and elevation), in a frame of a site with Z up.
        step_deg: between lines, 1 to 90, a whole part of 90. Lines are a circle each; those of Z's poles end beside them.
        color: default blue (equatorial), yellow (ecliptic), or green (horizon)."""
        points, lines = sky_grid(kind, step_deg, "sky grid")
        color = GRID_COLORS[kind] if color is None else color
        return self._add_sky_lines(points, lines, f"{kind} grid", color, settings)

    def add_constellations(self, path, color=(0.35, 0.5, 0.45), **settings):
        """Adds the figures of constellations, 1e17 m away, as an ornament without label. Returns a Mesh.

        path: a GeoJSON file of lines whose longitudes are right ascensions and whose latitudes are declinations [deg], such
        as constellations.lines.json of d3-celestial (O. Frohn, BSD-3). Arcs of great circles. The axes of `frame` are
        those of J2000, as for add_stars."""
        points, lines = constellations(path)
        return self._add_sky_lines(points, lines, "constellations", color, settings)

    def add_constellation_names(self, path, color=(0.6, 0.75, 0.7), font_size=14, **settings):
        """Adds the Latin names of the constellations of a file that add_constellations reads, each in the middle of its
        figure, as ornamental labels. Returns a list of Text; a `fragment` shows and hides all of them at once.

        color, font_size [pixels]: as for add_label. A figure whose id is not an abbreviation of the IAU keeps it as its
        name."""
        made = []
        given = {"color": color, "font_size": font_size, "background_opacity": 0.0, "pickable": False, **settings}
        size = number(font_size, "the font size", "constellation names")
        for name, direction in constellation_names(path):
            try:
                # A letter is about half as wide as the font is high: the word's middle is at the place.
                made.append(self.add_label(name, position=RADIUS * direction, name=self._free(f"constellation {name}"),
                                           **{"offset": (-0.26 * size * len(name), -0.35 * size), **given}))
            except Exception:
                for text in made:
                    text.remove()
                raise
        return made

    def _free(self, name):
        """The name, or with a number the first that no object has."""
        taken = self._scene.objects
        return name if name not in taken else next(f"{name} {i}" for i in range(2, len(taken) + 3)
                                                   if f"{name} {i}" not in taken)

    def _add_sky_lines(self, points, lines, name, color, settings):
        given = {"lit": False, "ornamental": True, "pickable": False, "color": color, **settings}
        if given.get("name") is None:
            given["name"] = self._free(name)
        return self.add_mesh(points, lines=lines, **given)

    def add_mesh(self, points, triangles=None, lines=None, normals=None, colors=None, scalars=None, colormap=None,
                 low=None, high=None, tcoords=None, pixels=0.0, levels=(), **settings):
        """Adds an object made of arrays. Returns a Mesh, whose update() replaces them.

        points: (n, 3) [m]. Positions far from the origin keep the precision of doubles: an origin is subtracted before
        they become single precision. triangles: (m, 3) indices of points, counter-clockwise seen from outside. lines:
        (k, 2). Without both, points are drawn, point_size pixels large. A dict {name: indices} makes named parts
        (GraphicsObject.part). normals: (n, 3), unit; without them they are computed, with creases at edges sharper than
        30 degrees. tcoords: (n, 2) of the `texture`, v = 0 is the image's bottom row.
        colors: (n, 3 or 4), bytes or numbers from 0 to 1, sRGB, one for each point; or one for each triangle (then each
        line). scalars: (n,), likewise, mapped to colors: colormap is a list of colors, evenly spaced from `low` to
        `high` (default: viridis, least to greatest value); NaN is grey. If there are as many points as triangles, the
        values are those of points.
        levels: coarser meshes as (dict of these arrays, pixels) pairs; each is drawn while the object appears larger than
        `pixels`, and the finest while it appears larger than the argument `pixels`."""
        given = {"points": points, "triangles": triangles, "lines": lines, "normals": normals, "colors": colors,
                 "scalars": scalars, "colormap": colormap, "low": low, "high": high, "tcoords": tcoords}
        command = self._scene._command()
        label = put_settings(self._scene, command.create_mesh.object, "mesh", **settings)
        put_mesh_levels(command.create_mesh, label, given, pixels, levels)
        return Mesh(self._scene, self._scene._execute(command).object.object, given, pixels, levels)

    def add_polydata(self, source, array=None, lookup_table=None, low=None, high=None, part="", live=True, pixels=0.0,
                     levels=(), **settings):
        """Adds the geometry of VTK as an object. Returns a PolyData, whose update() reads it again.

        source: a vtkPolyData, a VTK algorithm, its output port, or a PyVista mesh (of another type than PolyData: its
        surface). Vertices, lines, triangle strips and polygons, also concave ones, are drawn, with normals and texture
        coordinates. Points without normals get computed ones, with creases at edges sharper than 30 degrees.
        array: the name of an array of the points, or else of the cells, that colors it; None: the active scalars of the
        points, or else of the cells; "": none. Arrays of bytes with 3 or 4 components are colors. lookup_table: a
        vtkScalarsToColors; None: VTK's default table, from the array's least to its greatest value (of vectors: the
        magnitude). low, high: its range.
        part: name of the part. levels: coarser sources as (source, pixels) pairs, as in add_mesh.
        live: an algorithm is updated when it, what is upstream, or the lookup table has changed: before each picture,
        pick and new time of this session, and before a recording begins or ends. A pipeline that raises or reports an
        error raises dspace.InvalidArgument there, once, and the object stays as it was. A vtkPolyData that changes is
        read again by update()."""
        return make_polydata(self._scene, source, settings, array=array, lookup_table=lookup_table, low=low, high=high,
                             part=part, live=live, pixels=pixels, levels=levels)
