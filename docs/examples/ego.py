"""An ego for recrash: follows its route by pure pursuit and keeps a distance. Protocol: docs/ego-protocol.md"""
import json, math, sys

def control(world, step):
    me, route = step["ego"], world["route"]
    length = world["vehicle"]["length_m"]
    ahead = 4.0 + 0.5 * me["speed"]
    target = route[min(len(route) - 1, int(me["route_s_m"] + ahead))]
    angle = math.atan2(target["y"] - me["y"], target["x"] - me["x"]) - me["heading"]
    wheel = math.atan(2.0 * world["vehicle"]["wheelbase_m"] * math.sin(angle) / ahead)
    wanted = min(world["target_speed_mps"], 6.0 if abs(wheel) > 0.05 else 99.0)
    acceleration = 0.8 * (wanted - me["speed"])
    for other in step["actors"] + world["obstacles"]:
        x, y = other["x"] - me["x"], other["y"] - me["y"]
        along = x * math.cos(me["heading"]) + y * math.sin(me["heading"])
        across = y * math.cos(me["heading"]) - x * math.sin(me["heading"])
        gap = along - length - 1.5 * me["speed"]
        if along > 0.0 and abs(across) < 2.5 and gap < 10.0:
            acceleration = min(acceleration, -3.0 if gap > 0.0 else -7.0)
    return {"type": "control", "acceleration_mps2": acceleration, "wheel_angle_rad": wheel}

world = {}
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "hello":
        answer = {"type": "ready", "protocol": "recrash.ego/1"}
    elif message["type"] == "reset":
        world, answer = message, {"type": "ready"}
    elif message["type"] == "step":
        answer = control(world, message)
    else:
        continue  # "end" wants no answer
    print(json.dumps(answer), flush=True)
