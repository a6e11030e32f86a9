"""What gymnasium finds by its entry point: the names of the environments. It imports nothing but gymnasium."""

from __future__ import annotations

#: Name of the environments.
ENVIRONMENT = "recrash/Crash-v0"


def register() -> None:
    """Tell gymnasium of the environments."""
    from gymnasium.envs.registration import register as tell
    from gymnasium.envs.registration import registry

    if ENVIRONMENT not in registry:
        tell(ENVIRONMENT, "recrash.gym:CrashEnv", vector_entry_point="recrash.gym:CrashVectorEnv")
