//! Words beside columns: what each of them says of zones, speeds and kinds.

use crate::common::{self, facts};
use recrash_model::kinds::PartnerKind;
use recrash_model::record::{Coded, CrashRecord};
use recrash_model::template::{Movement, RoadType};
use recrash_model::zones::ContactZone as Z;
use std::collections::BTreeMap;

fn beside(text: &str, set: impl Fn(&mut CrashRecord)) -> BTreeMap<&'static str, String> {
    let mut record = common::record("1-1", 1, text);
    set(&mut record);
    facts(&recrash_reader::account(&recrash_reader::incidents(&[record])[0]).expect("an account"))
}

/// The zones of the subject vehicle of who ran into whose rear, beside this column.
fn rear_zones(words: &str, column: &[Z]) -> String {
    let text = format!("The AV was stopped at a red light when it was {words}.");
    beside(&text, |record| record.sv_zones = column.to_vec()).remove("sv_zones").unwrap_or_default()
}

#[test]
fn words_for_an_end_keep_the_one_corner_that_the_column_ticks() {
    let words = ["rear-ended by a sedan", "struck in the rear by a sedan", "hit from behind by a sedan"];
    for words in words {
        assert_eq!(rear_zones(words, &[Z::RearLeft]), "rear rear_left", "{words}");
        assert_eq!(rear_zones(words, &[Z::RearLeft, Z::Rear]), "rear rear_left", "{words}");
        // Both corners are the whole end.
        assert_eq!(rear_zones(words, &[Z::RearLeft, Z::Rear, Z::RearRight]), "rear", "{words}");
    }
}

#[test]
fn words_for_a_corner_stand_alone_before_a_coarser_column() {
    for words in ["right rear corner", "rear right fender", "rear passenger side bumper"] {
        let text = format!("The AV was stopped when a van made contact with the {words} of the AV.");
        let zones = beside(&text, |record| record.sv_zones = vec![Z::Right]);
        assert_eq!(zones["sv_zones"], "rear_right", "{words}");
    }
}

#[test]
fn who_slowed_to_stop_and_rolls_by_the_column_moves() {
    let told = [
        "The AV was traveling east and slowed to stop for a red light when a van made contact with the rear of the AV.",
        "The AV, slowing to stop for a bus, was struck in the rear by a van.",
        "As the AV slowed down to stop at the light, a van from behind hit the rear of the AV.",
    ];
    for text in told {
        let rolls = beside(text, |record| {
            (record.sv_movement, record.sv_speed_mps) = (Coded::Known(Movement::Straight), Some(1.3));
        });
        assert_eq!(rolls["sv_state"], "moving", "{text}");
        assert!(rolls["sv_acts"].ends_with("slow"), "{text}: {}", rolls["sv_acts"]);
        let stands = beside(text, |record| {
            (record.sv_movement, record.sv_speed_mps) = (Coded::Known(Movement::Stopped), Some(0.0));
        });
        assert_eq!(stands["sv_state"], "stopped", "{text}");
    }
}

#[test]
fn a_speed_that_was_reached_before_the_stop_is_none_of_the_impact() {
    let told = [
        "The AV set off on green, accelerated up to about 10 mph, and slowed, eventually coming to a complete stop, when a van hit its rear.",
        "The AV reached 10 mph in the junction, braked for a fence and came to a stop. A van then struck the rear of the AV.",
        "After it had sped up to 10 mph, the AV stopped for a fence, and a van ran into the rear of the AV.",
    ];
    for text in told {
        let facts = beside(text, |record| {
            (record.sv_movement, record.sv_speed_mps) = (Coded::Known(Movement::Stopped), Some(4.47));
        });
        assert_eq!(facts["sv_state"], "stopped", "{text}");
        assert!(!facts["sv_speed"].contains("impact"), "{text}: {}", facts["sv_speed"]);
    }
}

#[test]
fn a_numbered_car_is_what_the_bracket_or_the_column_says() {
    let pickup = |record: &mut CrashRecord| record.partner = Coded::Known(PartnerKind::PickupTruck);
    for text in [
        "Car 1 was stopped at a light when car 2 struck the rear of car 1.",
        "Car 1 was turning left when car 2 (Ford F-150) hit the rear of car 1.",
        "Car 1 was parked. Car 2 reversed and its rear touched the front of car 1.",
    ] {
        assert_eq!(beside(text, pickup)["cp_kind"], "pickup", "{text}");
    }
}

#[test]
fn a_truck_with_a_colour_or_a_make_is_what_the_column_says_and_a_box_truck_is_none() {
    let suv = |record: &mut CrashRecord| record.partner = Coded::Known(PartnerKind::Suv);
    let told = [
        ("The AV was stopped when a black GMC truck struck its rear.", "suv"),
        ("The AV was stopped when a white truck struck its rear.", "suv"),
        ("The AV was stopped when a red Nissan truck struck its rear.", "suv"),
        ("The AV was stopped when a red Kenworth truck struck its rear.", "heavy_truck"),
        ("The AV was stopped when a white box truck struck its rear.", "box_truck"),
    ];
    for (text, kind) in told {
        assert_eq!(beside(text, suv)["cp_kind"], kind, "{text}");
    }
}

