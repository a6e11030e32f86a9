//! Prints the report of a made-up suite: `cargo run -p recrash-report --example demo > demo.html`.
//! `-- junit` and `-- csv` print the other two.

mod drive;
mod roads;
mod suite;

fn main() {
    let suite = suite::demo();
    let text = match std::env::args().nth(1).as_deref() {
        Some("junit") => recrash_report::junit(&suite),
        Some("csv") => recrash_report::results_csv(&suite),
        _ => recrash_report::html(&suite),
    };
    print!("{text}");
}
