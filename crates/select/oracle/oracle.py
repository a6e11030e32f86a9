"""Independent numbers for the tests of recrash-select, by numpy and scikit-learn.

    python oracle.py write            writes pca.json, clusters.json and lexical.json beside this file
    python oracle.py compare DUMP     compares a dump of the `measure` example with scikit-learn

Versions: `requirements/oracle-sklearn.txt`. What `write` wrote is committed; `tests/test_selection.py` runs `compare`, which
prints one JSON object and is for other programs to judge.
"""

import json
import pathlib
import sys

import numpy as np
from sklearn.cluster import KMeans
from sklearn.decomposition import PCA
from sklearn.metrics import adjusted_rand_score, silhouette_score

HERE = pathlib.Path(__file__).parent

# Our own sentences; every word of two letters or more counts, none is a stop word.
TEXTS = [
    "partner turned left across path junction",
    "partner turned left across path car car",
    "partner ran red light junction",
    "cyclist fell beside parked bus",
    "bus parked lane cyclist passed",
    "truck changed lane mirror contact",
    "truck mirror contact lane lane lane",
    "partner turned right junction light",
]


def write(name, content):
    (HERE / name).write_text(json.dumps(content) + "\n")


def write_pca():
    rng = np.random.default_rng(1)
    content = {}
    for shape, rows, columns, kept in [("tall", 20, 5, 3), ("wide", 6, 9, 4)]:
        x = (rng.normal(size=(rows, columns)) * np.linspace(3, 1, columns)).round(3)
        pca = PCA(kept, svd_solver="full").fit(x)
        content[shape] = x.tolist()
        content[f"{shape}_scores"] = pca.transform(x).tolist()
        content[f"{shape}_explained_variance"] = float(pca.explained_variance_ratio_.sum())
    write("pca.json", content)


def write_clusters():
    rng = np.random.default_rng(2)
    centres = rng.normal(size=(7, 4)) * 3
    points = (centres[rng.integers(0, 7, 150)] + rng.normal(size=(150, 4))).round(3)
    k, restarts = 9, 10
    inertia = [float(KMeans(k, n_init=restarts, random_state=seed).fit(points).inertia_) for seed in range(20)]
    labels = KMeans(5, n_init=1, random_state=0).fit_predict(points)
    other = KMeans(4, n_init=1, random_state=1).fit_predict(points)
    write("clusters.json", {
        "points": points.tolist(), "k": k, "restarts": restarts, "kmeans_inertia": inertia,
        "labels": labels.tolist(), "other_labels": other.tolist(),
        "silhouette": float(silhouette_score(points, labels)),
        "adjusted_rand_index": float(adjusted_rand_score(labels, other)),
    })


def write_lexical():
    terms = sorted({word for text in TEXTS for word in text.split()})
    counts = np.array([[text.split().count(term) for term in terms] for text in TEXTS], float)
    frequency = np.where(counts > 0, 1 + np.log(np.maximum(counts, 1)), 0)
    weights = frequency * np.log((1 + len(TEXTS)) / (counts > 0).sum(axis=0))
    weights /= np.linalg.norm(weights, axis=1, keepdims=True)
    kept = 3
    _, _, directions = np.linalg.svd(weights, full_matrices=False)
    rows = weights @ directions[:kept].T
    write("lexical.json", {"texts": TEXTS, "kept": kept, "inner_products": (rows @ rows.T).tolist()})


def compare(dump):
    """The same k-means by scikit-learn, and our clusters' inertia in scikit-learn's own principal components."""
    data = json.loads(pathlib.Path(dump).read_text())
    templates = np.array(data["templates"])
    pca = PCA(data["dimensions"], svd_solver="full")
    one_hot = (templates[:, None] == np.unique(templates)[None]).astype(float)
    space = np.hstack([one_hot, pca.fit_transform(np.array(data["rows"]))])
    seeds = range(len(data["inertia"]))
    theirs = [KMeans(data["budget"], n_init=data["restarts"], random_state=seed).fit(space).inertia_ for seed in seeds]
    again = [inertia_of(space, np.array(labels)) for labels in data["labels"]]
    print(json.dumps({
        "recrash": data["inertia"], "recrash_again": again, "scikit_learn": theirs,
        "explained_variance": [data["explained_variance"], float(pca.explained_variance_ratio_.sum())],
    }))


def inertia_of(points, labels):
    groups = (points[labels == label] for label in np.unique(labels))
    return float(sum(((group - group.mean(axis=0)) ** 2).sum() for group in groups))


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["write"]:
            write_pca()
            write_clusters()
            write_lexical()
        case ["compare", dump]:
            compare(dump)
        case _:
            sys.exit(__doc__)
