"""A child that is forked from a process with sessions: it ends as any other, and what it does with a session is an
error. Each case is a process of its own, because it may hang."""
import os
import subprocess
import sys
import textwrap

SECONDS = 120


def run(code, *arguments):
    """Runs the code, whose children write to the same output. Returns the output."""
    program = textwrap.dedent("""\
        import os, sys
        import dspace

        def child(work):
            "What the child says, and how it ends."
            sys.stdout.flush()
            process = os.fork()
            if process == 0:
                work()
                sys.exit(7)
            return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])

        def attempt(call):
            try:
                call()
            except dspace.Error as error:
                print(type(error).__name__, error)
            else:
                print("no error")
        """) + textwrap.dedent(code)
    done = subprocess.run([sys.executable, "-c", program, *arguments], capture_output=True, text=True, timeout=SECONDS)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_child_of_a_session_that_has_drawn_ends():
    assert run("""
        with dspace.Session() as session:
            scene = session.scene()
            scene.add_box((1, 1, 1))
            camera = scene.add_camera(eye=(4, 4, 4), target=(0, 0, 0))
            viewport = scene.add_viewport(size=(64, 48), camera=camera)
            viewport.capture()
            print(child(lambda: print("child", flush=True)))
            viewport.capture()
            print("drawn")
        """) == ["child", "7", "drawn"]


def test_uses_of_a_session_in_a_child_are_errors():
    lines = run("""
        with dspace.Session() as session:
            scene = session.scene()
            viewport = scene.add_viewport(size=(64, 48), camera=scene.add_camera(eye=(4, 4, 4), target=(0, 0, 0)))
            viewport.capture()

            def work():
                attempt(lambda: scene.add_frame("a"))
                attempt(viewport.capture)
                attempt(session.render)
                session.close()
                attempt(lambda: scene.add_frame("a"))

            print(child(work))
            print(len(scene.frames))
        """)
    assert [line.split()[0] for line in lines] == ["Unsupported"] * 3 + ["Closed", "7", lines[-1]]
    assert all("this one is its child" in line for line in lines[:3])


def test_drawing_in_a_child_of_a_process_that_draws_is_rejected():
    lines = run("""
        def draw():
            with dspace.Session() as session:
                scene = session.scene()
                scene.add_frame("a")
                print("made", flush=True)
                camera = scene.add_camera(eye=(4, 4, 4), target=(0, 0, 0))
                attempt(lambda: scene.add_viewport(size=(64, 48), camera=camera).capture())

        draw()
        print(child(draw))
        """)
    assert lines[:3] == ["made", "no error", "made"]
    assert lines[3].startswith("Unsupported render context: this process was forked from one that draws")
    assert lines[4] == "7"


def test_child_draws_when_its_parent_has_not():
    assert run("""
        def draw():
            with dspace.Session() as session:
                scene = session.scene()
                camera = scene.add_camera(eye=(4, 4, 4), target=(0, 0, 0))
                attempt(lambda: scene.add_viewport(size=(64, 48), camera=camera).capture())

        print(child(draw))
        """) == ["no error", "7"]


def test_child_leaves_the_parents_worker_and_has_one_of_its_own(tmp_path):
    path = tmp_path / "a.wrl"
    path.write_text("#VRML V2.0 utf8\nShape { geometry Box { } }\n")
    assert run("""
        def load():
            with dspace.Session() as session:
                attempt(lambda: session.scene().load(sys.argv[1]))

        load()
        print(child(load))
        load()
        """, str(path)) == ["no error", "no error", "7", "no error"]


def test_child_of_a_recording_session_ends_and_leaves_the_file(tmp_path):
    path = tmp_path / "a.dspace"
    assert run("""
        with dspace.Session() as session:
            with session.record(sys.argv[1]):
                session.scene().add_frame("a")
                print(child(lambda: None))
                session.scene().add_frame("b")
        """, str(path)) == ["7"]
    done = subprocess.run([sys.executable, "-m", "dspace", "log", "info", str(path)], capture_output=True, text=True,
                          timeout=SECONDS)
    assert done.returncode == 0, done.stderr
    assert os.path.getsize(path) > 0
