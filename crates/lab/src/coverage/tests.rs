use super::*;
use recrash_model::coverage::Hole;
use serde_json::{Value, json};

/// A fact.
fn fact(value: impl Serialize) -> Value {
    json!({ "value": value, "source": { "column": { "name": "test" } } })
}

fn party(kind: Option<&str>, acts: &[&str]) -> Value {
    let act = |act: &&str| {
        json!({ "act": act, "side": null, "step": 0, "after_contact": false, "begun": false,
                "source": { "column": { "name": "test" } } })
    };
    json!({ "kind": kind.map(fact), "movement": null, "state": null, "standing": null, "reasons": [],
            "acts": acts.iter().map(act).collect::<Vec<_>>(), "heading": null, "heading_after": null, "lane": null,
            "speeds": [], "zones": [], "controls": [] })
}

/// An account of a car that does this, and what the test changes of it.
fn account(acts: &[&str], change: impl FnOnce(&mut Value)) -> Account {
    let mut account = json!({
        "format": "recrash.account/1", "incident": "1", "report": "1/1", "reports": ["1/1"], "text_hash": "", "words": 9,
        "crash_type": null, "role": null, "striker": null, "scenario": null, "matrix": null, "first_contact": null,
        "place": { "kind": null, "features": [], "lanes": null, "arms": null, "posted_mps": null, "surface": null,
                   "lighting": null, "weather": [] },
        "sv": party(Some("suv"), &[]), "partner": party(Some("passenger_car"), acts), "came_from": null, "order": null,
        "driver": null, "others": [], "door": null, "injury": null, "damage": null, "partner_left": null,
        "contradictions": []
    });
    change(&mut account);
    serde_json::from_value(account).expect("an account")
}

fn untold(account: &Account) -> Incident<'_> {
    Incident { account, tellable: false, scenario: None }
}

fn table(incidents: &[Incident<'_>], id: &str) -> CoverageTable {
    coverage(incidents).table(id).expect("a table of this name").clone()
}

fn cell<'a>(table: &'a CoverageTable, values: &[&str]) -> &'a CoverageCounts {
    &table.cells.iter().find(|cell| cell.values == values).unwrap_or_else(|| panic!("no cell {values:?}")).counts
}

#[test]
fn each_count_is_a_part_of_the_one_before_it() {
    let one = account(&[], |_| {});
    let held = |tellable, scenario| Incident { account: &one, tellable, scenario };
    let tested = |met, failed| Some(Tested { met, failed, signs: false });
    let incidents = [
        held(false, None),
        held(true, None),
        held(true, tested(false, true)),
        held(true, tested(true, false)),
        held(true, tested(true, true)),
        // A scenario whose own crash is not told covers nothing.
        held(false, tested(true, true)),
    ];
    let all = coverage(&incidents).all;
    assert_eq!(all, CoverageCounts { incidents: 6, tellable: 4, told: 3, met: 2, failed: 1 });
}

#[test]
fn holes_are_what_is_seen_and_not_told_and_what_nobody_saw() {
    let street = account(&[], |account| account["place"]["kind"] = fact("street"));
    let circle = account(&[], |account| account["place"]["kind"] = fact("circle"));
    let alley = account(&[], |account| account["place"]["kind"] = fact("alley"));
    let told = |account, met| Incident {
        account,
        tellable: true,
        scenario: Some(Tested { met, failed: false, signs: false }),
    };
    let roads = table(&[told(&street, true), untold(&circle), untold(&circle), told(&alley, false)], "road");
    let names = |hole| roads.holes(hole).iter().map(|cell| cell.name()).collect::<Vec<_>>();
    assert_eq!(names(Hole::NotTold), ["circle"]);
    assert_eq!(names(Hole::NotMet), ["alley"]);
    assert_eq!(names(Hole::NotSeen), ["intersection", "highway", "parking lot", "garage", "driveway", "other"]);
    assert_eq!((roads.possible, roads.seen(), roads.told(), roads.met(), roads.unseen()), (9, 3, 2, 1, 6));
}

