//! What is no stage of a suite: each file is one command's work.

pub(crate) mod accounts;
pub(crate) mod assessing;
pub(crate) mod bench_sim;
pub(crate) mod check_driver;
pub(crate) mod comparing;
pub(crate) mod doctor;
pub(crate) mod embed_bench;
pub(crate) mod evaluation;
pub(crate) mod evidence;
pub(crate) mod exporting;
pub(crate) mod failing;
pub(crate) mod freezing;
pub(crate) mod importing;
pub(crate) mod parity;
pub(crate) mod prompting;
pub(crate) mod reconstructing;
pub(crate) mod running;
#[cfg(feature = "parquet")]
pub(crate) mod sweep;
pub(crate) mod testing;
