//! The reader on mini narratives of our own: `stories.toml`, a case a behaviour, `families.toml`, each kind of crash in many
//! wordings, `wordings.toml`, what was misread in many, `newer.toml`, what was misread in a newer edition, `whose.toml`, acts and
//! places given to the wrong one, `time.toml`, what is told first and happens later, `grammar.toml`, who does what in retold reports, and
//! `places.toml`, their words and places, `astride.toml`, who is partly in one lane and partly elsewhere, and `who.toml`, who is told of at all.

use crate::common::{self, account_of, facts};
use recrash_model::account::{Act, Obeyed, Source};
use recrash_model::kinds::PartnerKind;
use recrash_model::record::Coded;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Each file of stories, by name.
const FILES: [(&str, &str); 10] = [
    ("stories.toml", include_str!("stories.toml")),
    ("families.toml", include_str!("families.toml")),
    ("wordings.toml", include_str!("wordings.toml")),
    ("newer.toml", include_str!("newer.toml")),
    ("whose.toml", include_str!("whose.toml")),
    ("time.toml", include_str!("time.toml")),
    ("grammar.toml", include_str!("grammar.toml")),
    ("places.toml", include_str!("places.toml")),
    ("astride.toml", include_str!("astride.toml")),
    ("who.toml", include_str!("who.toml")),
];

/// Stories there are, so that none is lost unseen.
const STORIES: usize = 2383;

/// Expected facts read otherwise than the story asks for first, in a way that it accepts too.
const SECOND_CHOICES: usize = 87;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    story: Vec<Story>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Story {
    #[serde(skip)]
    file: &'static str,
    name: String,
    text: String,
    /// What is to be read, by the names of `common::facts`. Behind a `|` stands what is accepted beside it, and read today.
    expect: BTreeMap<String, String>,
}

impl Story {
    /// File and name, for messages.
    fn id(&self) -> String {
        format!("{}, \"{}\"", self.file, self.name)
    }
}

fn stories() -> Vec<Story> {
    let read = |&(file, text): &(&'static str, &str)| {
        let stories = toml::from_str::<File>(text).unwrap_or_else(|error| panic!("{file}: {error}")).story;
        stories.into_iter().map(|story| Story { file, ..story }).collect::<Vec<_>>()
    };
    FILES.iter().flat_map(read).collect()
}

#[test]
fn every_story_stands_there_once_under_a_name_of_its_own() {
    let stories = stories();
    assert!(stories.len() >= STORIES, "{} stories of {STORIES}", stories.len());
    let (mut names, mut texts) = (BTreeMap::new(), BTreeMap::new());
    for story in &stories {
        for (known, what) in [(&mut names, &story.name), (&mut texts, &story.text)] {
            if let Some(other) = known.insert(what, story.id()) {
                panic!("{} and {other} have the same name or text: {what}", story.id());
            }
        }
    }
}

#[test]
fn every_story_is_read_as_told() {
    let (mut wrong, mut second) = (Vec::new(), 0);
    for story in &stories() {
        let account = account_of(&story.text).unwrap_or_else(|| panic!("{}: no account", story.id()));
        let facts = facts(&account);
        for (name, expected) in &story.expect {
            let said =
                facts.get(name.as_str()).unwrap_or_else(|| panic!("{}: no fact has the name {name}", story.id()));
            match expected.split('|').position(|value| value == said) {
                Some(0) => {}
                Some(_) => second += 1,
                None => wrong.push(format!("{}: {name} is \"{said}\", not \"{expected}\"", story.id())),
            }
        }
    }
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
    assert!(second <= SECOND_CHOICES, "{second} facts are read as a second choice");
}

/// Rules look at words before theirs: there may be none.
#[test]
fn a_story_that_begins_in_its_middle_is_read() {
    let mut begun = 0;
    for story in &stories() {
        let words = story.text.split(' ').scan(0, |at, word| {
            let begins = *at;
            *at += word.len() + 1;
            Some(begins)
        });
        for begins in words.skip(1).step_by(3) {
            account_of(&story.text[begins..]);
            begun += 1;
        }
    }
    assert!(begun >= 20_326, "{begun}");
}