#[test]
fn five_values_stand_together_alone_and_in_pairs() {
    let account = account(&[], |account| {
        account["crash_type"] = fact("front_to_rear");
        account["role"] = fact("responder");
        account["place"]["kind"] = fact("street");
        account["partner"]["controls"] = json!([fact(json!({ "device": "stop_sign", "state": null, "obeyed": null }))]);
    });
    let incidents = [untold(&account), untold(&account)];
    let values = ["front to rear", "responder", "street", "stop sign", "car"];
    let together = table(&incidents, "crash");
    assert_eq!(cell(&together, &values).incidents, 2);
    assert_eq!((together.seen(), together.possible), (1, 11 * 3 * 9 * 4 * 8));
    for (id, value) in ["crash-type", "role", "road", "control", "partner"].into_iter().zip(values) {
        assert_eq!(cell(&table(&incidents, id), &[value]).incidents, 2, "{id}");
    }
    let pairs = table(&incidents, "crash-pairs");
    assert_eq!((pairs.seen(), pairs.possible), (10, 11 * 24 + 3 * 21 + 9 * 12 + 4 * 8));
    assert_eq!(cell(&pairs, &["role: responder", "control: stop sign"]).incidents, 2);
}

#[test]
fn what_is_not_told_is_no_cell_of_its_own_and_no_hole() {
    let vague = account(&[], |account| account["partner"]["kind"] = Value::Null);
    for id in ["crash", "crash-type", "role", "road", "partner", "operational-environment"] {
        let table = table(&[untold(&vague)], id);
        assert_eq!((table.seen(), table.holes(Hole::NotTold).len()), (0, 0), "{id}");
        assert_eq!(table.unseen(), table.possible);
        assert!(table.cells.iter().any(|cell| cell.untold && cell.counts.incidents == 1), "{id}");
    }
}

#[test]
fn a_signal_of_the_place_is_control_though_nobody_is_told_to_stand_before_it() {
    let account = account(&[], |account| account["place"]["features"] = json!([fact("yield_sign"), fact("signal")]));
    assert_eq!(cell(&table(&[untold(&account)], "control"), &["signal"]).incidents, 1);
}

#[test]
fn a_signal_that_is_told_and_not_drawn_covers_no_signal() {
    let account = account(&[], |account| {
        account["sv"]["controls"] = json!([fact(json!({ "device": "signal", "state": "red", "obeyed": null }))]);
    });
    for signs in [true, false] {
        let scenario = Some(Tested { met: true, failed: false, signs });
        let all = coverage(&[Incident { account: &account, tellable: true, scenario }]);
        let told = |id: &str, values: &[&str]| cell(all.table(id).expect("a table of this name"), values).told;
        assert_eq!(told("control", &["signal"]), usize::from(signs));
        let pairs = all.tables.iter().filter(|table| table.axes.len() == 2).flat_map(|table| &table.cells);
        let seen = pairs.filter(|cell| cell.counts.incidents == 1);
        let with_signal = seen.filter(|cell| cell.values.iter().any(|value| value == "control: signal"));
        assert_eq!(with_signal.clone().count(), 4);
        assert!(with_signal.clone().all(|cell| cell.counts.told == usize::from(signs)));
        assert_eq!(all.all.told, 1);
        let rules = all.table("rules-of-the-road").expect("rules");
        let art_5 = rules.cells.iter().find(|cell| cell.values[0] == "art. 5: signals" && cell.counts.incidents == 1);
        assert_eq!(art_5.expect("a cell").counts.told, usize::from(signs));
    }
}

#[test]
fn what_the_matrix_has_no_event_for_stands_outside_with_its_reason() {
    let cut_in = account(&[], |a| a["matrix"] = fact(json!({ "object": "vehicle", "event": "cutting_in" })));
    let behind = account(&[], |a| a["came_from"] = fact("behind"));
    let alone = account(&[], |a| a["partner"] = Value::Null);
    let vague = account(&[], |_| {});
    let incidents = [&cut_in, &behind, &behind, &alone, &vague].map(untold);
    let eu = table(&incidents, "eu-2022-1426");
    assert_eq!(cell(&eu, &["vehicle", "cutting in"]).incidents, 1);
    assert_eq!((eu.possible, eu.seen()), (24, 1));
    let outside: Vec<(&str, usize)> = eu.outside.iter().map(|of| (of.why.as_str(), of.counts.incidents)).collect();
    assert_eq!(
        outside,
        [
            ("the other came from behind: the matrix has no such event", 2),
            ("from where the other came is not told", 1),
            ("nobody and nothing was touched", 1),
        ]
    );
}

