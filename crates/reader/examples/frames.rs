//! Prints the event frames of the text on standard input: `cargo run -p recrash-reader --example frames < text`.

use recrash_reader::frame::{Own, story, zone_of};
use std::io::Read;

fn main() {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text).expect("a text");
    let story = story(&text, Own::default());
    for (number, known) in story.world.actors.iter().enumerate() {
        println!(
            "{number}: {:?} {:?} {:?} heading {:?} lane {:?} announced {}",
            known.kind,
            known.names,
            known.relations,
            known.heading.map(|h| h.0),
            known.lane.map(|l| l.0),
            known.announced
        );
    }
    for frame in &story.frames {
        let words = &text[story.tokens[frame.first].start..story.tokens[frame.end - 1].end];
        println!(
            "s{} {:?} {:?} {:?}->{:?} on {:?} side {:?} rel {:?} head {:?}{} out {:?} {}{}{}{:?} | {}",
            frame.sentence,
            frame.who,
            frame.with.as_ref().and_then(zone_of),
            frame.sense,
            frame.object,
            frame.on.as_ref().and_then(zone_of),
            frame.side,
            frame.relations,
            frame.heading.map(|h| h.0),
            if frame.onto { " onto" } else { "" },
            frame.out_of,
            if frame.negated { "NOT " } else { "" },
            if frame.state { "STATE " } else { "" },
            if frame.aside { "ASIDE " } else { "" },
            frame.progress,
            words.chars().take(70).collect::<String>()
        );
    }
}