#[test]
fn every_told_fact_stands_in_the_narrative() {
    for story in &stories() {
        let account = account_of(&story.text).unwrap();
        let json = serde_json::to_value(&account).unwrap();
        common::each_source(&json, &mut |words| {
            let (start, end) = (words["start"].as_u64().unwrap() as usize, words["end"].as_u64().unwrap() as usize);
            assert_eq!(&story.text[start..end], words["text"].as_str().unwrap(), "{}", story.name);
        });
        let back: recrash_model::account::Account = serde_json::from_value(json).unwrap();
        assert_eq!(back, account);
    }
}

#[test]
fn the_words_of_an_entry_name_the_intersection() {
    let entry = |text: &str| {
        let account = account_of(text).expect("an account");
        let partner = account.partner.expect("a partner");
        let fact = partner.acts.iter().find(|fact| fact.act == Act::Enter).expect("it enters").clone();
        match fact.source {
            Source::Words { text, .. } => text,
            other => panic!("{other:?}"),
        }
    };
    let into = "The AV was stopped at a red light. A sedan coming from the left proceeded into the four-way intersection and its front made \
                contact with the left side of the AV.";
    assert_eq!(entry(into), "proceeded into the four-way intersection");
    // It had only gone by, and was on its way there, when it touched.
    let passing = "The AV was stopped at a red light. A sedan behind the AV passed the AV on the left and proceeded into the intersection. \
                   While passing the AV, the right side of the sedan made contact with the left side of the AV.";
    assert_eq!(entry(passing), "proceeded into");
}

#[test]
fn the_words_of_an_opening_name_the_door() {
    let door = |text: &str| match account_of(text).expect("an account").door.expect("a door").source {
        Source::Words { text, .. } => text,
        other => panic!("{other:?}"),
    };
    let before = "The AV was parked on Elm Street when a passenger of the AV";
    let hit = "and a cyclist hit the door";
    assert_eq!(
        door(&format!("{before} opened the front passenger side door, {hit}.")),
        "opened the front passenger side door"
    );
    let of_van =
        "The AV passed a parked van when the rear left door of the van opened and hit the right side of the AV.";
    assert_eq!(door(of_van), "rear left door of the van opened");
    let bare = "The AV passed a parked van when its driver opened a door and hit the right side of the AV.";
    assert!(door(bare).starts_with("opened"), "{}", door(bare));
}

#[test]
fn what_was_not_completed_was_begun() {
    let text = "The AV attempted a right lane change but was unable to complete the lane change. It braked, and its front hit the rear of a \
                pickup ahead.";
    let acts = account_of(text).expect("an account").sv.acts;
    let change = acts.iter().find(|fact| fact.act == Act::LaneChange).expect("a lane change");
    assert!(change.begun && !change.done, "{change:?}");
}

#[test]
fn a_turn_lane_is_gone_over_to_where_the_column_says_so() {
    let text = "The AV was traveling in the rightmost lane. While the AV proceeded into the right turn lane, an SUV approached the AV \
                from behind, and the front of the SUV made contact with the rear of the AV.";
    let mut record = common::record("1-1", 1, text);
    record.sv_movement = Coded::Known(Movement::ChangingLanes);
    let account = recrash_reader::account(&recrash_reader::incidents(&[record])[0]).expect("an account");
    assert_eq!(facts(&account)["sv_acts"], "follow lane_change_right");
}

/// The facts of a narrative beside these columns.
fn beside_columns(text: &str, partner: PartnerKind, own: Option<Movement>) -> BTreeMap<&'static str, String> {
    let mut record = common::record("1-1", 1, text);
    record.partner = Coded::Known(partner);
    record.sv_movement = own.map_or(Coded::Blank, Coded::Known);
    facts(&recrash_reader::account(&recrash_reader::incidents(&[record])[0]).expect("an account"))
}