/// Values of the only axis, or of the last one, of cells with an incident.
fn seen(account: &Account, id: &str) -> Vec<String> {
    let table = table(&[untold(account)], id);
    table.cells.iter().filter(|cell| cell.counts.incidents > 0).map(CoverageCell::name).collect()
}

#[test]
fn the_environment_is_told_by_attribute() {
    let account = account(&[], |account| {
        let place = &mut account["place"];
        place["kind"] = fact("street");
        place["features"] = json!([fact("crosswalk"), fact("bike_lane"), fact("crosswalk")]);
        place["weather"] = json!([fact("rain"), fact("fog")]);
        place["posted_mps"] = fact(30.0 * 0.447_04);
        place["surface"] = fact("wet");
    });
    assert_eq!(
        seen(&account, "operational-environment"),
        [
            "place, street",
            "feature, bike lane",
            "feature, crosswalk",
            "surface, wet",
            "weather, rain",
            "weather, fog",
            "posted limit, 26 to 35 mph",
            "light, not stated",
        ]
    );
}

#[test]
fn limits_stand_in_the_band_that_holds_them() {
    for (mph, band) in
        [(25.0, "up to 25 mph"), (26.0, "26 to 35 mph"), (55.0, "46 to 55 mph"), (70.0, "56 mph and more")]
    {
        let account = account(&[], |account| account["place"]["posted_mps"] = fact(mph * 0.447_04));
        assert!(seen(&account, "operational-environment").contains(&format!("posted limit, {band}")), "{mph}");
    }
}

#[test]
fn competencies_follow_from_the_other_and_from_what_the_vehicle_itself_does() {
    let account = account(&["open_door"], |account| {
        account["door"] = fact("cp");
        account["partner"]["state"] = fact("parked");
        account["sv"]["movement"] = fact("right_turn");
        account["driver"] = fact("human_took_over");
    });
    assert_eq!(
        seen(&account, "behavioural-competency"),
        [
            "detect and respond to, a vehicle that stands or is parked",
            "detect and respond to, a door that opens",
            "manoeuvre, turn right",
            "fallback, a human takes over before the contact",
        ]
    );
}

#[test]
fn scenario_types_follow_from_whose_move_it_was() {
    let of = |role: Option<&str>, act: &str| {
        let account = account(&[], |account| {
            account["role"] = json!(role.map(fact));
            account["sv"] = party(Some("suv"), &[act]);
        });
        seen(&account, "scenario-type")
    };
    assert_eq!(of(Some("initiator"), "turn"), [NOMINAL]);
    assert_eq!(of(Some("responder"), "turn"), [CRITICAL]);
    assert_eq!(of(Some("both"), "turn"), [CRITICAL]);
    assert_eq!(of(Some("responder"), "lose_control"), [FAILURE]);
    assert_eq!(of(None, "turn"), [""; 0]);
}

#[test]
fn a_rule_binds_who_is_told_to_do_what_it_is_about() {
    let account = account(&["run_red", "turn"], |account| {
        account["crash_type"] = fact("intersection");
        account["place"]["kind"] = fact("intersection");
        account["partner_left"] = fact(true);
    });
    assert_eq!(
        seen(&account, "rules-of-the-road"),
        [
            "art. 5: signals, other road user",
            "art. 16: turning, other road user",
            "art. 18: giving way at junctions, subject vehicle",
            "art. 18: giving way at junctions, other road user",
            "art. 31: after a crash, other road user",
        ]
    );
}

#[test]
fn things_are_bound_by_no_rule() {
    let account = account(&["roll"], |account| {
        account["partner"]["kind"] = fact("debris");
        account["place"]["kind"] = fact("highway");
    });
    assert_eq!(seen(&account, "rules-of-the-road"), ["art. 25: motorways, subject vehicle"]);
}

#[test]
fn who_follows_keeps_the_distance() {
    let of = |origin: &str| {
        let account = account(&[], |account| {
            account["crash_type"] = fact("front_to_rear");
            account["came_from"] = fact(origin);
        });
        seen(&account, "rules-of-the-road")
    };
    assert_eq!(of("behind"), ["art. 13: distance to the vehicle ahead, other road user"]);
    assert_eq!(of("ahead"), ["art. 13: distance to the vehicle ahead, subject vehicle"]);
}
