//! Options of the roles, and of how language models are asked.

use clap::{Args, ValueEnum};
use recrash_pipeline::{AnswerMode, Caps, Cast, ModelAccess, RULES, Reads};
use std::path::PathBuf;

/// Takes a model that is cast to review away again.
const NOBODY: &str = "nobody";

/// Who plays which role, and how models are asked. A model is named as its provider names it.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Agents and language models")]
pub struct ModelArgs {
    /// Who paraphrases and designs: rules, or a language model by name. [default: rules]
    ///
    /// gpt-*, o3 and the like are asked at OpenAI, claude-* at Anthropic, gemini-* at Google, every other name at Ollama on
    /// this machine. A prefix names another provider, such as groq::NAME; --base-url any OpenAI-compatible server. Keys
    /// come from the environment: OPENAI_API_KEY, ANTHROPIC_API_KEY, GEMINI_API_KEY, ...
    #[arg(long, value_name = "rules|MODEL")]
    pub agent: Option<String>,
    /// Who paraphrases: reads the reports. [default: as --agent]
    #[arg(long, value_name = "rules|MODEL")]
    pub paraphrase: Option<String>,
    /// Who designs; in a suite that goes by accounts, who looks at each replay of what the rules staged, and changes the scenario
    /// until it shows the crash as told. [default: as --agent]
    #[arg(long, value_name = "rules|MODEL")]
    pub design: Option<String>,
    /// Who tunes; rules is the search, which costs nothing and finds more. [default: rules]
    #[arg(long, value_name = "rules|MODEL")]
    pub tune: Option<String>,
    /// Who reads each replay beside its report, and says what it shows otherwise: a language model, or nobody; in a suite that
    /// goes by accounts. It changes no scenario. [default: nobody]
    #[arg(long, value_name = "nobody|MODEL")]
    pub review: Option<String>,
    /// Rounds of a model that tunes. [default: 3]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=50))]
    pub rounds: Option<u16>,
    /// How often an answer goes back to its model before the rules take over: so often for its form, and so often for what it
    /// says. [default: 3]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(0..=20))]
    pub repairs: Option<u16>,
    /// Which incidents a model that paraphrases reads, in a suite that goes by accounts. [default: unread]
    #[arg(long, value_name = "WHICH", value_enum)]
    pub model_reads: Option<ModelReads>,
    /// How models are asked.
    #[command(flatten)]
    pub access: AccessArgs,
}

/// Which incidents a model reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ModelReads {
    /// Those that the built-in reader did not read whole.
    Unread,
    /// All of them: the model corrects what the built-in reader made of each.
    All,
}

/// How models are asked.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Agents and language models")]
pub struct AccessArgs {
    /// Where a model's answers come from.
    #[arg(long, value_name = "MODE", value_enum, default_value_t)]
    pub llm: Llm,
    /// Address of an OpenAI-compatible server, such as http://localhost:8000/v1; its key, if any, is RECRASH_API_KEY.
    #[arg(long, value_name = "URL", env = "RECRASH_BASE_URL", hide_env_values = true)]
    pub base_url: Option<String>,
    /// Longest time for one answer. [s] [default: 300]
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u32).range(1..=86_400))]
    pub timeout: Option<u32>,
    /// How often a question is asked again when the provider is busy, fails or does not answer in time. [default: 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=20))]
    pub retries: Option<u32>,
    /// Questions under way at once; the results do not depend on it. [default: 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub concurrency: Option<u16>,
    /// Stop before this run has models read and write more tokens; the same command goes on.
    #[arg(long, value_name = "N")]
    pub max_tokens: Option<u64>,
    /// Stop before this run costs more; the same command goes on. [USD]
    #[arg(long, value_name = "USD", value_parser = money)]
    pub max_cost: Option<f64>,
    /// Prices of models (TOML), before the built-in ones; `recrash ledger --help` shows the form.
    #[arg(long, value_name = "FILE")]
    pub prices: Option<PathBuf>,
}

/// Where a model's answers come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Llm {
    /// Over the network, from the model.
    #[default]
    Live,
    /// Write requests.jsonl in the form of OpenAI's Batch files, stop, and go on when responses.jsonl lies beside it.
    Batch,
    /// From the suite's ledger alone, without a network.
    Replay,
}

impl ModelArgs {
    /// The language models that were typed, whichever role each was typed for.
    pub fn named(&self) -> Vec<String> {
        let typed = [&self.agent, &self.paraphrase, &self.design, &self.tune, &self.review];
        typed.into_iter().flatten().filter(|name| *name != RULES && *name != NOBODY).cloned().collect()
    }

    /// The cast that was typed, over `base`.
    pub fn cast(&self, base: Cast) -> Cast {
        let role = |own: &Option<String>, base: String| own.clone().or_else(|| self.agent.clone()).unwrap_or(base);
        Cast {
            paraphrase: role(&self.paraphrase, base.paraphrase),
            design: role(&self.design, base.design),
            tune: self.tune.clone().unwrap_or(base.tune),
            rounds: self.rounds.map_or(base.rounds, usize::from),
            repairs: self.repairs.map_or(base.repairs, usize::from),
            reads: match self.model_reads {
                None => base.reads,
                Some(ModelReads::Unread) => Reads::Unread,
                Some(ModelReads::All) => Reads::All,
            },
            review: match self.review.as_deref() {
                None => base.review,
                Some(NOBODY) => None,
                Some(model) => Some(model.to_owned()),
            },
        }
    }
}

impl AccessArgs {
    /// How models are asked.
    pub fn access(&self) -> ModelAccess {
        let default = ModelAccess::default();
        ModelAccess {
            mode: match self.llm {
                Llm::Live => AnswerMode::Live,
                Llm::Batch => AnswerMode::Batch,
                Llm::Replay => AnswerMode::Replay,
            },
            base_url: self.base_url.clone().filter(|url| !url.is_empty()),
            timeout_s: self.timeout.map_or(default.timeout_s, f64::from),
            retries: self.retries.unwrap_or(default.retries),
            concurrency: self.concurrency.map_or(default.concurrency, usize::from),
            caps: Caps { tokens: self.max_tokens, cost_usd: self.max_cost },
            prices: self.prices.clone(),
        }
    }
}

fn money(text: &str) -> Result<f64, String> {
    let amount: f64 = text.parse().map_err(|_| "it is an amount of USD, such as 2.50".to_owned())?;
    if amount.is_finite() && amount > 0.0 { Ok(amount) } else { Err("it is more than 0 and finite".to_owned()) }
}
