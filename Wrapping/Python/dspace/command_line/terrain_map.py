"""Orthographic pictures from straight above: the raster's extent on a plane, or the disc of a body.

A clipmap shows fewer posts farther from its camera. The picture is therefore composed of tiles, each from a camera
right above its middle. The camera is low enough that the tile shows one level of posts, and high enough that the posts
of this level are about as close as pixels. The cameras are parallel and share edges, so the tiles join exactly."""
import math

import numpy as np

from dspace.command_line import terrain_relief

BESIDE = (1.0, 1.0, 1.0)
SKY = (0.0, 0.0, 0.0)
FILL = 0.046  # of the sun
BRIGHTNESS = 1.3  # of the sun, so that level ground at the default angles has about its own color
LIGHT = (FILL * BRIGHTNESS, BRIGHTNESS)  # of a surface that faces the sun: fill, sun
# In posts of a level of 252 cells. Within 90 posts of the camera a level is drawn without blending; below 60 posts a
# finer level is drawn as well.
REACH = 80
ABOVE = 75
FINE = 100.0  # [m]: true light shows the relief of most ground at closer pixels, so that these maps are shaded at first


def fitted_size(width, height, longer):
    """Returns a size in pixels with that aspect ratio, whose longer side is `longer`."""
    shrink = longer / max(width, height)
    return max(1, round(width * shrink)), max(1, round(height * shrink))


def level_of(ground, pixel):
    """Returns the level whose posts are about `pixel` metres apart, or closer."""
    return min(max(0, math.floor(math.log2(pixel / ground.post))), ground.levels - 1)


def tiles(size, side):
    """Yields (x, y, width, height) in pixels of the tiles of a picture."""
    for y in range(0, size[1], side):
        for x in range(0, size[0], side):
            yield x, y, min(side, size[0] - x), min(side, size[1] - y)


def light_view(view, options):
    """Sets the light of a viewport as the options ask for it."""
    view.set(fill=FILL, shadows=options.shadows)


def draw_with_relief(options, size, pixel, draw, surface, sun):
    """Draws a map, which the renderer shades or, where true light does not show its relief, terrain_relief. Returns the
    picture and what was done, as a text.

    draw(lit, away): a function that draws it as draw_tiles does. surface(away): a function that returns the heights and
    the normals that terrain_relief takes. sun: the direction towards it in the axes of the normals."""
    factor = 1.0 if options.shadows else options.exaggeration
    if factor == 1:
        return draw(True, None)
    away = np.empty(size[::-1])
    lit = factor is None and pixel < FINE
    picture, told = draw(lit, away)
    heights, normals = surface(away)
    if factor is None:
        factor = terrain_relief.automatic(heights, normals, pixel)
    if lit != (factor == 1):
        picture, told = draw(not lit, None)
    if factor != 1:
        picture = terrain_relief.shade(picture, heights, normals, pixel, factor, sun, LIGHT)
    return picture, told + terrain_relief.told(factor)


def draw_tiles(session, scene, ground, options, size, pixel, background, camera_at, lit=True, away=None):
    """Draws a picture tile by tile. camera_at(x, y, width, height, above) returns the eye, the direction of the
    picture's top, and the viewing direction of a tile's camera. lit: whether the ground is shaded. away: None, or an
    array of the picture's size, which gets how far the ground is from the frame's origin towards the camera [m], NaN
    beside it."""
    for terrain in ground.terrains:
        terrain.object.lit = lit
    level = level_of(ground, pixel)
    reach, above = (posts * ground.post * 2**level for posts in (REACH, ABOVE))
    side = max(16, min(1024, math.floor(2 * reach / pixel)))
    picture = np.empty((size[1], size[0], 3), np.uint8)
    view, triangles = None, 0
    for x, y, width, height in tiles(size, side):
        eye, up, down = camera_at(x, y, width, height, above)
        scene.add_camera("above", eye=tuple(eye), target=tuple(eye + above * down), up=tuple(up),
                         height=height * pixel, near=1e-3 * above, far=far_of(ground, above))
        if view is None:
            view = scene.add_viewport((width, height), "above", samples=2)
            view.set_background(background)
            light_view(view, options)
        elif view.size != (width, height):
            view.size = (width, height)
        if away is None:
            picture[y:y + height, x:x + width] = view.image()
        else:
            planes = view.capture(color=True, depth=True)
            picture[y:y + height, x:x + width] = planes["color"][..., :3]
            depth = planes["depth"].astype(float)
            away[y:y + height, x:x + width] = np.where(np.isfinite(depth), -np.dot(eye, down) - depth, np.nan)
        triangles += session.statistics["triangles_drawn"]
    return picture, f"posts of level {level} every {ground.post * 2**level:.6g} m; {triangles} triangles"


def far_of(ground, above):
    relief = ground.heights[1] - ground.heights[0]
    return 2 * above + 2 * relief + (2 * ground.radius if ground.on_body else 0.0)