#[test]
fn a_bare_truck_is_what_the_column_says() {
    let text =
        "The AV was stopped at a stop sign. A truck that had been behind the AV made contact with the rear of the AV.";
    assert_eq!(beside_columns(text, PartnerKind::PickupTruck, None)["cp_kind"], "pickup");
    let text =
        "The AV stopped for a commercial vehicle backing out of a parking space, and it made contact with the AV.";
    assert_eq!(beside_columns(text, PartnerKind::Van, None)["cp_kind"], "van");
    let text = "The AV was stopped. A dump truck that had been behind the AV made contact with the rear of the AV.";
    assert_eq!(beside_columns(text, PartnerKind::PickupTruck, None)["cp_kind"], "heavy_truck");
}

#[test]
fn a_turn_of_which_no_side_is_told_goes_where_the_column_says() {
    let text = "The AV was completing its turn when it braked and came to a stop in the intersection. A cyclist made contact with the \
                right side of the stopped AV.";
    let facts = beside_columns(text, PartnerKind::Cyclist, Some(Movement::LeftTurn));
    assert_eq!(facts["sv_acts"], "turn_left slow stop hold");
}

#[test]
fn an_animal_that_was_struck_first_is_the_partner_whatever_the_column_says() {
    let text = "The AV was traveling south when a cat crossed the street. As the AV braked, the front of the AV made contact with the \
                cat, and the AV came to a stop. The front of a van behind the AV then made contact with the rear of the AV.";
    assert_eq!(beside_columns(text, PartnerKind::Van, None)["cp_kind"], "animal");
}

#[test]
fn a_lane_of_others_or_one_that_is_only_aimed_at_is_nobodys_own() {
    use recrash_model::account::{ContactState, LaneWord, told};
    let partner = |text: &str| account_of(text).expect("an account").partner.expect("a partner");
    let touched = "and the front of the AV made contact with the dog.";
    let between = format!("A dog emerged from between vehicles in the left lane and ran in front of the AV, {touched}");
    assert_eq!(partner(&between).lane, None);
    let spot = "The AV was stopped behind a sedan. The sedan reversed, attempting to park in a parking spot in the curb lane, and the rear \
                of the sedan made contact with the front of the AV.";
    assert_eq!(partner(spot).lane, None);
    let stepped = "The AV was stopped when a pedestrian stepped into the left turn lane and made contact with the left side of the AV.";
    assert_eq!(partner(stepped).lane, None);
    let beside = "The AV was traveling in the lane adjacent to the rightmost, bus-only lane when a sedan traveling in the bus lane made \
                  contact with the right side of the AV.";
    let account = account_of(beside).expect("an account");
    assert_eq!((account.sv.lane, told(&account.partner.unwrap().lane)), (None, Some(LaneWord::Bus)));
    let own = format!("A dog was running in the left lane, {touched}");
    assert_eq!(told(&partner(&own).lane), Some(LaneWord::Left));
    // Who was coming along had not stood.
    let enters = "The AV was stopped when a scooter rider who was traveling in the curb lane was beginning to enter the intersection and \
                  made contact with the right side of the AV.";
    let rider = partner(enters);
    assert_eq!((told(&rider.state), told(&rider.lane)), (Some(ContactState::Moving), Some(LaneWord::Curb)));
}

/// The facts of a narrative beside the columns of movement and speed of the subject vehicle.
fn beside_speed(text: &str, own: Movement, mps: f64) -> BTreeMap<&'static str, String> {
    let mut record = common::record("1-1", 1, text);
    (record.sv_movement, record.sv_speed_mps) = (Coded::Known(own), Some(mps));
    facts(&recrash_reader::account(&recrash_reader::incidents(&[record])[0]).expect("an account"))
}

#[test]
fn a_column_speed_of_one_that_stands_is_that_of_its_way_there() {
    let text = "The AV was stopped on Elm Street when a sedan from behind made contact with the rear of the AV.";
    let facts = beside_speed(text, Movement::Stopped, 11.0);
    assert_eq!((facts["sv_state"].as_str(), facts["sv_speed"].contains("approach")), ("stopped", true), "{facts:?}");
    // Slowly it may have moved up.
    assert!(beside_speed(text, Movement::Stopped, 0.5)["sv_speed"].contains("impact"));
}

