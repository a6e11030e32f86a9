
# ---- following a recording: the same in every file ----------------------------------------------------------------

from scenic.core.simulators import Action

class Place(Action):
    """Puts somebody where a recording has it one step from now. A recording is (x, y, heading, speed) at every step."""

    def __init__(self, track):
        self.track = track

    def applyTo(self, obj, sim):
        x, y, heading, speed = self.track[min(sim.currentTime + 1, len(self.track) - 1)]
        obj.heading = heading - math.pi / 2
        obj.angularSpeed = 0
        obj.velocity = Vector(speed * math.cos(heading), speed * math.sin(heading))
        # Newtonian moves everybody on by its velocity.
        obj.position = Vector(x, y) - obj.velocity * STEP

behavior Recorded(track):
    while True:
        take Place(track)