class HeightsSeen:
    """Heights of the ground of a plane, from small depth pictures from above all of it. They show posts that are farther
    apart the higher they are seen from, so that a raster elsewhere is not read in full resolution."""

    SIDE = 33  # pixels

    def __init__(self, scene, ground):
        self._scene, self._ground, self._view = scene, ground, None

    def __call__(self, middle, width, height, above):
        """Returns the known heights in a box of width x height metres about a point."""
        low, high = self._ground.heights
        eye = np.array([*middle, high + 0.1 * (high - low) + above])
        self._scene.add_camera("survey", eye=tuple(eye), target=tuple(eye - (0, 0, above)), up=(0, 1, 0),
                               height=max(width, height), near=1e-3 * above, far=far_of(self._ground, above))
        if self._view is None:
            self._view = self._scene.add_viewport((self.SIDE, self.SIDE), "survey", samples=1, visible=False)
        heights = eye[2] - self._view.depth().astype(float)
        return heights[np.isfinite(heights)]


def draw_map(session, scene, ground, options, longer):
    west, east, south, north = ground.extent
    size = options.size or fitted_size(east - west, north - south, longer)
    pixel = max((east - west) / size[0], (north - south) / size[1])
    # If the picture has another shape than the rasters, the rest is background.
    left = 0.5 * (west + east) - 0.5 * size[0] * pixel
    top = 0.5 * (south + north) + 0.5 * size[1] * pixel

    heights_seen = HeightsSeen(scene, ground)

    def camera_at(x, y, width, height, above):
        middle = np.array([left + (x + 0.5 * width) * pixel, top - (y + 0.5 * height) * pixel])
        known = heights_seen(middle, width * pixel, height * pixel, above)
        # Just above the highest ground of the tile, estimated from what is seen from above all ground.
        highest = min(known.max() + 0.3 * np.ptp(known), ground.heights[1]) if len(known) else ground.heights[1]
        lowest = known.min() if len(known) else ground.heights[0]
        z = max(highest + 0.01 * above, lowest + above)
        return np.array([*middle, z]), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, -1.0])

    def draw(lit, away):
        return draw_tiles(session, scene, ground, options, size, pixel, BESIDE, camera_at, lit, away)

    def surface(away):
        return away, np.broadcast_to((0.0, 0.0, 1.0), (*away.shape, 3))

    picture, told = draw_with_relief(options, size, pixel, draw, surface, ground.sun)
    edges = ground.terrains[0].to_map(np.array([[left, top, 0.0], [left + size[0] * pixel,
                                                                    top - size[1] * pixel, 0.0]]))
    return picture, (f"map x {edges[0, 0]:.9g} to {edges[1, 0]:.9g}, y {edges[1, 1]:.9g} to {edges[0, 1]:.9g}; "
                     f"a pixel is {pixel:.6g} m; {told}")


def draw_disc(session, scene, ground, options, longer):
    """Draws the body, or the part that the rasters cover, from above their middle."""
    middle = ground.place((*ground.middle, 0.0))
    axes = ground.axes(middle)
    points = ground.grid(65) @ axes.T
    points = points[points[:, 2] > 0]
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    if ground.radius < np.abs(points[:, :2]).max() * 1.02:  # the rasters cover nearly half of the body, or more
        low, high = np.full(2, -1.02 * ground.radius), np.full(2, 1.02 * ground.radius)
    size = options.size or fitted_size(*(high - low), longer)
    pixel = max((high - low) / size)
    left, top = 0.5 * (low + high) * (1, 1) + 0.5 * pixel * np.array(size) * (-1, 1)
    outer = ground.radius + ground.heights[1]

    def camera_at(x, y, width, height, above):
        u = left + (x + 0.5 * width) * pixel
        v = top - (y + 0.5 * height) * pixel
        # The greatest height of the ground in this tile, towards the camera.
        near = np.hypot(*(max(abs(at) - 0.5 * n * pixel, 0.0) for at, n in ((u, width), (v, height))))
        up = math.sqrt(max(outer**2 - near**2, 0.0)) + 0.2 * above
        here = math.sqrt(max(ground.radius**2 - u**2 - v**2, 0.0)) + above
        return np.array([u, v, max(up, here)]) @ axes, axes[1], -axes[2]

    def draw(lit, away):
        return draw_tiles(session, scene, ground, options, size, pixel, SKY, camera_at, lit, away)

    def surface(away):
        u = left + (np.arange(size[0]) + 0.5) * pixel
        v = top - (np.arange(size[1]) + 0.5) * pixel
        points = np.stack([*np.broadcast_arrays(u[None, :], v[:, None]), away], axis=-1)
        heights, normals = ground.above_body(points @ axes)
        return heights, normals @ axes.T

    picture, told = draw_with_relief(options, size, pixel, draw, surface, axes @ ground.sun)
    return picture, f"the body from above its middle; a pixel is {pixel:.6g} m; {told}"
