"""Train a driver by PPO on the training crashes of a suite, and count its failures on the held-out ones: `python ppo.py`."""

import argparse
import json
import time
from pathlib import Path

import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import VecNormalize

import recrash
from recrash.gym import evaluate, split
from recrash.sb3 import CrashVecEnv

parser = argparse.ArgumentParser()
parser.add_argument("--files", nargs="*", help="crash files; the built-in sample without any")
parser.add_argument("--minutes", type=float, default=9.5, help="CPU time for training")
parser.add_argument("--seed", type=int, default=1)
parser.add_argument("--out", default="ppo.json")
arguments = parser.parse_args()
torch.set_num_threads(1)

scenarios, _ = recrash.read(arguments.files).reconstruct()
train, held_out = split(scenarios, held_out_share=0.25)
options = {"actions": "guided", "observation": {"kind": "kinematic", "neighbours": 4}, "threads": 1}
env = VecNormalize(CrashVecEnv(train, 256, **options), norm_obs=False, clip_reward=20.0)
net = {"net_arch": [128, 128], "log_std_init": -0.7}
model = PPO("MlpPolicy", env, n_steps=64, batch_size=4096, n_epochs=6, ent_coef=0.002, policy_kwargs=net, seed=arguments.seed)


def failures(part):
    runs = evaluate(lambda seen: model.predict(seen, deterministic=True)[0], part, **options)
    endings = [run.termination for run in runs]
    return {"of": len(runs), "failed": sum(run.failed for run in runs), **{e: endings.count(e) for e in set(endings)}}


class Curve(BaseCallback):
    points, spent, begun = [], 0.0, time.process_time()

    def _on_step(self):
        return self.spent + time.process_time() - self.begun < 60.0 * arguments.minutes

    def _on_rollout_start(self):
        self.spent += time.process_time() - self.begun
        if self.spent >= 6.0 * arguments.minutes * len(self.points):
            point = {"steps": self.num_timesteps, "cpu_s": round(self.spent)}
            self.points.append({**point, "train": failures(train), "held_out": failures(held_out)})
            print(json.dumps(self.points[-1]), flush=True)
        self.begun = time.process_time()


model.learn(10**9, callback=(curve := Curve()))
end = {"steps": model.num_timesteps, "train": failures(train), "held_out": failures(held_out)}
print(json.dumps(end))
Path(arguments.out).write_text(json.dumps({"seed": arguments.seed, "curve": [*curve.points, end]}, indent=1) + "\n")
