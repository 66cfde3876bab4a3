"""Generates the pictures of the documentation: ./dspace python Documentation/make_pictures.py [NAME ...]

NAME: a function of a module in Documentation/pictures; default: all. Pictures of real data are made where DSPACE_DATA
names it, and left as they are otherwise."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from pictures import application, cookbook, lenses, light, measure, models, ranges, scenes, sky, terrain, trajectories, vtk  # noqa: E402
from pictures.paths import DATA, IMAGES  # noqa: E402

EVERYWHERE = (scenes.first_picture, cookbook.cookbook, scenes.views, scenes.demo_drive, scenes.movie, scenes.banner, vtk.pipeline, vtk.props,
              vtk.own_object, lenses.lenses, lenses.live_lens, lenses.shutters, light.photometry, sky.stars,
              measure.measure_sites, measure.measure_link, measure.measure_ensemble, application.application,
              application.application_telemetry, application.application_console, application.application_dark,
              application.application_keys, application.application_map, application.application_messages,
              application.application_overlay)
OF_REAL_DATA = (scenes.drives, lenses.closed_loop, measure.measure_horizon, measure.measure_lit, measure.measure_viewshed, ranges.lidar, models.formats,
                terrain.levels, terrain.layers, terrain.normals, terrain.far_shadows, terrain.whole_mars,
                terrain.labels, terrain.pole, terrain.valles_marineris, terrain.two_views, terrain.earth,
                application.application_terrain, application.application_terrain_dock, application.application_measure,
                trajectories.artemis_inertial, trajectories.artemis_rotating, sky.constellations, sky.planets, sky.body_descent,
                sky.artemis_photo)


def main(*names):
    IMAGES.mkdir(exist_ok=True)
    known = {picture.__name__: picture for picture in EVERYWHERE + (OF_REAL_DATA if pathlib.Path(DATA, "terrain").is_dir()
                                                                    and DATA else ())}
    for name in names or known:
        if name == "tour":  # by name only
            application.tour()
            continue
        if name not in known:
            sys.exit(f"there is no picture {name!r}; accepted: {', '.join(known)}")
        known[name]()


if __name__ == "__main__":
    main(*sys.argv[1:])
