"""A mission's own console in DspaceQt: three docks beside the views.

    ./dspace app --load-plugin Examples/mission_console/mission_console.py
"""
STEPS = ("Mast deployed", "Hazard cameras checked", "Arm stowed", "Drive approved")
LIMITS = {"rover/tilt": (5.0, 8.0)}  # [deg] amber, red


class Console:
    def __init__(self, app):
        self.app = app
        self.make_drive()
        self.make_state()
        self.make_checks()
        app.add_action("&Mission", "&Reset the check list", self.reset, key="F6", tip="All items are open again")
        app.on_key("F7", self.note)
        app.every(0.2, self.update)

    # Commands, which a simulation would get by session.on_event or a channel of its own.
    def make_drive(self):
        dock = self.app.add_dock("Drive", area="right")
        self.speed = dock.slider("Speed", 0.0, 0.12, 0.04, unit="m/s", tip="Along the path")
        self.mode = dock.choice("Mode", ("blind", "guarded", "visual odometry"), value="guarded")
        dock.button("Send", self.send, tip="Logs the command as an event of the scene")
        dock.button("Stop", self.stop)

    def make_state(self):
        dock = self.app.add_dock("State", area="right")
        self.values = {}
        for name, unit in (("rover/speed", "m/s"), ("rover/heading", "deg"), ("rover/tilt", "deg"), ("rover/odometer", "m")):
            self.values[name] = (dock.read_out(name.split("/")[1].capitalize(), "no value"), unit)

    def make_checks(self):
        dock = self.app.add_dock("Check list", area="right")
        self.checks = [dock.check(step, function=lambda on, step=step: self.log(f"{step}: {'done' if on else 'open'}"))
                       for step in STEPS]
        self.journal = dock.table(("time [s]", "event"), height=5)

    def update(self):
        telemetry = self.app.scene.telemetry
        for name, (row, unit) in self.values.items():
            if name in telemetry:
                value = telemetry[name].value
                amber, red = LIMITS.get(name, (float("inf"), float("inf")))
                row.set(text=f"{value:.3g} {unit}", state="red" if value > red else "amber" if value > amber else "")

    def send(self):
        self.log(f"drive at {self.speed.value:.3f} m/s, {self.mode.value}")

    def stop(self):
        self.speed.set(value=0.0)
        self.log("stop")

    def reset(self):
        for check in self.checks:
            check.set(value=False)
        self.log("check list reset")

    def note(self):
        self.log("mark")

    def log(self, words):
        self.journal.set(append=[f"{self.app.scene.time:.1f}", words])
        self.app.scene.log_event("console", words)


def plugin(app):
    """DspaceQt calls this."""
    app.console = Console(app)