#[test]
fn a_rear_that_cannot_have_met_who_backs_from_ahead_is_the_front_of_the_column() {
    let told = [
        "The AV was traveling west when it slowed to a stop for a pickup. The pickup began to reverse in the AV's lane, and the rear of the \
         pickup made contact with the rear of the stationary AV.",
        "The AV was stopped behind a van. The van backed up and its rear hit the rear of the AV.",
    ];
    for text in told {
        let facts = beside(text, |record| record.sv_zones = vec![Z::Front]);
        assert_eq!((facts["came_from"].as_str(), facts["sv_zones"].as_str()), ("ahead", "front"), "{text}");
        assert_eq!(beside(text, |_| ())["sv_zones"], "rear", "{text}");
    }
}

#[test]
fn who_begins_to_turn_as_another_comes_turns_whatever_the_column_says() {
    let told = [
        "After stopping at a stop sign the AV began to make a right turn. As the AV began to turn right, a cyclist came from behind, lost \
         control, and the front of the bicycle made contact with the rear of the AV.",
        "The AV had stopped at the corner. While the AV was turning right, a van from behind made contact with the rear of the AV.",
    ];
    for text in told {
        let facts = beside(text, |record| {
            (record.sv_movement, record.sv_speed_mps) = (Coded::Known(Movement::Stopped), Some(0.0));
        });
        assert_eq!((facts["sv_state"].as_str(), facts["sv_movement"].as_str()), ("moving", "right_turn"), "{text}");
    }
}

#[test]
fn who_runs_a_red_light_enters_no_traffic() {
    let told = [
        "The AV was traveling north and entered the intersection on a green light. A sedan traveling west entered the intersection against \
         a red light, and the front of the sedan made contact with the right side of the AV.",
        "The AV was going straight when a van heading east ran the red light and hit the left side of the AV.",
    ];
    for text in told {
        let facts = beside(text, |record| record.cp_movement = Coded::Known(Movement::EnteringTraffic));
        assert_eq!(facts["cp_movement"], "straight", "{text}");
    }
}

#[test]
fn who_rides_up_and_strikes_it_is_the_partner_though_the_column_has_a_car() {
    let text = "The AV was traveling east when it yielded to a parking vehicle ahead on the right. Shortly after, a lane-splitting electric \
                scooterist attempting to change lanes made contact with the left rear corner of the AV.";
    let facts = beside(text, |record| record.partner = Coded::Known(PartnerKind::PassengerCar));
    assert_eq!((facts["cp_kind"].as_str(), facts["others"].as_str()), ("scooter_rider", "vehicle"));
}

#[test]
fn columns_of_a_second_contact_are_not_of_the_first() {
    let text = "The AV was traveling south when a dog crossed the street. The front of the AV made contact with the dog, and the AV came to a \
                stop. The front of an SUV behind the AV then made contact with the rear of the AV.";
    let facts = beside(text, |record| {
        record.partner = Coded::Known(PartnerKind::Suv);
        (record.cp_zones, record.sv_zones) = (vec![Z::Front], vec![Z::Rear]);
        (record.cp_movement, record.sv_speed_mps) = (Coded::Known(Movement::Straight), Some(0.0));
    });
    let said = ["cp_kind", "cp_zones", "sv_zones", "sv_speed"].map(|name| facts[name].as_str());
    assert_eq!(said, ["animal", "", "front", ""]);
}

#[test]
fn damage_on_one_side_leaves_out_the_corners_of_the_other() {
    let text = |damage: &str| format!("The AV made contact with a van parked ahead of it, damaging the AV's {damage}.");
    let ticked = |damage: &str| {
        let zones = vec![Z::FrontLeft, Z::Front, Z::FrontRight];
        beside(&text(damage), |record| record.sv_zones.clone_from(&zones)).remove("sv_zones").unwrap_or_default()
    };
    assert_eq!(ticked("front bumper, left headlamp, and left front radar"), "front_left front");
    assert_eq!(ticked("left headlamp and right headlamp"), "front_left front front_right");
}

#[test]
fn a_company_that_drives_is_its_vehicle() {
    let text = "Northlight was proceeding straight in the right lane when a van swerved into the right lane and came to a stop. The front of \
                the AV made contact with the van.";
    let facts = beside(text, |_| {});
    assert_eq!((facts["sv_lane"].as_str(), facts["sv_acts"].as_str()), ("right", "follow"));
    assert!(!facts["cp_acts"].contains("follow"), "{}", facts["cp_acts"]);
}

