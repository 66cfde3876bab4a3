"""Shader code of objects: dicts, vtkShaderProperty, uniforms; recorded; and bad input."""
import numpy as np
import pytest

import dspace

ORANGE = {"fragment": {"//VTK::Light::Impl": "fragOutput0 = vec4(1.0, 0.6, 0.2, 1.0);"}}


@pytest.fixture
def view(scene):
    ball = scene.add_sphere(1, name="ball")
    scene.add_camera("eye", eye=(4, 0, 0), target=(0, 0, 0))
    return scene.add_viewport((60, 60), "eye", samples=1), ball


def middle(viewport):
    return tuple(viewport.image()[30, 30])


def test_code_draws_and_goes(view):
    viewport, ball = view
    before = viewport.image()
    ball.shader = ORANGE
    assert middle(viewport) == (255, 153, 51)
    assert ball.shader["fragment"] == [{"tag": "//VTK::Light::Impl", "code": ORANGE["fragment"]["//VTK::Light::Impl"],
                                        "after": False, "first_only": False}]
    ball.shader = ball.shader  # what is read can be set
    assert middle(viewport) == (255, 153, 51)
    ball.shader = None
    assert ball.shader is None
    np.testing.assert_array_equal(viewport.image(), before)


def test_uniforms(view):
    viewport, ball = view
    ball.shader = {"fragment": {"//VTK::Light::Impl":
                                "fragOutput0 = vec4((turn * tint) * levels[1] * float(n), 1.0);"},
                   "uniforms": {"tint": (1.0, 0.2, 0.4), "turn": [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
                                "levels": [0.1, 0.5, 0.9, 1.0, 0.0], "n": 1}}
    np.testing.assert_allclose(middle(viewport), (25.5, 51, 127.5), atol=0.6)  # the matrix takes (r, g, b) to (g, b, r)
    ball.set_uniform("n", 2)
    assert middle(viewport) == (51, 102, 255)
    uniforms = ball.shader["uniforms"]
    assert uniforms["n"] == 2 and uniforms["levels"].shape == (5,)
    np.testing.assert_array_equal(uniforms["turn"], [[0, 1, 0], [0, 0, 1], [1, 0, 0]])


def test_a_property_of_vtk(view):
    from vtkmodules import vtkRenderingOpenGL2 as vtk
    viewport, ball = view
    code = vtk.vtkOpenGLShaderProperty()
    code.AddFragmentShaderReplacement("//VTK::Light::Impl", True,
                                      "//VTK::Light::Impl\n  fragOutput0 = vec4(tint, 1.0);", False)
    code.GetFragmentCustomUniforms().SetUniform3f("tint", (0.2, 0.4, 0.6))
    ball.set_shader(code)
    assert middle(viewport) == (51, 102, 153)
    code.GetFragmentCustomUniforms().SetUniform3f("tint", (1, 1, 1))
    assert middle(viewport) == (51, 102, 153)  # a copy
    code.SetFragmentShaderCode("void main() {}")
    with pytest.raises(dspace.Unsupported, match="ball.*whole shader"):
        ball.set_shader(code)


def test_bad_code(view, refused):
    viewport, ball = view
    ball.shader = ORANGE
    picture = viewport.image()
    for shader, text in (({"fragment": {"//VTK::Color::Impl": "no such thing;"}}, "object 'ball'"),
                         ({"fragment": {"": "x"}}, "tag"),
                         ({"uniforms": {"9": 1}}, "'9'"),
                         ({"uniforms": {"a": float("nan")}}, "'a'"),
                         ({"uniforms": {"a": np.zeros((2, 2, 2))}}, "'a'")):
        with refused(dspace.InvalidArgument, text):
            ball.shader = shader
    for shader in (7, {"uniforms": {"a": "x"}}, {"uniforms": {"a": [[1], [1, 2]]}}, {"fragment": [1]},
                   {"fragment": {"//VTK::Color::Impl": 1}}):
        with refused(dspace.WrongType, "ball"):
            ball.shader = shader
    with refused(dspace.Error, "geometry"):
        ball.shader = {"geometry": {}}
    np.testing.assert_array_equal(viewport.image(), picture)
    with pytest.warns(dspace.DspaceWarning, match="//VTK::Nothing"):
        ball.shader = {"fragment": {"//VTK::Nothing": "x"}}


def test_code_is_recorded(tmp_path):
    with dspace.Session() as session:
        scene = session.scene()
        one = scene.add_sphere(1, name="ball")
        scene.add_camera("eye", eye=(4, 0, 0), target=(0, 0, 0))
        scene.add_viewport((60, 60), "eye", name="view", samples=1)
        with session.record(tmp_path / "a.dspace"):
            scene.time = 1
            one.shader = ORANGE
            scene.time = 2
            one.shader = None
    with dspace.Playback(tmp_path / "a.dspace") as run:
        run.seek(1)
        assert middle(run.session.viewports["view"]) == (255, 153, 51)
        run.seek(2)
        assert middle(run.session.viewports["view"]) != (255, 153, 51)
