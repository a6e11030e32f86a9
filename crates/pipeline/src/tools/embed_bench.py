"""Times sentence-transformers for `recrash bench embed`, which sends JSON lines and reads JSON lines.

First line: {"model": folder, "threads": n, "texts": [...]}. Then "run" answers {"seconds": s} for one embedding of all
texts, "rows" answers {"rows": [...]} of the last one, and the end of the input ends the program.
"""

import json
import os
import sys
import time

os.environ["HF_HUB_OFFLINE"] = "1"
answers, sys.stdout = sys.stdout, sys.stderr


def answer(**content):
    print(json.dumps(content), file=answers, flush=True)


task = json.loads(sys.stdin.readline())
try:
    import sentence_transformers
    import torch
except ImportError as error:
    answer(error=f"{error}; install it: pip install sentence-transformers")
    sys.exit(0)
torch.set_num_threads(task["threads"])
begun = time.perf_counter()
model = sentence_transformers.SentenceTransformer(task["model"], device="cpu")
answer(
    name=f"sentence-transformers {sentence_transformers.__version__}, torch {torch.__version__}",
    load_s=time.perf_counter() - begun,
)
rows = None
for line in sys.stdin:
    if line.strip() == "run":
        begun = time.perf_counter()
        rows = model.encode(task["texts"], batch_size=32, show_progress_bar=False, normalize_embeddings=True)
        answer(seconds=time.perf_counter() - begun)
    else:
        answer(rows=rows.astype(float).tolist())
