"""Pictures of measurements: real data."""
from dspace.command_line import main
from pictures.paths import DATA, IMAGES


def measure_horizon():
    """The horizon where Curiosity landed in Gale crater."""
    code = main(["horizon", "--terrain", f"{DATA}/terrain/mars_gale_mola_128ppd_m.tif", "--site", "137.4417,-4.5895",
                 "--height", "2", "--azimuths", "1440", "--vertical-datum", "areoid", "--out",
                 str(IMAGES / "measure_horizon.png")])
    assert code == 0
