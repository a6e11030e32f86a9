//! Rows held against an independent BERT in double precision (`oracle/oracle.py`): on a tiny model of random weights
//! always, on the published one where `MINILM_DIR` names its folder.

use recrash_embed::{EmbedError, Embedder, ModelFiles};
use serde_json::Value;

const CONFIG: &[u8] = include_bytes!("../tiny/config.json");
const WEIGHTS: &[u8] = include_bytes!("../tiny/model.safetensors");
const VOCABULARY: &[u8] = include_bytes!("../tiny/vocab.txt");
const TINY: ModelFiles<'_> = ModelFiles { config: CONFIG, weights: WEIGHTS, vocabulary: VOCABULARY };

fn texts(expected: &Value) -> Vec<String> {
    serde_json::from_value(expected["texts"].clone()).unwrap()
}

fn rows(expected: &Value, key: &str) -> Vec<Vec<f64>> {
    serde_json::from_value(expected[key].clone()).unwrap()
}

#[test]
fn a_tiny_model_gives_the_oracles_rows() {
    let expected: Value = serde_json::from_str(include_str!("../tiny/expected.json")).unwrap();
    let embedder = Embedder::new(TINY).unwrap();
    assert_eq!((embedder.dimensions(), embedder.is_pinned()), (12, false));
    let texts = texts(&expected);
    let ours = embedder.embed(&texts.iter().map(String::as_str).collect::<Vec<_>>());
    for ((text, ours), theirs) in texts.iter().zip(&ours).zip(rows(&expected, "rows")) {
        assert_eq!(ours.len(), theirs.len());
        for (a, b) in ours.iter().zip(theirs) {
            assert!((f64::from(*a) - b).abs() < 5e-6, "{text:?}: {a} {b}");
        }
    }
}

#[test]
fn the_published_model_gives_the_oracles_rows() {
    let Some(folder) = recrash_testing::named_by("MINILM_DIR") else { return };
    let read = |name: &str| std::fs::read(folder.join(name)).expect("MINILM_DIR holds the model's files");
    let (config, weights, vocabulary) = (read("config.json"), read("model.safetensors"), read("vocab.txt"));
    let files = ModelFiles { config: &config, weights: &weights, vocabulary: &vocabulary };
    let embedder = Embedder::new(files).unwrap();
    assert!(embedder.is_pinned());
    let expected: Value = serde_json::from_str(include_str!("../minilm.json")).unwrap();
    let (first_values, inner_products) = (rows(&expected, "first_values"), rows(&expected, "inner_products"));
    let ours: Vec<Vec<f32>> = texts(&expected).iter().map(|text| embedder.embed_text(text)).collect();
    let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(x, y)| f64::from(*x) * f64::from(*y)).sum::<f64>();
    for (i, row) in ours.iter().enumerate() {
        for (a, b) in row.iter().zip(&first_values[i]) {
            assert!((f64::from(*a) - b).abs() < 2e-6, "text {i}: {a} {b}");
        }
        for (j, other) in ours.iter().enumerate() {
            assert!((dot(row, other) - inner_products[i][j]).abs() < 5e-6, "texts {i} and {j}");
        }
    }
    // Two left turns across the path lie nearer than a brushed van.
    assert!(dot(&ours[0], &ours[1]) > dot(&ours[0], &ours[2]));
}

#[test]
fn rows_do_not_depend_on_company() {
    let embedder = Embedder::new(TINY).unwrap();
    assert_eq!(embedder.embed(&["the bus", "left"])[1], embedder.embed_text("left"));
}

#[test]
fn every_file_has_its_part_in_the_fingerprint() {
    let fingerprint = |files| Embedder::new(files).unwrap().fingerprint().to_owned();
    let spaced = [CONFIG, b" "].concat();
    assert_eq!(fingerprint(TINY), fingerprint(TINY));
    assert_ne!(fingerprint(TINY), fingerprint(ModelFiles { config: &spaced, ..TINY }));
}

#[test]
fn damaged_files_are_refused_by_name() {
    let told = |files: ModelFiles<'_>| Embedder::new(files).unwrap_err().to_string();
    assert!(told(ModelFiles { config: b"{}", ..TINY }).starts_with("config.json"));
    assert!(told(ModelFiles { weights: &WEIGHTS[..WEIGHTS.len() / 2], ..TINY }).contains("download complete"));
    assert!(told(ModelFiles { weights: b"", ..TINY }).starts_with("model.safetensors"));
    assert!(told(ModelFiles { vocabulary: b"[UNK]", ..TINY }).starts_with("vocab.txt"));
    let config = String::from_utf8(CONFIG.to_vec()).unwrap();
    let with = |from: &str, to: &str| config.replace(from, to).into_bytes();
    let wrong_kind = with("\"bert\"", "\"gpt2\"");
    assert!(matches!(
        Embedder::new(ModelFiles { config: &wrong_kind, ..TINY }),
        Err(EmbedError::Unsupported { field: "model_type", .. })
    ));
    let more_layers = with("\"num_hidden_layers\": 2", "\"num_hidden_layers\": 3");
    assert!(matches!(
        Embedder::new(ModelFiles { config: &more_layers, ..TINY }),
        Err(EmbedError::MissingTensor(name)) if name.contains("layer.2")
    ));
    let wider = with("\"intermediate_size\": 20", "\"intermediate_size\": 21");
    assert!(matches!(Embedder::new(ModelFiles { config: &wider, ..TINY }), Err(EmbedError::TensorShape { .. })));
    let uneven = with("\"num_attention_heads\": 3", "\"num_attention_heads\": 5");
    assert!(matches!(Embedder::new(ModelFiles { config: &uneven, ..TINY }), Err(EmbedError::Unsupported { .. })));
}
