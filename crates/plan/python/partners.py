# The second part of the script: what partners do. recrash joins its parts to one file; what is used here and not defined
# here stands in the first.


class PartnerPolicy(IDMPolicy):
    """What a plan asks for: the same law as recrash's crates/plan, function by function."""

    def __init__(self, vehicle, spec):
        super().__init__(vehicle, 0)
        self.spec, self.plan, self.way = spec, spec["plan"], spec["partner_way"]
        self.script = self.plan["speed"]
        # Of the IDM policy the gap law is used, nothing else.
        self.NORMAL_SPEED = self.target_speed = 3.6 * self.script["speed_mps"]
        self.enable_lane_change = False
        self.standing_steps = 0
        self.last_heading = None

    def waits(self, step):
        return self.script["type"] == "wait" and (self.script["until"] is None or step < self.script["until"])

    def has_plans(self, step):
        script, kind = self.script, self.script["type"]
        if kind == "wait":
            return script["speed_mps"] > 0 and script["until"] is not None and step <= script["until"]
        if kind == "timed":
            return script["speed_mps"] > 0 or step < max(script["brake_until"], script["throttle_until"])
        return False

    def decide(self, world, me):
        actor = world.actors[me]
        if self.waits(world.step):
            # The controllers begin when it sets off. On its brakes alone a vehicle creeps at some centimetres a second.
            if actor.vehicle.speed < Law.standing_mps:
                actor.vehicle.set_velocity([0.0, 0.0])
            return [0.0, hold_still(actor.vehicle.speed)]
        throttle = hold_still(actor.vehicle.speed) if actor.halted else self.pedal(world, me)
        return [self.steer(world, actor), throttle]

    def lateral_target(self, time):
        """Offset wanted from the lane's centre, and its rate; a move takes over from wherever the last one is."""
        offset, moves = self.plan["start_t_m"], self.way["moves"]
        for position, move in enumerate(moves):
            if time < move["start_s"]:
                return offset, 0.0
            rate = (move["to_t_m"] - offset) / max(move["duration_s"], Law.shortest_move_s)
            following = moves[position + 1]["start_s"] if position + 1 < len(moves) else math.inf
            until = min(following, move["start_s"] + move["duration_s"])
            if time < until:
                return offset + rate * (time - move["start_s"]), rate
            offset += rate * max(until - move["start_s"], 0.0)
        return offset, 0.0

    def line(self, time):
        """The line of its moves, each corner rounded."""
        half = 0.5 * self.way["blend_s"]
        if half <= 0.0:
            return self.lateral_target(time)
        before, now, after = (self.lateral_target(time + share * half)[0] for share in (-1, 0, 1))
        return (before + 4.0 * now + after) / 6.0, (after - before) / (2.0 * half)

    def steer(self, world, actor):
        plan, vehicle, place = self.plan, actor.vehicle, actor.place
        preview, greatest = Law.preview_s, plan["greatest_drift_rad"]
        wanted, rate = self.line(world.step * Law.step_s + preview - Law.seen_late_s)
        drift = math.asin(max(-1.0, min(1.0, -rate / max(vehicle.speed, Law.slow_mps))))
        drift = max(-greatest, min(greatest, drift))

        heading, speed, last = vehicle.heading_theta, vehicle.speed, self.last_heading
        yaw_rate = 0.0 if last is None else wrap(heading - last) / Law.step_s
        self.last_heading = heading
        arm = plan["rear_axle_m"] - plan["slip_s"] * speed
        lane, curvature = place.way_at(place.path_s)
        here = wrap(heading + arm * curvature - lane)
        lane, curvature = place.way_at(place.path_s + speed * preview)
        ahead = wrap(heading + yaw_rate * preview + arm * curvature - lane)
        offset = place.t - speed * preview * math.sin(0.5 * (here + ahead))

        length = max(speed * Law.return_s, Law.return_wheelbases * plan["wheelbase_m"])
        per_offset = 1.0 / length**2
        per_course = max(2.0 / length - arm * per_offset, 1.0 / length)
        angle = drift - (wanted - offset) * per_offset / per_course
        angle = max(-greatest, min(greatest, angle))
        bend = curvature / max(1.0 + curvature * offset, 0.1) + per_course * wrap(angle - ahead)
        most = plan["sideways_mps2"] / max(speed, Law.slow_mps) ** 2
        return math.atan(plan["wheelbase_m"] * max(-most, min(most, bend))) / plan["full_wheel_rad"]

    def pedal(self, world, me):
        plan, script, kind = self.plan, self.script, self.script["type"]
        actor = world.actors[me]
        speed, place = actor.vehicle.speed, actor.place
        if kind == "timed" and script["brake_from"] <= world.step < script["brake_until"]:
            return hold_still(speed)
        if kind == "timed" and world.step < script["throttle_until"]:
            wanted = self.meaning(script["throttle"])
        elif kind == "follow":
            wanted = self.meaning(self.gap_law(actor.vehicle))
        else:
            if script["speed_mps"] < Law.standing_mps and speed < Law.hold_below_mps:
                return Law.hold_brake
            wanted = max(plan["gain_per_s"] * (script["speed_mps"] - speed), -plan["comfortable_mps2"])
        acceleration = wanted
        stop = min([math.inf] + self.give_way(world, me) + self.blocked_ahead(world, place))
        if -Law.committed_m <= stop < math.inf:
            left = max(stop - Law.stop_short_m, 0.0)
            at_line = math.sqrt(2.0 * plan["stopping_mps2"] * left)
            if at_line < Law.standing_mps and speed < Law.hold_below_mps:
                return Law.hold_brake
            acceleration = min(acceleration, self.come_down(speed, 0.0, left, plan["stopping_mps2"]))
        for bend in self.way["bends"]:
            if bend["to_m"] > place.path_s:
                left = max(bend["from_m"] - place.path_s, 0.0)
                slower = self.come_down(speed, bend["speed_mps"], left, plan["comfortable_mps2"])
                acceleration = min(acceleration, slower)
        hardest = min(-plan["greatest_braking_mps2"], wanted)
        acceleration = max(hardest, min(acceleration, plan["full_throttle_mps2"]))
        if acceleration < 0.0:
            return acceleration / plan["full_brake_mps2"]
        return max(acceleration / max(plan["full_throttle_mps2"], 1e-3), Law.least_throttle)

    def meaning(self, pedal):
        """The acceleration that a pedal asks for."""
        pedal = max(-1.0, min(1.0, pedal))
        return pedal * self.plan["full_brake_mps2" if pedal < 0.0 else "full_throttle_mps2"]

    @staticmethod
    def come_down(speed, target, distance, deceleration):
        """The acceleration along the parabola that ends at a place with a speed."""
        on_parabola = math.sqrt(target * target + 2.0 * deceleration * distance)
        slope = deceleration * speed / on_parabola if distance > 0.0 else 0.0
        return (on_parabola - speed) / Law.catch_up_s - slope

    def gap_law(self, vehicle):
        self.target_speed = self.NORMAL_SPEED
        front, distance = None, 5
        try:
            objects = vehicle.lidar.get_surrounding_objects(vehicle)
            around = FrontBackObjects.get_find_front_back_objs(
                objects, vehicle.lane, vehicle.position, self.MAX_LONG_DIST
            )
            front, distance = around.front_object(), around.front_min_distance()
        except AttributeError:
            pass
        return self.acceleration(front, distance)

    def blocked_ahead(self, world, place):
        """Distances to obstacles that lie on its line."""
        wanted, half = self.line(world.step * Law.step_s)[0], self.plan["half_width_m"] - Law.brushes_m
        left, right = min(place.t, wanted) - half, max(place.t, wanted) + half
        there = [each for each in self.way["blocked"] if each["left_m"] < right and each["right_m"] > left]
        aheads = (each["from_m"] - self.plan["half_length_m"] - place.path_s for each in there)
        return [ahead for ahead in aheads if ahead >= -Law.committed_m]

    def give_way(self, world, me):
        """Distances to where it has to wait for others."""
        if self.script["type"] != "give_way":
            return []
        speed, place = world.actors[me].vehicle.speed, world.actors[me].place
        self.standing_steps = self.standing_steps + 1 if speed < Law.standing_mps else 0
        aheads = []
        for crossing in self.spec["crossings"]:
            ahead = crossing["mine"]["from"] - place.path_s
            if ahead >= -Law.committed_m and self.must_wait(world, me, crossing, ahead):
                aheads.append(max(ahead, 0.0))
        return aheads

    def must_wait(self, world, me, crossing, ahead):
        number, merges, mine, theirs = (crossing[name] for name in ("other", "merges", "mine", "theirs"))
        own, other = world.actors[me], world.actors[number]
        if other.gone:
            return False
        other_s, other_speed = other.place.path_s, other.vehicle.speed
        if other_s > (theirs["from"] + Law.merged_m if merges else theirs["to"]):
            return False
        if other_s > theirs["from"]:
            return True
        own_speed = own.vehicle.speed
        if other_speed < Law.standing_mps:
            patient = self.standing_steps < Law.patience_steps
            return number < me and own_speed < Law.standing_mps and patient
        speed = max(own_speed, 0.5 * self.script["speed_mps"], Law.standing_mps)
        own_entry = max(ahead, 0.0) / speed
        own_exit = own_entry + Law.merging_s if merges else (mine["to"] - own.place.path_s) / speed
        way = theirs["from"] - other_s
        # The earliest they can be there.
        a = Law.their_acceleration_mps2
        their_entry = (math.sqrt(other_speed * other_speed + 2.0 * a * way) - other_speed) / a
        their_exit = way / other_speed + Law.merging_s if merges else (theirs["to"] - other_s) / other_speed
        if their_entry > Law.horizon_s or own_entry > Law.horizon_s:
            return False
        gap = self.script["gap_s"]
        return own_exit + gap > their_entry and their_exit + 0.5 * gap > own_entry