#[test]
fn who_stopped_at_a_sign_and_drives_by_both_columns_moves() {
    let text = "The AV was traveling north when it slowed to a stop at a stop sign. As the AV prepared to make a right turn, a pickup truck \
                traveling east on Oak Street veered to its right and made contact with the driver side of the AV.";
    assert_eq!(beside_speed(text, Movement::RightTurn, 3.0)["sv_state"], "moving");
    assert_eq!(beside_speed(text, Movement::Stopped, 0.0)["sv_state"], "stopped");
    let text =
        "The AV stopped at a stop sign, and a sedan made contact with the rear of the AV while the AV was stationary.";
    assert_eq!(beside_speed(text, Movement::Straight, 3.0)["sv_state"], "stopped");
}

#[test]
fn of_two_that_touch_one_moves() {
    let stood = "The AV was stopped for a red light. A sedan approached from behind and stopped behind the AV before eventually making \
                 contact with the rear of the stopped AV.";
    assert_eq!(facts(&common::account_of(stood).expect("an account"))["cp_state"], "setting_off");
    let came = "The AV was parked along the curb when a sedan pulled up behind the AV. The front of the sedan made contact with the rear of the AV.";
    assert_eq!(facts(&common::account_of(came).expect("an account"))["cp_state"], "moving");
    let drives =
        "The AV was traveling north when it drifted to the right and the AV made contact with a stopped sedan.";
    assert_eq!(facts(&common::account_of(drives).expect("an account"))["cp_state"], "stopped");
}

#[test]
fn who_goes_backwards_across_the_way_of_one_that_drives_into_it_is_there_first() {
    let text = "The AV was proceeding through the intersection when a dump truck reversed into the intersection from westbound Oak Street, \
                and the front right of the AV made contact with the rear of the dump truck.";
    let account = facts(&common::account_of(text).expect("an account"));
    assert_eq!((account["crash_type"].as_str(), account["order"].as_str()), ("backing", "cp"), "{account:?}");
}

/// Where nobody tells the touch, acts of one sentence still come behind those of the one before.
#[test]
fn without_a_told_touch_one_sentence_comes_behind_the_other() {
    let text =
        "The AV stopped on Elm Street. A hatchback turned left and crossed the lane of the AV. There were no injuries.";
    let acts = account_of(text).expect("an account").partner.expect("a partner").acts;
    assert!(acts[0].after_other.is_some(), "{acts:?}");
}

#[test]
fn who_was_yielding_stood_where_the_column_says_so() {
    let text = "The AV, operating in autonomous mode, was yielding to oncoming traffic on Elm Street when a van made contact with the \
                rear of the AV.";
    let van = PartnerKind::Van;
    let stood = beside_columns(text, van, Some(Movement::Stopped));
    assert_eq!((stood["sv_state"].as_str(), stood["standing"].as_str()), ("stopped", "came_to_stop"));
    assert_eq!(beside_columns(text, van, Some(Movement::Straight))["sv_state"], "moving");
    // Told to be moving so fast, it does not stand.
    let rolls = "The AV was traveling at 2 MPH and was yielding to oncoming traffic when a van made contact with the rear of the AV.";
    assert_eq!(beside_columns(rolls, van, Some(Movement::Stopped))["sv_state"], "moving");
}

#[test]
fn a_stand_at_the_contact_without_a_subject_is_the_subject_vehicle_s() {
    let text = "The AV was traveling north on Elm Street when a van made contact with its rear. At the time of contact, was stopped for traffic.";
    assert_eq!(beside_columns(text, PartnerKind::Van, Some(Movement::Stopped))["sv_state"], "stopped");
    // The words are told of the moment, the column of the way there.
    assert_eq!(beside_columns(text, PartnerKind::Van, Some(Movement::Straight))["sv_state"], "stopped");
}

