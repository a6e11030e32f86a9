//! Wires the stages, and owns everything outside them: files, the clock, the environment, threads.
//!
//! [`Suite`] is a folder on disk with one stage after the other in it. [`run_stage`] runs one, reading what the
//! stages before wrote; a unit of work whose inputs have not changed is skipped, and what is written is written whole.
//! So a run killed at any moment goes on where it stopped, and ends with the same bytes.
//!
//! What this crate does **not** do: it prints nothing. Progress is told through [`Progress`], results are values.

mod embedding;
mod error;
mod files;
mod models;
mod options;
mod profiles;
mod progress;
mod reading;
mod secrets;
mod simulators;
mod stages;
mod suite;
mod tools;

pub use embedding::EmbeddingKind;
pub use embedding::weights::{
    PullRequest, Pulled, Weights, WeightsSource, find_weights, is_published_model, pull_model,
};
pub use error::{Choice, PipelineError};
pub use files::output::{Begun, Output, Outputs};
pub use files::paths::quoted;
pub use files::store::{Store, WriteFile, remove_unfinished};
pub use models::cast::{AgentLog, Cast, RULES, Reads};
pub use models::ledger::{LedgerReport, ModelSum, Sum as LedgerSum, ledger};
pub use models::{AnswerMode, ModelAccess};
pub use options::{Options, RecordSource};
pub use profiles::{PROFILE_NAMES, load_profile, profile_text};
pub use progress::{NoProgress, Progress, ProgressEvent};
pub use reading::accounts::{Accounts, ToldFact, read_accounts, told_facts};
pub use reading::fetching::{CrashKind, FetchRequest, Fetched, PublishedEdition, fetch};
pub use reading::records::{TableFormat, read_records, record_outputs, record_table, write_records};
pub use reading::retelling::{Impact, Retold, fact_shares, reconstruct_accounts, type_shares};
pub use reading::scenarios::{FileRequest, FileRun, parse_scenario, read_scenario, simulate_file};
pub use recrash_agents::llm::{Caps, Role, Spent};
pub use recrash_child::end_all as end_programs;
pub use recrash_drivers::preventability;
pub use recrash_export::{Format, PartnersAs};
pub use recrash_fetch::Limits as FetchLimits;
pub use recrash_lab::causes::{CauseGroup, by_cause};
pub use recrash_lab::run_scenario;
pub use recrash_model::run::JudgedRun;
pub use recrash_records::{Column, Distribution, FILTER_HELP, RecordTable, TableRows, distributions};
pub use recrash_report::comparison::{github as github_annotations, sentence as comparison_sentence};
pub use recrash_report::picture;
pub use recrash_roads::scenario_schema as schema;
pub use simulators::external::{
    EGO_COMMAND_PREFIX, EgoCommand, EgoFault, ExternalEgo, Patience, default_python, told_at_reset, told_at_step,
};
pub use simulators::{Simulator, SimulatorKind, metadrive_egos, start_simulator};
pub use stages::{
    AccountSummary, CaseSummary, DesignAttempt, DesignLog, Failure, FallbackReason, ModelSummary, Reviews, RunSummary,
    SelectionStudy, Shown, StageReport, StrategyStudy, Summary, TestedRuns, check_choices, is_of_failure, missed,
    must_be_ready, run_stage, unfaithful,
};
pub use suite::{MayAsk, Permissions, Resources, Stage, Suite};
pub use tools::accounts::{Reported, ReportedColumns, account_table, reported_columns, write_accounts};
pub use tools::assessing::{SevereFailure, SuiteSeverity, suite_coverage, suite_severity};
pub use tools::bench_sim::{SimBench, SimBenchRequest, bench_sim};
pub use tools::check_driver::{
    AvoidedBy, CheckDriverRequest, DriverCheck, GridCheck, LimitCheck, SpeedCheck, Survived, check_driver,
};
pub use tools::comparing::{
    CiFiles, CiOutputs, PageRequest, compare_files, compare_with, hold_to, must_tell, write_page,
};
pub use tools::doctor::{DoctorItem, DoctorRequest, State as DoctorState, doctor};
pub use tools::embed_bench::{BenchSide, EmbedBench, EmbedBenchRequest, bench_embedding};
pub use tools::evaluation::{
    Disagreement, Evaluation, EvaluationRequest, Field, FieldScore, Half, HalfScore, TwoReaders, evaluate,
};
pub use tools::evidence::{Evidence, EvidenceRequest, evidence};
pub use tools::exporting::{ExportReport, ExportRequest, export};
pub use tools::failing::{
    FailureRequest, MinimalOf, MinimalReport, RobustnessOf, RobustnessReport, minimal_failures, robustness_of_failures,
};
pub use tools::freezing::{FreezeRequest, Freezing, crash_types, freeze};
pub use tools::importing::{ImportRequest, Imported, SourceFormat, import};
pub use tools::parity::{
    Agreement, Apart, GAP_TOLERANCE_M, OpenLoop, OpenLoopLimit, OpenLoopRequest, Pair, PairOutcome, Parity,
    ParityRequest, ParitySource, ParityTable, RefusedScenario, TIME_TOLERANCE_S, Threshold, open_loop, parity,
    random_scenario, random_scene,
};
pub use tools::prompting::{Prompt, PromptRequest, prompt};
pub use tools::reconstructing::{reconstruction_table, write_reconstructions};
pub use tools::running::{ask_for_situation, run_many};
#[cfg(feature = "parquet")]
pub use tools::sweep::{Sweep, SweepPoints, SweepRequest, SweepSummary, SweptScenario, Vary};
pub use tools::testing::{TestRequest, read_results, test};
pub use tools::tuning::{TunedScenario, tune_scenario};