#[test]
fn a_bus_that_overtakes_is_not_the_car_that_the_column_names() {
    let text = "The AV was traveling north when it was rear-ended. A bus in the right adjacent lane overtook the AV on the right, and the AV \
                braked. A passenger vehicle behind the AV made contact with its rear bumper.";
    let facts = beside(text, |record| record.partner = Coded::Known(PartnerKind::PassengerCar));
    assert_eq!((facts["cp_kind"].as_str(), facts["others"].as_str()), ("passenger_car", "bus"));
}

#[test]
fn a_lane_change_away_from_the_touched_corner_was_followed() {
    let text = "The AV was making a right lane change when a sedan going straight made contact with the left rear bumper of the AV.";
    let facts = beside(text, |record| record.cp_movement = Coded::Known(Movement::Straight));
    assert_eq!(facts["came_from"], "behind");
}

#[test]
fn a_company_that_is_called_as_a_car_is_is_nobody_else() {
    let told = [
        "The Bronco was traveling north when a van struck the rear of the Bronco.",
        "A Bronco Autonomous Vehicle was stopped at a light. A van struck the Bronco vehicle's rear bumper.",
        "Bronco was proceeding straight when a van swerved and touched the Bronco AV's left side.",
    ];
    for text in told {
        let own = beside(text, |record| record.entity = "Bronco Mobility".to_owned());
        assert_eq!((own["others"].as_str(), own["cp_kind"].as_str()), ("", "van"), "{text}");
    }
    let other = beside(told[0], |_| {});
    assert_ne!((other["others"].as_str(), other["cp_kind"].as_str()), ("", "van"));
    let animal = beside("The AV braked for a pony, and a van struck its rear.", |_| {});
    assert_eq!(animal["others"], "animal");
    let company = beside("The Pony AV was stopped, and a van struck the Pony AV's rear.", |_| {});
    assert_eq!(company["others"], "");
}

#[test]
fn a_column_that_names_a_bystander_is_not_of_who_touched() {
    let rider = "The AV yielded to a cyclist who moved over from the bike lane, and a passenger vehicle then struck the rear of the AV.";
    let named = beside(rider, |record| record.partner = Coded::Known(PartnerKind::Cyclist));
    assert_eq!((named["cp_kind"].as_str(), named["others"].as_str()), ("vehicle", "bicycle"));
    let bus = "The AV yielded to a bus that was changing into its lane from the right, and another vehicle struck its left rear corner.";
    let named = beside(bus, |record| {
        (record.partner, record.cp_movement) = (Coded::Known(PartnerKind::Bus), Coded::Known(Movement::ChangingLanes));
    });
    assert_eq!((named["cp_kind"].as_str(), named["cp_movement"].as_str()), ("vehicle", "straight"));
    // Where the words leave open who it was, the column tells.
    let open = "The AV yielded to a bus, and a vehicle struck its left rear corner.";
    let named = beside(open, |record| record.partner = Coded::Known(PartnerKind::Van));
    assert_eq!(named["cp_kind"], "van");
}

#[test]
fn the_damaged_corner_of_the_words_stands_before_the_other_one_of_the_column() {
    for words in ["damaging the AV's front right headlamp", "causing damage to the right fender of the AV"] {
        let text = format!("The AV was traveling north and struck a van, {words}.");
        let zones = |column: Z| beside(&text, |record| record.sv_zones = vec![column]).remove("sv_zones");
        assert_eq!(zones(Z::FrontLeft).as_deref(), Some("front_right"), "{words}");
        assert_eq!(zones(Z::FrontRight).as_deref(), Some("front_right"), "{words}");
        assert_eq!(zones(Z::Front).as_deref(), Some("front"), "{words}");
    }
}

#[test]
fn who_was_giving_way_and_moves_by_the_column_was_slowing() {
    let text = "The AV was yielding to traffic on Elm Street when a van struck the rear of the AV.";
    let acts = |movement: Movement| {
        beside(text, |record| record.sv_movement = Coded::Known(movement)).remove("sv_acts").unwrap_or_default()
    };
    assert_eq!(acts(Movement::Straight), "slow");
    assert_eq!(acts(Movement::Stopped), "");
}

#[test]
fn a_garage_in_which_another_drove_is_not_the_place() {
    let place = |words: &str| {
        let text = format!(
            "The AV was heading south on Elm Street. {words} The nose of the coupe hit the AV's left rear door."
        );
        beside(&text, |record| record.road = Coded::Known(RoadType::Street)).remove("place").unwrap_or_default()
    };
    assert_eq!(
        place("A coupe driving east in a parking garage left the garage and turned into the AV's lane."),
        "street"
    );
    assert_eq!(place("A coupe that was going through a parking structure shot out into the AV's lane."), "street");
    assert_eq!(place("The AV was driving in a parking garage when a coupe came around the corner."), "garage");
}