#[test]
fn who_was_coming_to_a_stop_when_it_was_hit_moved() {
    let text = "The AV was coming to a stop for traffic ahead when a van made contact with the rear of the AV.";
    for column in [None, Some(Movement::Straight), Some(Movement::Stopped)] {
        assert_eq!(beside_columns(text, PartnerKind::Van, column)["sv_state"], "moving");
    }
    let then = "The AV was coming to a stop for traffic ahead when a van made contact with the rear of the AV. The AV was traveling 0 MPH.";
    assert_eq!(beside_columns(then, PartnerKind::Van, None)["sv_state"], "stopped");
    let after =
        "The AV was about to turn left after stopping for traffic when a van made contact with the rear of the AV.";
    assert_ne!(beside_columns(after, PartnerKind::Van, None)["sv_state"], "moving");
    let stopped = "The AV came to a stop for traffic ahead when a van made contact with the rear of the AV.";
    assert_eq!(beside_columns(stopped, PartnerKind::Van, None)["sv_state"], "stopped");
}

#[test]
fn an_autonomous_vehicle_is_no_shuttle_by_that_name() {
    let kind = |vehicle: &str| {
        let text = "The AV was stopped. A van made contact with the rear of the AV.";
        let mut record = common::record("1-1", 1, text);
        vehicle.clone_into(&mut record.vehicle);
        recrash_reader::account(&recrash_reader::incidents(&[record])[0])
            .expect("an account")
            .sv
            .kind
            .map(|kind| kind.value)
    };
    assert_eq!(kind("2021 Autonomous 4XY12"), None);
    assert_eq!(kind("2019 Navya Autonom"), Some(recrash_model::account::Kind::Bus));
}

#[test]
fn who_stops_for_traffic_stands_in_its_lane_whatever_the_column_says() {
    let text = "The AV was traveling west and came to a stop to yield to an oncoming dump truck. The left side of the dump truck made contact \
                with the left side of the AV.";
    assert_eq!(beside_columns(text, PartnerKind::HeavyTruck, Some(Movement::Parked))["sv_state"], "stopped");
    let plain =
        "The AV was stopped on Elm Street. The left side of a dump truck made contact with the left side of the AV.";
    assert_eq!(beside_columns(plain, PartnerKind::HeavyTruck, Some(Movement::Parked))["sv_state"], "parked");
}

/// Whether the subject vehicle is told to have obeyed the first signal or sign before it.
fn obeyed(text: &str) -> Option<Obeyed> {
    account_of(text).expect("an account").sv.controls.first().and_then(|control| control.value.obeyed)
}

#[test]
fn who_slows_for_a_red_light_and_goes_on_is_not_told_to_have_obeyed_it() {
    let stays = "The AV was slowing for a red light when a sedan made contact with the rear of the AV.";
    assert_eq!(obeyed(stays), Some(Obeyed::Yes));
    for goes in [
        "The AV slowed for a red light, then accelerated and ran the light. Its front made contact with the left side of a van.",
        "The AV slowed for a red light but did not come to a stop and entered the intersection, where a van made contact with its left side.",
    ] {
        assert_ne!(obeyed(goes), Some(Obeyed::Yes), "{goes}");
    }
}

#[test]
fn damage_to_one_side_says_no_more_than_that_against_the_other_corner_of_the_column() {
    let zones = |words: &str| {
        let text =
            format!("The AV was driving when a van made contact with the AV, causing damage to {words} of the AV.");
        let mut record = common::record("1-1", 1, &text);
        record.sv_zones = vec![ContactZone::FrontRight];
        facts(&recrash_reader::account(&recrash_reader::incidents(&[record])[0]).expect("an account"))["sv_zones"]
            .clone()
    };
    assert_eq!(zones("the left rear door"), "left");
    assert_eq!(zones("the left fender"), "front_left");
}

/// "As the AV turned, a van proceeded into the intersection": behind that, though the verb is one for who drives on; not in another sentence.
#[test]
fn who_proceeds_as_the_other_one_turns_does_so_behind_that() {
    let text = "As the AV began the left turn, a sedan that was stopped at the stop sign to the left proceeded straight into the intersection, and the front of the \
                sedan made contact with the left side of the AV.";
    let after = |text: &str| {
        let acts = account_of(text).expect("an account").partner.expect("a partner").acts;
        acts.iter().find(|fact| fact.act == Act::Enter).expect("it entered").after_other
    };
    assert!(after(text).is_some());
    let apart = "The AV began a left turn. A sedan to the left proceeded straight into the intersection, and the front of the sedan made contact with the left side of \
                 the AV.";
    assert!(after(apart).is_none());
}
