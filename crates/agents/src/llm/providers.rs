//! Who is asked: a model's name tells its provider, and so the address, the key's variable and the protocol.

use crate::llm::wire::Wire;

/// Where a model is asked, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Provider {
    /// What names of its models may begin with, before `::`.
    pub prefix: &'static str,
    /// Protocol.
    pub wire: Wire,
    /// Address that the protocol's paths are added to.
    pub address: &'static str,
    /// Variable with its key; none where it wants none.
    pub key_variable: Option<&'static str>,
}

const fn compatible(prefix: &'static str, address: &'static str, key_variable: &'static str) -> Provider {
    Provider { prefix, wire: Wire::OpenAi, address, key_variable: Some(key_variable) }
}

const OPENAI: Provider = compatible("openai", "https://api.openai.com/v1", "OPENAI_API_KEY");
const XAI: Provider = compatible("xai", "https://api.x.ai/v1", "XAI_API_KEY");
const DEEPSEEK: Provider = compatible("deepseek", "https://api.deepseek.com/v1", "DEEPSEEK_API_KEY");
const KIMI: Provider = compatible("kimi", "https://api.moonshot.ai/v1", "KIMI_API_KEY");
const ZAI: Provider = compatible("zai", "https://api.z.ai/api/paas/v4", "ZAI_API_KEY");
const ANTHROPIC: Provider = Provider {
    prefix: "anthropic",
    wire: Wire::Anthropic,
    address: "https://api.anthropic.com/v1",
    key_variable: Some("ANTHROPIC_API_KEY"),
};
const GEMINI: Provider = Provider {
    prefix: "gemini",
    wire: Wire::Gemini,
    address: "https://generativelanguage.googleapis.com/v1beta",
    key_variable: Some("GEMINI_API_KEY"),
};
const OLLAMA: Provider =
    Provider { prefix: "ollama", wire: Wire::OpenAi, address: "http://localhost:11434/v1", key_variable: None };

/// Every provider that is known by name. All but Anthropic and Gemini speak OpenAI's protocol.
const PROVIDERS: [Provider; 15] = [
    OPENAI,
    ANTHROPIC,
    GEMINI,
    OLLAMA,
    XAI,
    DEEPSEEK,
    KIMI,
    ZAI,
    compatible("groq", "https://api.groq.com/openai/v1", "GROQ_API_KEY"),
    compatible("mistral", "https://api.mistral.ai/v1", "MISTRAL_API_KEY"),
    compatible("open_router", "https://openrouter.ai/api/v1", "OPEN_ROUTER_API_KEY"),
    compatible("together", "https://api.together.xyz/v1", "TOGETHER_API_KEY"),
    compatible("fireworks", "https://api.fireworks.ai/inference/v1", "FIREWORKS_API_KEY"),
    compatible("nebius", "https://api.studio.nebius.ai/v1", "NEBIUS_API_KEY"),
    compatible("aliyun", "https://dashscope.aliyuncs.com/compatible-mode/v1", "ALIYUN_API_KEY"),
];

/// What names of models begin with, and whose they are then.
const FAMILIES: [(&str, Provider); 14] = [
    // Open weights, which anybody may serve.
    ("gpt-oss", OLLAMA),
    ("gpt", OPENAI),
    ("chatgpt", OPENAI),
    ("codex", OPENAI),
    ("o1", OPENAI),
    ("o3", OPENAI),
    ("o4", OPENAI),
    ("claude", ANTHROPIC),
    ("gemini", GEMINI),
    ("grok", XAI),
    ("deepseek-", DEEPSEEK),
    ("kimi-", KIMI),
    ("glm", ZAI),
    ("", OLLAMA),
];

/// The provider of a model: the one that its name says, else the one whose models are called like it, else Ollama on this
/// machine.
///
/// # Errors
/// Its name says a provider that is not known.
pub fn provider(model: &str) -> Result<Provider, String> {
    match model.split_once("::") {
        Some((prefix, _)) => PROVIDERS.into_iter().find(|provider| provider.prefix == prefix).ok_or_else(|| {
            let known = PROVIDERS.map(|provider| provider.prefix).join(", ");
            format!(
                "{model} names no provider that is known; there are: {known}. Any server that speaks OpenAI's protocol can be \
                 named by its address"
            )
        }),
        None => Ok(FAMILIES.into_iter().find(|(start, _)| model.starts_with(start)).map_or(OLLAMA, |(_, p)| p)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_tells_the_provider() {
        for (model, prefix) in [
            ("gpt-5-mini", "openai"),
            ("o3", "openai"),
            ("claude-haiku-4-5", "anthropic"),
            ("gemini-2.5-flash", "gemini"),
            ("groq::gpt-oss-120b", "groq"),
            ("gpt-oss:20b", "ollama"),
            ("qwen3:8b", "ollama"),
            ("Qwen/Qwen3-8B", "ollama"),
        ] {
            assert_eq!(provider(model).unwrap().prefix, prefix, "{model}");
        }
        assert!(provider("nobody::x").unwrap_err().contains("groq"));
    }

    #[test]
    fn keys_go_to_encrypted_addresses_only() {
        for provider in PROVIDERS.iter().chain(FAMILIES.iter().map(|(_, provider)| provider)) {
            assert!(provider.key_variable.is_none() || provider.address.starts_with("https://"), "{provider:?}");
        }
    }
}
